#pragma once

#include "crashrank/internal/interop/pi.hpp"
#include "crashrank/interop/frames.hpp"

namespace crashrank {

inline double yaw_rate_from_carla(double right_dps) { return -right_dps * (detail::pi / 180.0); }

inline Pose pose_from_carla(const CarlaTransform& carla) {
  constexpr double radians = detail::pi / 180.0;
  return pose_from_angles(flip_left_handed(Eigen::Vector3d(carla.x_m, carla.y_m, carla.z_m)),
                          -carla.yaw_deg * radians, -carla.pitch_deg * radians,
                          carla.roll_deg * radians);
}

inline CarlaTransform carla_from_pose(const Pose& pose) {
  constexpr double degrees = 180.0 / detail::pi;
  const Angles angles = angles_of(pose);
  const Eigen::Vector3d at = flip_left_handed(pose.translation);
  return {at.x(),
          at.y(),
          at.z(),
          -angles.pitch * degrees,
          -angles.yaw * degrees,
          angles.roll * degrees};
}

}  // namespace crashrank

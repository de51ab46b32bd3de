#pragma once

#include "crashrank/base/pose.hpp"

#include <Eigen/Core>

#include <cmath>

namespace crashrank {

// From other programs' frames to the library's and back: x forward, y left, z up, right-handed
// (ISO 8855, REP-103). Functions without state, safe from any thread, a few ns each; no errors.
// ImportTransform converts the axes of mesh files.

/// Angles of `pose_from_angles`, rad: R = Rz(yaw)·Ry(pitch)·Rx(roll). Yaw to the left, nose down
/// and left side up are positive.
struct Angles {
  double yaw = 0.0;    ///< (−π, π]
  double pitch = 0.0;  ///< [−π/2, π/2]
  double roll = 0.0;   ///< (−π, π]; 0 where the nose points straight up or down
};

/// The angles of a rigid pose; `pose_from_angles` makes the same rotation of them but for rounding.
inline Angles angles_of(const Pose& pose) {
  const Eigen::Matrix3d& r = pose.rotation;
  Angles angles;
  const double level = std::hypot(r(0, 0), r(1, 0));
  angles.pitch = std::atan2(-r(2, 0), level);
  if (level > 1e-9) {
    angles.yaw = std::atan2(r(1, 0), r(0, 0));
    angles.roll = std::atan2(r(2, 1), r(2, 2));
  } else {
    angles.yaw = std::atan2(-r(0, 1), r(1, 1));
  }
  return angles;
}

/// Between left-handed x forward, y right, z up (CARLA, Unreal Engine) and this library: the same
/// function both ways, exact. For positions, velocities and accelerations, in m and s; for angles
/// and rates see `CarlaTransform`.
inline Eigen::Vector3d flip_left_handed(const Eigen::Vector3d& v) { return {v.x(), -v.y(), v.z()}; }

/// The same for a pose whose body and world are both left-handed, such as the matrix of CARLA's
/// Transform.get_matrix(). Both ways, exact.
inline Pose flip_left_handed(const Pose& pose) {
  Pose flipped = pose;
  for (const int other : {0, 2}) {
    flipped.rotation(1, other) = -pose.rotation(1, other);
    flipped.rotation(other, 1) = -pose.rotation(other, 1);
  }
  flipped.translation = flip_left_handed(pose.translation);
  return flipped;
}

/// Position and attitude of a CARLA Transform: m and degrees, left-handed. Yaw to the
/// right, nose up and right side down are positive. CARLA's vehicles have their origin elsewhere
/// than the rear axle: move the model (ImportTransform::origin_m) or the pose.
struct CarlaTransform {
  double x_m = 0.0;        ///< forward
  double y_m = 0.0;        ///< to the right
  double z_m = 0.0;        ///< up
  double pitch_deg = 0.0;  ///< nose up
  double yaw_deg = 0.0;    ///< to the right
  double roll_deg = 0.0;   ///< right side down
};

/// CARLA's yaw rates are degrees to the right; this library's radians to the left.
inline double yaw_rate_from_carla(double right_dps);

/// The pose of a CARLA transform, body to world, in this library's frame.
inline Pose pose_from_carla(const CarlaTransform& carla);

/// The CARLA transform of a rigid pose.
inline CarlaTransform carla_from_pose(const Pose& pose);

/// Between x forward, y right, z down (aircraft, SAE J670's older frame; as a world: north, east,
/// down) and this library, whose world is then north, west, up. Both ways, exact; for angular
/// velocities too.
inline Eigen::Vector3d flip_z_down(const Eigen::Vector3d& v) { return {v.x(), -v.y(), -v.z()}; }

/// The same for a pose whose body and world both have z down. Both ways, exact.
inline Pose flip_z_down(const Pose& pose) {
  Pose flipped = pose;
  for (const int other : {1, 2}) {
    flipped.rotation(0, other) = -pose.rotation(0, other);
    flipped.rotation(other, 0) = -pose.rotation(other, 0);
  }
  flipped.translation = flip_z_down(pose.translation);
  return flipped;
}

/// From a camera's optical frame (REP-103: z forward, x right, y down) to body axes. Exact.
inline Eigen::Vector3d from_optical(const Eigen::Vector3d& v) { return {v.z(), -v.x(), -v.y()}; }

/// From body axes to a camera's optical frame. Exact.
inline Eigen::Vector3d to_optical(const Eigen::Vector3d& v) { return {-v.y(), -v.z(), v.x()}; }

}  // namespace crashrank

#include "crashrank/internal/interop/frames-inl.hpp"

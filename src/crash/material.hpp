#pragma once

#include "crashrank/crash/depth_map.hpp"
#include "crashrank/crash/pulse.hpp"

#include <Eigen/Core>

namespace crashrank::detail {

/// A body's strength, asked in the coordinates of a view in which the body stands.
class Material {
public:
  Material(const PulseBody& body, const ViewFrame& frame)
      : strength_(body.strength),
        turn_(body.pose.rotation.transpose() * frame.axes.transpose()),
        shift_(body.pose.rotation.transpose() * (frame.origin_m - body.pose.translation)) {}

  /// Where a force along `inward` enters at (u, w) and a height over the ground.
  CrushPressure law(const Eigen::Vector2d& point, double height,
                    const Eigen::Vector2d& inward) const {
    if (strength_.rigid) {
      CrushPressure rigid;
      rigid.rigid = true;
      return rigid;
    }
    Eigen::Vector3d in_body = turn_ * Eigen::Vector3d(point.x(), point.y(), height) + shift_;
    in_body.z() = height;
    const Eigen::Vector3d direction = turn_ * Eigen::Vector3d(inward.x(), inward.y(), 0.0);
    return pressure_at(strength_, in_body, direction.head<2>());
  }

private:
  const CrushStrength& strength_;
  Eigen::Matrix3d turn_;
  Eigen::Vector3d shift_;
};

}  // namespace crashrank::detail

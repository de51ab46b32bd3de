#pragma once

#include "crashrank/crash/depth_map.hpp"
#include "crashrank/crash/pulse.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace crashrank::detail {

/// A body's strength, asked in the coordinates of a view in which the body stands.
class Material {
public:
  Material(const PulseBody& body, const ViewFrame& frame)
      : strength_(body.strength),
        turn_(body.pose.rotation.transpose() * frame.axes.transpose()),
        shift_(body.pose.rotation.transpose() * (frame.origin_m - body.pose.translation)) {}

  bool rigid() const noexcept { return strength_.rigid; }

  /// Whether a force along `inward` that enters at (u, w) and a height meets the body's core.
  double core_share(const Eigen::Vector2d& point, double height) const {
    const Eigen::Vector3d in_body = place(point, height);
    return strength_.core.share_at(in_body.x(), in_body.y());
  }

  /// The law at a height over the ground of a force along `inward`, where the core's share is as
  /// given.
  CrushPressure law_of_share(double core_share, double height,
                             const Eigen::Vector2d& inward) const {
    CrushPressure pressure;
    pressure.rigid = strength_.rigid;
    if (strength_.rigid) return pressure;
    const Eigen::Vector2d direction(turn_(0, 0) * inward.x() + turn_(0, 1) * inward.y(),
                                    turn_(1, 0) * inward.x() + turn_(1, 1) * inward.y());
    const double length = direction.squaredNorm();
    const double ahead = length > 0.0 ? direction.x() * direction.x() / length : 1.0;
    const CrushLaw& end = direction.x() <= 0.0 ? strength_.front : strength_.rear;
    const bool carries = height >= strength_.low_m && height <= strength_.high_m;
    const double share =
        (carries ? 1.0 : strength_.rest) * core_share / (strength_.high_m - strength_.low_m);
    pressure.yield_pa = share * (ahead * end.yield_npm + (1.0 - ahead) * strength_.side.yield_npm);
    pressure.slope_papm =
        share * (ahead * end.slope_npm2 + (1.0 - ahead) * strength_.side.slope_npm2);
    pressure.depth_m = ahead >= 0.5 ? end.depth_m : strength_.side.depth_m;
    return pressure;
  }

  /// Where a force along `inward` enters at (u, w) and a height over the ground.
  CrushPressure law(const Eigen::Vector2d& point, double height,
                    const Eigen::Vector2d& inward) const {
    return law_of_share(strength_.rigid ? 1.0 : core_share(point, height), height, inward);
  }

  const CrushStrength& strength() const noexcept { return strength_; }

private:
  Eigen::Vector3d place(const Eigen::Vector2d& point, double height) const {
    return rotate(turn_, Eigen::Vector3d(point.x(), point.y(), height)) + shift_;
  }

  const CrushStrength& strength_;
  Eigen::Matrix3d turn_;
  Eigen::Vector3d shift_;
};

/// Pressure of two bodies pressed into each other: that of `share_crush`, to the bit, at less cost
/// where nothing is crushed flat.
inline double shared_pressure(const CrushPressure& a, const CrushPressure& b, double depth_m) {
  if ((!a.rigid && std::isfinite(a.depth_m)) || (!b.rigid && std::isfinite(b.depth_m)) ||
      (a.rigid && b.rigid) || depth_m <= 0.0) {
    return share_crush(a, b, depth_m).pressure_pa;
  }
  const auto depth_at = [](const CrushPressure& law, double pressure) {
    return law.rigid || pressure <= law.yield_pa ? 0.0 : (pressure - law.yield_pa) / law.slope_papm;
  };
  const double yield_a = a.rigid ? b.yield_pa : a.yield_pa;
  const double yield_b = b.rigid ? a.yield_pa : b.yield_pa;
  const double least = std::min(yield_a, yield_b);
  const double most = std::max(yield_a, yield_b);
  // The softer body gives way alone until the pressure is what the other yields at.
  const double until_most = depth_at(a, most) + depth_at(b, most);
  const bool both = until_most <= depth_m;
  const double start = both ? most : least;
  const double begun = both ? until_most : depth_at(a, least) + depth_at(b, least);
  const double step = both ? std::max(start, 1.0) : most - start;
  const double end = start + step;
  const double rise = depth_at(a, end) + depth_at(b, end) - begun;
  return start + (rise > 0.0 ? step * (depth_m - begun) / rise : 0.0);
}

}  // namespace crashrank::detail

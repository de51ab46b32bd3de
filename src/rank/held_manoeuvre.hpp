#pragma once

#include "crashrank/motion/motion.hpp"

#include <Eigen/Core>

namespace crashrank::detail {

/// Braking and steering at the begin of a crash, which the driver is assumed to hold.
struct HeldManoeuvre {
  /// deceleration along the path, forward or backward; negative: speeding up
  double braking_mps2 = 0.0;
  double curvature_per_m = 0.0;  ///< curvature of the path, left positive
};

/// Estimates the manoeuvre of a plan at a time by finite differences: exact up to rounding for
/// constant manoeuvres; for timed poses the mean over 0.6 s, inside their first and last time. A
/// plan that has come to rest has the manoeuvre from just before. `center_m` is the centre of mass
/// in body coordinates. Constant time; does not allocate.
HeldManoeuvre held_manoeuvre(const Motion& plan, const Eigen::Vector3d& center_m, double time_s);

}  // namespace crashrank::detail

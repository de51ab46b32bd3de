#pragma once

#include "crashrank/motion/motion.hpp"

#include <Eigen/Core>

namespace crashrank::detail {

/// What a driver does when a crash begins, and goes on doing.
struct HeldManoeuvre {
  double braking_mps2 = 0.0;     ///< of its speed, forward or backward; below 0 it gains
  double curvature_per_m = 0.0;  ///< of its path, left positive
};

/// That of a plan at a time: of a constant manoeuvre exact but for rounding, of timed poses the
/// mean over 0.6 s within their first and last; of a plan that has come to rest, what it was just
/// before. `center_m`: the centre of mass, body coordinates. Constant time, allocates nothing.
HeldManoeuvre held_manoeuvre(const Motion& plan, const Eigen::Vector3d& center_m, double time_s);

}  // namespace crashrank::detail

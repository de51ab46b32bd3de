#pragma once

#include "crashrank/motion/motion.hpp"
#include "rank/outline_distance.hpp"
#include "rank/stop_check.hpp"

#include <Eigen/Core>

#include <limits>

namespace crashrank::detail {

/// How a body goes on after the horizon: with its heading and velocity, or, if it brakes, with its
/// deceleration until it stands.
struct Drift {
  Eigen::Vector2d velocity_mps = Eigen::Vector2d::Zero();    ///< at the horizon, world
  double stops_s = std::numeric_limits<double>::infinity();  ///< when it stands, from the horizon
};

/// The drift of a motion at the horizon. Deceleration is the mean of the last half second, and none
/// if the body gets faster. Timed poses that end at the horizon count with the velocity just
/// before.
Drift drift_of(const Motion& motion, double horizon_s);

/// A body in plan view that drifts.
struct DriftingBody {
  const BodyOutline& outline;
  PlanarPose pose;  ///< at the horizon
  Drift drift;
};

/// Time from the horizon until the outlines of two bodies touch, from 0 to `most_s`, at most
/// `longest_time_to_collision_s`; infinity if they do not. Outlines that come within 1 cm of each
/// other count as touching, except while they are apart by less at the horizon and separate. Never
/// later than the time of a contact of the outlines; earlier by more than the time of 1 cm only for
/// outlines that slide along each other at that distance over many metres. Its bits do not depend
/// on `most_s`. Does not allocate; checks `stop` in every step.
double time_to_collision_s(const DriftingBody& a, const DriftingBody& b, double most_s,
                           const StopCheck& stop);

}  // namespace crashrank::detail

#pragma once

#include "crashrank/motion/motion.hpp"
#include "rank/outline_distance.hpp"
#include "rank/stop_check.hpp"

#include <Eigen/Core>

namespace crashrank::detail {

/// A body in plan view that keeps its velocity and heading.
struct DriftingBody {
  const BodyOutline& outline;
  PlanarPose pose;  ///< at time 0
  Eigen::Vector2d velocity_mps = Eigen::Vector2d::Zero();
};

/// Velocity of a motion at the horizon, world, m/s. Timed poses that end at the horizon count with
/// the velocity just before.
Eigen::Vector2d end_velocity_mps(const Motion& motion, double horizon_s);

/// Time until the outlines of two bodies touch, from 0 to `most_s`; infinity if they do not.
/// Outlines that come within 1 cm of each other count as touching, except while they are apart by
/// less at time 0 and separate. Never later than the time of a contact of the outlines; earlier by
/// more than the time of 1 cm only for outlines that slide along each other at that distance over
/// many metres. Its bits do not depend on `most_s`. Does not allocate; checks `stop` in every step.
double time_to_collision_s(const DriftingBody& a, const DriftingBody& b, double most_s,
                           const StopCheck& stop);

}  // namespace crashrank::detail

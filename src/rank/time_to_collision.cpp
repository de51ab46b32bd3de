#include "rank/time_to_collision.hpp"

#include "crashrank/rank/rank.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace crashrank::detail {
namespace {

constexpr double never_s = std::numeric_limits<double>::infinity();

/// Outlines this near touch, m.
constexpr double touching_m = 0.01;
/// Most steps for one pair. Vehicles that pass each other at 2 cm take about this many.
constexpr std::size_t max_advances = 1000;

/// Share of the velocity at the horizon that is left.
double share_left(const Drift& drift, double time_s) {
  return std::max(1.0 - time_s / drift.stops_s, 0.0);
}

PlanarPose moved(const DriftingBody& body, double time_s) {
  const Drift& drift = body.drift;
  // As far as the velocity at the horizon would take it in that time.
  const double time_driven_s =
      time_s < drift.stops_s ? time_s * (1.0 - 0.5 * time_s / drift.stops_s) : 0.5 * drift.stops_s;
  PlanarPose pose = body.pose;
  pose.x += time_driven_s * drift.velocity_mps.x();
  pose.y += time_driven_s * drift.velocity_mps.y();
  return pose;
}

/// Upper bound on the relative speed from a time on: the shares of the velocities only fall, and
/// the relative velocity is linear in both, so it is largest in a corner of their ranges.
double fastest_from_mps(const DriftingBody& a, const DriftingBody& b, double time_s) {
  double fastest2 = 0.0;
  for (const double of_a : {time_s, longest_time_to_collision_s}) {
    for (const double of_b : {time_s, longest_time_to_collision_s}) {
      const Eigen::Vector2d relative = share_left(b.drift, of_b) * b.drift.velocity_mps -
                                       share_left(a.drift, of_a) * a.drift.velocity_mps;
      fastest2 = std::max(fastest2, relative.squaredNorm());
    }
  }
  return std::sqrt(fastest2);
}

}  // namespace

Drift drift_of(const Motion& motion, double horizon_s) {
  // Timed poses are at rest from their last one on.
  constexpr double just_before = 1.0 - 1e-9;
  constexpr double averaged_s = 0.5;
  const double span_s = std::min(averaged_s, 0.5 * horizon_s);
  const auto velocity_at = [&motion](double time_s) -> Eigen::Vector2d {
    return motion.velocity_at(time_s).linear_mps.head<2>();
  };
  Drift drift;
  drift.velocity_mps = velocity_at(just_before * horizon_s);
  const double speed = drift.velocity_mps.norm();
  const double lost = velocity_at(horizon_s - span_s).norm() - speed;
  // Rounding is no braking.
  constexpr double least_lost_mps = 1e-6;
  if (speed > 0.0 && lost > least_lost_mps) drift.stops_s = speed * span_s / lost;
  return drift;
}

double time_to_collision_s(const DriftingBody& a, const DriftingBody& b, double most_s,
                           const StopCheck& stop) {
  NearestChains chains;
  /// A lower bound on the distance that is exact below `near_m`.
  constexpr double near_m = 0.1;
  const auto distance_m = [&](double time_s) {
    const PlanarPose pose_a = moved(a, time_s);
    const PlanarPose pose_b = moved(b, time_s);
    const double rectangles_m = rectangle_distance_m(a.outline, pose_a, b.outline, pose_b);
    if (rectangles_m > near_m) return rectangles_m;
    return outline_distance_m(a.outline, pose_a, b.outline, pose_b, never_s, chains);
  };
  // Convex hulls can touch at the horizon although the bodies do not, for example a mirror over a
  // bonnet. They collide only if they do not separate.
  bool counts = true;
  if (const double fastest = fastest_from_mps(a, b, 0.0);
      fastest > 0.0 && distance_m(0.0) < touching_m) {
    const double trial_s = 0.25 / fastest;
    counts = distance_m(trial_s) <= distance_m(-trial_s);
  }
  // Conservative advancement: no point of an outline is faster than the bound, relative to the
  // other body.
  double time_s = 0.0;
  for (std::size_t step = 0; step < max_advances && time_s <= most_s; ++step) {
    if (stop()) return never_s;
    const double fastest = fastest_from_mps(a, b, time_s);
    if (!(fastest * (longest_time_to_collision_s - time_s) > touching_m)) return never_s;
    const double apart_m = distance_m(time_s);
    if (apart_m < touching_m && counts) {
      time_s += apart_m / fastest;
      if (time_s <= most_s) return time_s;
      return never_s;
    }
    counts = counts || apart_m >= touching_m;
    time_s += std::max(apart_m, touching_m) / fastest;
  }
  if (time_s <= most_s) return time_s;
  return never_s;
}

}  // namespace crashrank::detail

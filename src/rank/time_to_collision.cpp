#include "rank/time_to_collision.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace crashrank::detail {
namespace {

constexpr double never_s = std::numeric_limits<double>::infinity();

/// Outlines this near touch, m.
constexpr double touching_m = 0.01;
/// Most steps for one pair. Vehicles that pass each other at 2 cm take about this many.
constexpr std::size_t max_advances = 1000;

struct Interval {
  double begin_s = 0.0;
  double end_s = 0.0;
};

PlanarPose moved(const DriftingBody& body, double time_s) {
  PlanarPose pose = body.pose;
  pose.x += time_s * body.velocity_mps.x();
  pose.y += time_s * body.velocity_mps.y();
  return pose;
}

Eigen::Vector2d middle_of(const DriftingBody& body) {
  const double x = body.outline.middle_x();
  const double y = body.outline.middle_y();
  const PlanarPose& pose = body.pose;
  return {pose.x + pose.cosine * x - pose.sine * y, pose.y + pose.sine * x + pose.cosine * y};
}

/// Half the extent of the bounding rectangle along a unit vector, m.
double reach_along(const DriftingBody& body, const Eigen::Vector2d& axis) {
  const PlanarPose& pose = body.pose;
  return body.outline.half_x() * std::abs(pose.cosine * axis.x() + pose.sine * axis.y()) +
         body.outline.half_y() * std::abs(pose.cosine * axis.y() - pose.sine * axis.x());
}

/// Time in which the bounding rectangles overlap or are nearer than `touching_m`; begins at
/// infinity if they are never. Rectangles overlap while their projections on all sides of both do
/// (separating axes), and projections of bodies that do not turn move at constant velocity.
Interval rectangles_overlap(const DriftingBody& a, const DriftingBody& b) {
  const Eigen::Vector2d apart = middle_of(b) - middle_of(a);
  const Eigen::Vector2d velocity = b.velocity_mps - a.velocity_mps;
  Interval all{0.0, never_s};
  for (const PlanarPose& pose : {a.pose, b.pose}) {
    for (const Eigen::Vector2d& axis :
         {Eigen::Vector2d(pose.cosine, pose.sine), Eigen::Vector2d(-pose.sine, pose.cosine)}) {
      const double reach = reach_along(a, axis) + reach_along(b, axis) + touching_m;
      const double distance = apart.dot(axis);
      const double speed = velocity.dot(axis);
      if (speed == 0.0) {
        if (std::abs(distance) > reach) return {never_s, never_s};
        continue;
      }
      double begin = (-reach - distance) / speed;
      double end = (reach - distance) / speed;
      if (begin > end) std::swap(begin, end);
      all.begin_s = std::max(all.begin_s, begin);
      all.end_s = std::min(all.end_s, end);
    }
  }
  if (all.begin_s > all.end_s) return {never_s, never_s};
  return all;
}

}  // namespace

Eigen::Vector2d end_velocity_mps(const Motion& motion, double horizon_s) {
  // Timed poses are at rest from their last one on.
  constexpr double just_before = 1.0 - 1e-9;
  return motion.velocity_at(just_before * horizon_s).linear_mps.head<2>();
}

double time_to_collision_s(const DriftingBody& a, const DriftingBody& b, double most_s,
                           const StopCheck& stop) {
  const double speed = (b.velocity_mps - a.velocity_mps).norm();
  if (!(speed * most_s > touching_m)) return never_s;
  const Interval near = rectangles_overlap(a, b);
  const double end_s = std::min(near.end_s, most_s);
  NearestChains chains;
  const auto distance_m = [&](double time_s, double cutoff_m) {
    return outline_distance_m(a.outline, moved(a, time_s), b.outline, moved(b, time_s), cutoff_m,
                              chains);
  };
  double time_s = near.begin_s;
  // Convex hulls can touch at the horizon although the bodies do not, for example a mirror over a
  // bonnet. They collide only if they do not separate.
  bool counts = true;
  if (time_s == 0.0 && distance_m(0.0, touching_m) < touching_m) {
    const double trial_s = 0.25 / speed;
    counts = distance_m(trial_s, never_s) <= distance_m(-trial_s, never_s);
  }
  // Conservative advancement: no point of an outline is faster than `speed`, relative to the other
  // body.
  for (std::size_t step = 0; step < max_advances && time_s <= end_s; ++step) {
    if (stop()) return never_s;
    const double apart_m = distance_m(time_s, (end_s - time_s) * speed + touching_m);
    if (apart_m < touching_m && counts) {
      time_s += apart_m / speed;
      if (time_s <= most_s) return time_s;
      return never_s;
    }
    counts = counts || apart_m >= touching_m;
    time_s += std::max(apart_m, touching_m) / speed;
  }
  if (time_s <= end_s) return time_s;
  return never_s;
}

}  // namespace crashrank::detail

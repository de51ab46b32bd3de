#include "rank/held_manoeuvre.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

using Eigen::Vector2d;

/// Poses every 0.1 s with coordinates to a centimetre tell an acceleration to 0.3 m/s² over this.
constexpr double half_of_poses_s = 0.3;
/// Of what changes smoothly, rounding leaves eight digits.
constexpr double half_s = 0.005;
/// Poses within less time than twice this tell nothing.
constexpr double least_half_s = 0.001;
/// A path that is driven so slowly tells little of how the wheels are turned, m/s.
constexpr double least_steered_mps = 1.0;

struct Placed {
  Vector2d at_m;
  Vector2d forward;
};

Placed placed_at(const Motion& plan, const Eigen::Vector3d& center_m, double time_s) {
  const Pose pose = plan.pose_at(time_s);
  return {(pose.rotation * center_m + pose.translation).head<2>(),
          pose.rotation.col(0).head<2>().normalized()};
}

/// Mean speed along the forward axis.
double speed_between(const Placed& from, const Placed& to, double seconds) {
  return (to.at_m - from.at_m).dot((from.forward + to.forward).normalized()) / seconds;
}

}  // namespace

HeldManoeuvre held_manoeuvre(const Motion& plan, const Eigen::Vector3d& center_m, double time_s) {
  const double end_s = plan.rest_time();
  const double half = std::min(plan.holds_poses() ? half_of_poses_s : half_s, 0.5 * end_s);
  if (!(half >= least_half_s)) return {};
  const double middle_s = std::clamp(time_s, half, end_s - half);
  const Placed before = placed_at(plan, center_m, middle_s - half);
  const Placed middle = placed_at(plan, center_m, middle_s);
  const Placed after = placed_at(plan, center_m, middle_s + half);
  const double first = speed_between(before, middle, half);
  const double last = speed_between(middle, after, half);
  HeldManoeuvre held;
  const double speed = 0.5 * (first + last);
  held.braking_mps2 = (speed < 0.0 ? last - first : first - last) / half;
  if (std::abs(speed) < least_steered_mps) return held;
  const double turned =
      std::atan2(before.forward.x() * after.forward.y() - before.forward.y() * after.forward.x(),
                 before.forward.dot(after.forward));
  held.curvature_per_m = turned / (2.0 * half * speed);
  return held;
}

}  // namespace crashrank::detail

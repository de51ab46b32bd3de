#include "rank/held_manoeuvre.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;

/// Half the span of the differences for timed poses, s. Poses every 0.1 s, rounded to 1 cm, give
/// the acceleration to 0.3 m/s² over this span.
constexpr double half_span_of_poses_s = 0.3;
/// Half the span for smooth motions, s: rounding leaves eight digits.
constexpr double half_span_s = 0.005;
/// Shortest half span: shorter sequences of poses do not determine a manoeuvre.
constexpr double shortest_half_span_s = 0.001;
/// Below this speed the path does not determine the steering angle, m/s.
constexpr double least_steered_mps = 1.0;

struct PlanState {
  Vector3d at_m;
  Vector3d forward;
};

PlanState plan_state(const Motion& plan, const Vector3d& center_m, double time_s) {
  const Pose pose = plan.pose_at(time_s);
  return {pose.rotation * center_m + pose.translation, pose.rotation.col(0).normalized()};
}

/// Mean speed along the forward axis, m/s.
double speed_between(const PlanState& from, const PlanState& to, double seconds) {
  return (to.at_m - from.at_m).dot((from.forward + to.forward).normalized()) / seconds;
}

/// Angle between forward axes about the normal of a road that is level across `middle`, rad.
double turn_between(const PlanState& from, const PlanState& middle, const PlanState& to) {
  const Vector3d across = Vector3d::UnitZ().cross(middle.forward);
  const Vector3d normal = middle.forward.cross(across).stableNormalized();
  return std::atan2(normal.dot(from.forward.cross(to.forward)), from.forward.dot(to.forward));
}

}  // namespace

HeldManoeuvre held_manoeuvre(const Motion& plan, const Vector3d& center_m, double time_s) {
  const double end_s = plan.rest_time();
  const double half_span =
      std::min(plan.holds_poses() ? half_span_of_poses_s : half_span_s, 0.5 * end_s);
  if (!(half_span >= shortest_half_span_s)) return {};
  const double middle_s = std::clamp(time_s, half_span, end_s - half_span);
  const PlanState before = plan_state(plan, center_m, middle_s - half_span);
  const PlanState middle = plan_state(plan, center_m, middle_s);
  const PlanState after = plan_state(plan, center_m, middle_s + half_span);
  const double first = speed_between(before, middle, half_span);
  const double last = speed_between(middle, after, half_span);
  HeldManoeuvre held;
  const double speed = 0.5 * (first + last);
  held.braking_mps2 = (speed < 0.0 ? last - first : first - last) / half_span;
  if (std::abs(speed) < least_steered_mps) return held;
  const double turned = turn_between(before, middle, after);
  held.curvature_per_m = turned / (2.0 * half_span * speed);
  return held;
}

}  // namespace crashrank::detail

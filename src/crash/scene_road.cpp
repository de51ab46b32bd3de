#include "crash/scene_run.hpp"

#include <algorithm>

namespace crashrank::detail {

double SceneRun::grip_of(std::size_t i) const {
  double grip = options_.grip;
  if (!options_.drivable.empty() && options_.off_road_grip != options_.grip) {
    const PlanarBody& b = body(i);
    const Eigen::Vector2d at = origin_m_.head<2>() + Eigen::Vector2d(b.x, b.y);
    if (!holds(options_.drivable, at)) grip = options_.off_road_grip;
  }
  return bodies_[i].footing->wheels ? grip : std::min(grip, options_.sliding_grip);
}

/// Share of its plan that a driver still follows after contacts that changed the velocity by this
/// sum: all of it where nothing happened, none where an airbag or its recorder would wake up.
double SceneRun::plan_share(double changed_mps) const {
  if (changed_mps >= options_.plan_ends_mps) return 0.0;
  const double u = changed_mps / options_.plan_ends_mps;
  return 1.0 - u * u * (3.0 - 2.0 * u);
}

/// State of a body at a time on its plan.
PlanarBody SceneRun::planned_body(std::size_t i, double time_s) const {
  ContactBody body;
  body.vehicle = bodies_[i].vehicle;
  bodies_[i].plan->state_at(time_s, body.pose, body.velocity);
  body.pose.translation += bodies_[i].shift_m;
  return make_planar(body, origin_m_);
}

/// Notes which bodies of the chain have left their plans.
void SceneRun::compare_with_plans() {
  for (const std::uint32_t i : chain_) {
    Member& m = members_[i];
    if (m.state == State::planned || now_s_ > m.on_plan_until_s) continue;
    const PlanarBody plan = planned_body(i, now_s_);
    const PlanarBody& b = body(i);
    const double turned = plane_length(b.cosine - plan.cosine, b.sine - plan.sine);
    if (plane_length(b.x - plan.x, b.y - plan.y) + turned * m.radius_m > on_plan_m) {
      m.on_plan_until_s = now_s_;
    }
  }
}

/// Applies a share of the change of velocity that the plan has in this step, turned by how far the
/// heading has left the plan's.
void SceneRun::follow_plan(std::size_t i, double share, double step_s) {
  const PlanarBody from = planned_body(i, now_s_ - 0.5 * step_s);
  const PlanarBody to = planned_body(i, now_s_ + 0.5 * step_s);
  PlanarBody& b = motion_of(i);
  const double cosine = b.cosine * to.cosine + b.sine * to.sine;
  const double sine = b.sine * to.cosine - b.cosine * to.sine;
  const double ax = share * (to.vx - from.vx);
  const double ay = share * (to.vy - from.vy);
  b.vx += cosine * ax - sine * ay;
  b.vy += sine * ax + cosine * ay;
  b.spin += share * (to.spin - from.spin);
}

/// Applies the forces of the road: a share as the plan has them, the rest as `after_contact`
/// states. During an impact the latter are neglected, as usual in impact mechanics.
void SceneRun::apply_road_forces(std::size_t i, double step_s) {
  // A contact force no larger than `push_factor` times the road force only pushes the body along.
  constexpr double push_factor = 2.0;
  constexpr double impact_s = 0.05;
  const SceneBody& body = bodies_[i];
  const double grip = grip_of(i);
  const double push_limit_mps = push_factor * grip * gravity_mps2 * step_s;
  Member& m = members_[i];
  const double planned = plan_share(m.changed_mps);
  if (planned > 0.0) follow_plan(i, planned, step_s);
  if (m.action.path_mps > push_limit_mps) {
    m.last_impact_s = now_s_;
  }
  if (now_s_ - m.last_impact_s < impact_s) return;
  PlanarBody& b = motion_of(i);
  const PlanarBody before = b;
  apply_tyre_forces(*body.footing, m.wheels, grip, step_s, b);
  b.vx = before.vx + (1.0 - planned) * (b.vx - before.vx);
  b.vy = before.vy + (1.0 - planned) * (b.vy - before.vy);
  b.spin = before.spin + (1.0 - planned) * (b.spin - before.spin);
}

}  // namespace crashrank::detail

#include "crash/contact_run.hpp"
#include "crashrank/crash/pdof.hpp"

#include <algorithm>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;

/// Share of the greatest speed at the contact that, kept at the end of the force, counts as
/// sliding.
constexpr double slides_share = 0.2;

}  // namespace

BodyContact ContactRun::describe(std::size_t body, const ContactBody& given, bool is_first) const {
  BodyContact result;
  const Vehicle& v = *given.vehicle;
  const PlanarBody& start = is_first ? start_first_ : start_second_;
  const PlanarBody& end = is_first ? end_first_ : end_second_;
  const PlanarBody& now = state_.bodies[body].motion;
  const PlanarBody& mover = is_first || !v.movable() ? state_.bodies[0].motion : now;
  const PlanarBody& mover_start = is_first || !v.movable() ? start_first_ : start_second_;
  const double sign = is_first || v.movable() ? 1.0 : -1.0;
  const Vehicle& moved = is_first || !v.movable() ? *given_first_.vehicle : *given_second_.vehicle;
  const double mass = moved.movable() ? moved.mass_kg : 0.0;
  result.impulse_ns =
      sign * mass * Vector3d(mover.vx - mover_start.vx, mover.vy - mover_start.vy, 0.0);
  if (is_first && !v.movable()) {
    const PlanarBody& q = state_.bodies[1].motion;
    result.impulse_ns = -given_second_.vehicle->mass_kg *
                        Vector3d(q.vx - start_second_.vx, q.vy - start_second_.vy, 0.0);
  }
  if (v.movable()) {
    result.delta_v_mps = Vector3d(now.vx - start.vx, now.vy - start.vy, 0.0);
    result.delta_yaw_rate_radps = now.spin - start.spin;
    result.after.linear_mps = Vector3d(now.vx, now.vy, given.velocity.linear_mps.z());
    result.after.angular_radps = given.velocity.angular_radps;
    result.after.angular_radps.z() = now.spin;
    result.moved_m = Vector3d(end.x - start.x, end.y - start.y, 0.0);
    result.turned_rad = end.turned;
  }
  result.pdof_deg = pdof_deg(result.impulse_ns, given.pose.rotation.col(0));
  if (v.strength.rigid) return result;
  result.crush_depth_m = static_cast<double>(is_first ? depth_first_m_ : depth_second_m_);
  for (std::size_t k = 0; k < state_.records.size(); ++k) {
    const PassRecord& record = state_.records[k];
    // Record 0 is of the first body's pieces in the second, the others of theirs in the first.
    const bool own = is_first ? k != 0 : k == 0;
    result.damaged.grow(own ? record.own : record.other);
    result.intrusion_m =
        std::max(result.intrusion_m,
                 static_cast<double>(own ? record.intrusion_own : record.intrusion_other));
  }
  return result;
}

ContactOutcome ContactRun::outcome() const {
  ContactOutcome result;
  result.steps = steps_;
  result.pieces = pieces_;
  if (!acts_) {
    result.a.after = swapped_ ? given_second_.velocity : given_first_.velocity;
    result.b.after = swapped_ ? given_first_.velocity : given_second_.velocity;
  }
  BodyContact first = describe(0, given_first_, true);
  BodyContact second = describe(1, given_second_, false);
  result.acts = acts_;
  result.slides = acts_ && last_passing_mps_ > slides_share * fastest_passing_mps_;
  result.duration_s = duration_s_;
  result.closing_mps = closing_mps_;
  result.restitution = restitution_;
  result.dissipated_j = dissipated_j();
  // Powers at the middles of steps add up to what was lost but for the steps' error: shares of it.
  const double sum = crush_first_j_ + crush_second_j_ + friction_j_;
  const double scale = sum > 0.0 ? result.dissipated_j / sum : 0.0;
  result.friction_j = scale * friction_j_;
  first.crush_energy_j = scale * crush_first_j_;
  second.crush_energy_j = scale * crush_second_j_;
  result.point_m = origin_m_;
  if (point_weight_ > 0.0) {
    result.point_m += Vector3d(point_x_ / point_weight_, point_y_ / point_weight_, 0.0);
  }
  result.a = swapped_ ? second : first;
  result.b = swapped_ ? first : second;
  result.motion = record_.motion(given_first_, given_second_, swapped_);
  return result;
}

Vector3d ContactRun::impulse_ns() const {
  const BodyContact a =
      swapped_ ? describe(1, given_second_, false) : describe(0, given_first_, true);
  return a.impulse_ns;
}

}  // namespace crashrank::detail

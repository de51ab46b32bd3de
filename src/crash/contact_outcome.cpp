#include "crash/contact_run.hpp"
#include "crashrank/crash/contact_law.hpp"

#include <algorithm>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;

/// The contact is reported as sliding if the relative speed at its end exceeds this share of its
/// maximum.
constexpr double slides_share = 0.2;

}  // namespace

BodyContact ContactRun::body_result(bool is_first) const {
  BodyContact result;
  const ContactBody& given = is_first ? given_first_ : given_second_;
  const Vehicle& v = *given.vehicle;
  const PlanarBody& start = is_first ? start_first_ : start_second_;
  const PlanarBody& end = is_first ? end_first_ : end_second_;
  const PlanarBody& now = motion_of(is_first ? first_ : second());
  const PlanarForce& own =
      is_first ? impulse_on_first_ : state_->pairs[pairs_[0]].impulse_on_second;
  // A fixed second body represents all fixed bodies of the contact.
  const double sign = is_first || v.movable() ? 1.0 : -1.0;
  const PlanarForce& impulse = is_first || v.movable() ? own : impulse_on_first_;
  result.impulse_ns = sign * Vector3d(impulse.x, impulse.y, 0.0);
  result.after = given.velocity;
  if (v.movable()) {
    result.delta_v_mps = now.inverse_mass * Vector3d(own.x, own.y, 0.0);
    result.delta_yaw_rate_radps = now.inverse_inertia * own.moment;
    const PlanarBody& last = acts_ ? end : now;
    result.after.linear_mps = Vector3d(last.vx, last.vy, given.velocity.linear_mps.z());
    result.after.angular_radps.z() = last.spin;
    result.moved_m = Vector3d(end.x - start.x, end.y - start.y, 0.0);
    result.turned_rad = end.turned - start.turned;
  }
  result.pdof_deg = pdof_deg(result.impulse_ns, given.pose.rotation.col(0));
  if (v.strength.rigid) return result;
  result.crush_depth_m = static_cast<double>(is_first ? depth_first_m_ : depth_second_m_);
  double deepest_m = 0.0;
  for (const std::uint32_t k : pairs()) {
    const PassRecord& own_side = is_first ? state_->pairs[k].in_first : state_->pairs[k].in_second;
    const PassRecord& other_side =
        is_first ? state_->pairs[k].in_second : state_->pairs[k].in_first;
    result.damaged.grow(own_side.own);
    result.damaged.grow(other_side.other);
    const BodyPair& pair = state_->pairs[k];
    const double earlier_m = is_first ? pair.earlier_first_m : pair.earlier_second_m;
    deepest_m = std::max(deepest_m, pair.intrusion_m(is_first) - earlier_m);
  }
  result.intrusion_m =
      mean_intrusion_m(is_first ? intruded_first_m3_ : intruded_second_m3_, deepest_m);
  return result;
}

ContactOutcome ContactRun::outcome(bool swapped) const {
  ContactOutcome result;
  result.steps = steps_;
  result.pieces = pieces_;
  BodyContact first = body_result(true);
  BodyContact second = body_result(false);
  result.acts = acts_;
  result.slides = acts_ && last_speed_mps_ > slides_share * max_speed_mps_;
  result.duration_s = duration_s_;
  result.closing_mps = max_closing_mps_;
  result.restitution = restitution_;
  result.dissipated_j = dissipated_j();
  // The powers at the middles of steps add up to the dissipated energy except for the integration
  // error; scale them to match it.
  const double deflection_j = std::min(deflection_j_, result.dissipated_j);
  const double sum = crush_first_j_ + crush_second_j_ + friction_j_;
  const double scale = sum > 0.0 ? (result.dissipated_j - deflection_j) / sum : 0.0;
  result.friction_j = scale * friction_j_;
  first.crush_energy_j = scale * crush_first_j_;
  second.crush_energy_j = scale * crush_second_j_ + deflection_j;
  result.point_m = origin_m_;
  result.begin_point_m = origin_m_ + Vector3d(begin_point_m_.x(), begin_point_m_.y(), 0.0);
  if (point_weight_ > 0.0) {
    result.point_m += Vector3d(point_x_ / point_weight_, point_y_ / point_weight_, 0.0);
  }
  result.a = swapped ? second : first;
  result.b = swapped ? first : second;
  result.motion = record_.motion(given_first_, given_second_, swapped);
  return result;
}

}  // namespace crashrank::detail

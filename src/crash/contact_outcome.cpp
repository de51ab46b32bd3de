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
    const PlanarForce& excluded = is_first ? excluded_first_ : excluded_second_;
    result.delta_v_mps = now.inverse_mass * Vector3d(own.x - excluded.x, own.y - excluded.y, 0.0);
    result.delta_yaw_rate_radps = now.inverse_inertia * (own.moment - excluded.moment);
    const PlanarBody& last = acts_ ? end : now;
    result.after.linear_mps = Vector3d(last.vx, last.vy, given.velocity.linear_mps.z());
    result.after.angular_radps.z() = last.spin;
    result.moved_m = Vector3d(end.x - start.x, end.y - start.y, 0.0);
    result.turned_rad = end.turned - start.turned;
  }
  result.pdof_deg = pdof_deg(result.impulse_ns, given.pose.rotation.col(0));
  if (v.strength.rigid) return result;
  result.crush_depth_m = static_cast<double>(is_first ? depth_first_m_ : depth_second_m_);
  for (const std::uint32_t k : pairs()) {
    const PassRecord& own_side = is_first ? state_->pairs[k].in_first : state_->pairs[k].in_second;
    const PassRecord& other_side =
        is_first ? state_->pairs[k].in_second : state_->pairs[k].in_first;
    result.damaged.grow(own_side.own);
    result.damaged.grow(other_side.other);
    const BodyPair& pair = state_->pairs[k];
    const double earlier_m = is_first ? pair.earlier_first_m : pair.earlier_second_m;
    result.intrusion_m = std::max(result.intrusion_m, pair.intrusion_m(is_first) - earlier_m);
  }
  return result;
}

/// Impulses of several contacts that act on a body at the same time may cancel each other, and so
/// may counted and excluded steps; the sum of one contact then overstates what the occupants are
/// exposed to. Limit the delta-v to the greatest velocity change that the body had during the
/// contact, or to the speed at which its kinetic energy would equal its crush energy if that is
/// larger.
void ContactRun::limit_delta_v(const VelocityChange& change, double inverse_mass,
                               BodyContact& contact) {
  const double change_mps = contact.delta_v_mps.norm();
  const double most_mps =
      std::max(change.most_mps, std::sqrt(2.0 * contact.crush_energy_j * inverse_mass));
  if (!change.partial || !(change_mps > most_mps)) return;
  const double share = most_mps / change_mps;
  contact.delta_v_mps *= share;
  contact.delta_yaw_rate_radps *= share;
}

Vector3d ContactRun::squeeze_mps(bool of_first, const BodyContact& contact) const {
  const VelocityChange& change = of_first ? change_first_ : change_second_;
  const double change_mps = contact.delta_v_mps.norm();
  if (!change.partial || !(change_mps > change.along_mps)) return Vector3d::Zero();
  return (1.0 - change.along_mps / change_mps) * contact.delta_v_mps;
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
  const double sum = crush_first_j_ + crush_second_j_ + friction_j_;
  const double scale = sum > 0.0 ? result.dissipated_j / sum : 0.0;
  result.friction_j = scale * friction_j_;
  first.crush_energy_j = scale * crush_first_j_;
  second.crush_energy_j = scale * crush_second_j_;
  limit_delta_v(change_first_, motion_of(first_).inverse_mass, first);
  limit_delta_v(change_second_, motion_of(this->second()).inverse_mass, second);
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

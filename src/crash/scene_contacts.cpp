#include "crash/scene_run.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {

void SceneRun::lock_damaged_wheels(std::size_t i, const Box& damaged) {
  const Footing* const footing = bodies_[i].footing;
  if (footing == nullptr || !footing->wheels || damaged.empty()) return;
  // Half the length and half the width of a tyre, m: damage this close to its centre locks the
  // wheel.
  constexpr double tyre_x_m = 0.3;
  constexpr double tyre_y_m = 0.1;
  const Eigen::Vector3d& center = bodies_[i].vehicle->center_m;
  const Eigen::Array2d y = footing->y_m + center.y();
  unsigned bit = 1;
  for (const double axle_m : {footing->front_m + center.x(), footing->rear_m + center.x()}) {
    for (int side = 0; side < 2; ++side, bit *= 2) {
      const bool reached = axle_m > static_cast<double>(damaged.min.x()) - tyre_x_m &&
                           axle_m < static_cast<double>(damaged.max.x()) + tyre_x_m &&
                           y[side] > static_cast<double>(damaged.min.y()) - tyre_y_m &&
                           y[side] < static_cast<double>(damaged.max.y()) + tyre_y_m;
      if (reached) members_[i].damaged = static_cast<std::uint8_t>(members_[i].damaged | bit);
    }
  }
  set_wheels(i);
}

void SceneRun::close_contact(ContactRun& run) {
  ended_work_ += run.work();
  for (const std::uint32_t k : run.pairs()) {
    memory_.pairs[k].last_end_step = steps_;
  }
  if (run.acts()) {
    const std::size_t first = run.first();
    const std::size_t second = run.most_pressed();
    // The movable body comes first, of two movable bodies the one with the lower index.
    const bool swapped = members_[first].state == State::fixed ||
                         (second < first && members_[second].state != State::fixed);
    const ContactOutcome outcome = run.outcome(swapped);
    lock_damaged_wheels(first, (swapped ? outcome.b : outcome.a).damaged);
    lock_damaged_wheels(second, (swapped ? outcome.a : outcome.b).damaged);
    record_contact(run, outcome, swapped);
  }
  if (&run == first_run_) first_run_ = nullptr;
}

namespace {

using Eigen::Vector3d;

/// Time at which the recorded motion of a contact ends, since its beginning, s.
double motion_end_s(const SceneContact& contact) {
  const ContactMotion& motion = contact.outcome.motion;
  return motion.poses[motion.count - 1].time_s;
}

/// Merges the later contact of a body into the earlier one. The direction of force stays that of
/// the earlier one, and so does delta-v where the later contact reduces it: a tail that swings
/// back.
void merge_body(const BodyContact& later, BodyContact& whole) {
  const Vector3d sum = whole.delta_v_mps + later.delta_v_mps;
  if (sum.squaredNorm() > whole.delta_v_mps.squaredNorm()) {
    whole.delta_v_mps = sum;
    whole.delta_yaw_rate_radps += later.delta_yaw_rate_radps;
  }
  whole.after = later.after;
  whole.crush_depth_m = std::max(whole.crush_depth_m, later.crush_depth_m);
  whole.crush_energy_j += later.crush_energy_j;
  whole.intrusion_m += later.intrusion_m;
  whole.damaged.grow(later.damaged);
}

/// Merges a later contact of the same bodies, which begins `later_s` after the earlier one.
void merge_outcome(const ContactOutcome& later, double later_s, ContactOutcome& whole) {
  whole.steps += later.steps;
  whole.pieces += later.pieces;
  whole.dissipated_j += later.dissipated_j;
  whole.friction_j += later.friction_j;
  merge_body(later.a, whole.a);
  merge_body(later.b, whole.b);
  ContactPoses last = later.motion.poses[later.motion.count - 1];
  last.time_s += later_s;
  if (whole.motion.count < ContactMotion::most) ++whole.motion.count;
  whole.motion.poses[whole.motion.count - 1] = last;
}

}  // namespace

void SceneRun::record_pressed(const ContactRun& run, SceneContact& contact) const {
  for (const std::uint32_t k : run.pairs()) {
    const BodyPair& pair = memory_.pairs[k];
    const auto end = contact.pressed.begin() + static_cast<std::ptrdiff_t>(contact.pressed_count);
    if (!pair.pressed || contact.pressed_count == SceneContact::most_pressed ||
        std::find(contact.pressed.begin(), end, pair.second) != end) {
      continue;
    }
    contact.pressed[contact.pressed_count++] = pair.second;
  }
}

void SceneRun::record_contact(const ContactRun& run, const ContactOutcome& outcome, bool swapped) {
  const std::size_t first = run.first();
  const std::size_t second = run.most_pressed();
  const bool second_is_fixed = members_[second].state == State::fixed;
  const auto a = static_cast<std::uint32_t>(swapped ? second : first);
  const auto b = static_cast<std::uint32_t>(swapped ? first : second);
  const double begin_s = begun_s_[static_cast<std::size_t>(&run - runs_.data())];
  for (std::size_t k = contacts_.size(); k > 0; --k) {
    SceneContact& earlier = contacts_[k - 1];
    if (earlier.a != a || earlier.b != b) continue;
    const double later_s = begin_s - earlier.begin_s;
    if (later_s - motion_end_s(earlier) > SceneContact::merge_window_s) break;
    merge_outcome(outcome, later_s, earlier.outcome);
    if (second_is_fixed) record_pressed(run, earlier);
    return;
  }
  if (contacts_.size() == most_contacts) {
    limit_exceeded_ = true;
    return;
  }
  contacts_.push_back({});
  SceneContact& contact = contacts_.back();
  contact.a = a;
  contact.b = b;
  contact.begin_s = begin_s;
  contact.first_force_s = forced_s_[static_cast<std::size_t>(&run - runs_.data())];
  contact.is_first =
      &run == first_run_ && (members_[partner_].state != State::fixed || second == partner_ ||
                             members_[second].state != State::fixed);
  contact.outcome = outcome;
  const ContactBody given_second = second_is_fixed ? contact_body(second) : run.given_second();
  contact.given_a = swapped ? given_second : run.given_first();
  contact.given_b = swapped ? run.given_first() : given_second;
  if (!second_is_fixed) return;
  record_pressed(run, contact);
  // The contact may have begun with another of the adjoining fixed bodies: use the pose of the one
  // reported.
  ContactMotion& motion = contact.outcome.motion;
  for (std::size_t k = 0; k < motion.count; ++k) {
    (swapped ? motion.poses[k].a : motion.poses[k].b) = given_second.pose;
  }
}

}  // namespace crashrank::detail

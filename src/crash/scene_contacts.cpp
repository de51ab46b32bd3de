#include "crash/scene_run.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {

void SceneRun::lock_damaged_wheels(std::size_t i, const Box& damaged) {
  const Footing* const footing = bodies_[i].footing;
  if (footing == nullptr || !footing->wheels || damaged.empty()) return;
  // A tyre reaches so far around its middle.
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

void SceneRun::close(ContactRun& run) {
  ended_work_ += run.work();
  for (const std::uint32_t k : run.pairs()) {
    memory_.pairs[k].left_at_step = steps_;
    if (run.faded()) memory_.pairs[k].faded_until_s = now_s_ + SceneContact::faded_s;
  }
  if (run.acts()) {
    const std::size_t first = run.first();
    const std::size_t second = run.most_pressed();
    // What moves comes first, of two the lower.
    const bool swapped = members_[first].state == State::fixed ||
                         (second < first && members_[second].state != State::fixed);
    const ContactOutcome outcome = run.outcome(swapped);
    lock_damaged_wheels(first, (swapped ? outcome.b : outcome.a).damaged);
    lock_damaged_wheels(second, (swapped ? outcome.a : outcome.b).damaged);
    tell(run, outcome, swapped);
  }
  if (&run == first_run_) first_run_ = nullptr;
}

namespace {

using Eigen::Vector3d;

/// The share of a later contact's change of velocity, which begins as `given`, that is one: what
/// only makes up for what slows the body, since the earlier force or meanwhile, is none.
double lasting_share(const BodyContact& more, const ContactBody& given, const BodyContact& whole) {
  const double change = more.delta_v_mps.norm();
  if (!(change > 0.0)) return 1.0;
  const Vector3d arm = given.pose.rotation * given.vehicle->center_m;
  const Vector3d begin = given.velocity.linear_mps + given.velocity.angular_radps.cross(arm);
  const Vector3d along = more.delta_v_mps / (change * change);
  const double lost = std::clamp((whole.after.linear_mps - begin).dot(along), 0.0, 1.0);
  return std::clamp((more.after.linear_mps - begin).dot(along) - lost, 0.0, 1.0);
}

/// Since its begin, s.
double rubbed_until_s(const SceneContact& contact) {
  const ContactMotion& motion = contact.outcome.motion;
  return motion.poses[motion.count - 1].time_s;
}

/// Adds what rubbing on after the contact does to one of them: its velocity is that of before.
void add_body(const BodyContact& more, BodyContact& whole) {
  whole.after = more.after;
  whole.crush_depth_m = std::max(whole.crush_depth_m, more.crush_depth_m);
  whole.crush_energy_j += more.crush_energy_j;
  whole.intrusion_m += more.intrusion_m;
  whole.damaged.grow(more.damaged);
}

/// Adds rubbing on, which begins `later_s` after the contact.
void add_rubbing(const ContactOutcome& more, double later_s, ContactOutcome& whole) {
  whole.dissipated_j += more.dissipated_j;
  whole.friction_j += more.friction_j;
  add_body(more.a, whole.a);
  add_body(more.b, whole.b);
  ContactPoses last = more.motion.poses[more.motion.count - 1];
  last.time_s += later_s;
  if (whole.motion.count < ContactMotion::most) ++whole.motion.count;
  whole.motion.poses[whole.motion.count - 1] = last;
}

}  // namespace

void SceneRun::tell_pressed(const ContactRun& run, SceneContact& told) const {
  for (const std::uint32_t k : run.pairs()) {
    const BodyPair& pair = memory_.pairs[k];
    const auto end = told.pressed.begin() + static_cast<std::ptrdiff_t>(told.pressed_count);
    if (!pair.pressed || told.pressed_count == SceneContact::most_pressed ||
        std::find(told.pressed.begin(), end, pair.second) != end) {
      continue;
    }
    told.pressed[told.pressed_count++] = pair.second;
  }
}

void SceneRun::tell(const ContactRun& run, const ContactOutcome& outcome, bool swapped) {
  const std::size_t first = run.first();
  const std::size_t second = run.most_pressed();
  const bool stands = members_[second].state == State::fixed;
  const auto a = static_cast<std::uint32_t>(swapped ? second : first);
  const auto b = static_cast<std::uint32_t>(swapped ? first : second);
  const double begin_s = begun_s_[static_cast<std::size_t>(&run - runs_.data())];
  for (std::size_t k = contacts_.size(); k > 0; --k) {
    SceneContact& earlier = contacts_[k - 1];
    if (earlier.a != a || earlier.b != b) continue;
    const double later_s = begin_s - earlier.begin_s;
    if (later_s - rubbed_until_s(earlier) > SceneContact::same_contact_s) break;
    const ContactBody& given_a = swapped ? run.given_second() : run.given_first();
    const ContactBody& given_b = swapped ? run.given_first() : run.given_second();
    const double change = std::max(
        lasting_share(outcome.a, given_a, earlier.outcome.a) * outcome.a.delta_v_mps.norm(),
        lasting_share(outcome.b, given_b, earlier.outcome.b) * outcome.b.delta_v_mps.norm());
    if (change > SceneContact::rubbing_mps) break;
    add_rubbing(outcome, later_s, earlier.outcome);
    if (stands) tell_pressed(run, earlier);
    return;
  }
  if (contacts_.size() == most_contacts) {
    crowded_ = true;
    return;
  }
  contacts_.push_back({});
  SceneContact& told = contacts_.back();
  told.a = a;
  told.b = b;
  told.begin_s = begin_s;
  told.goes_on = goes_on_[static_cast<std::size_t>(&run - runs_.data())] != 0;
  told.is_first =
      &run == first_run_ && (members_[partner_].state != State::fixed || second == partner_ ||
                             members_[second].state != State::fixed);
  told.outcome = outcome;
  const ContactBody given_second = stands ? given(second) : run.given_second();
  told.given_a = swapped ? given_second : run.given_first();
  told.given_b = swapped ? run.given_first() : given_second;
  if (!stands) return;
  tell_pressed(run, told);
  // Of several that nothing moves the contact may have begun with another.
  ContactMotion& motion = told.outcome.motion;
  for (std::size_t k = 0; k < motion.count; ++k) {
    (swapped ? motion.poses[k].a : motion.poses[k].b) = given_second.pose;
  }
}

}  // namespace crashrank::detail

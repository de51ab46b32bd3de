#include "crash/scene_run.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {

PlanarBody SceneRun::TrackedBody::body() const {
  PlanarBody b;
  b.x = double{x};
  b.y = double{y};
  b.cosine = double{cosine};
  b.sine = double{sine};
  b.vx = double{vx};
  b.vy = double{vy};
  b.spin = double{spin};
  return b;
}

void SceneRun::track(double step_s) {
  if (!options_.records_track || track_ends_) return;
  track_ends_ =
      track_steps_.size() == most_tracked_steps || track_.size() + chain_.size() > most_tracked;
  if (track_ends_) return;
  track_steps_.push_back({now_s_, step_s, track_step_s_, static_cast<std::uint32_t>(track_.size()),
                          static_cast<std::uint32_t>(chain_.size())});
  for (const std::uint32_t i : chain_) {
    const PlanarBody& b = body(i);
    const auto single = [](double number) { return static_cast<float>(number); };
    track_.push_back({single(b.x), single(b.y), single(b.cosine), single(b.sine), single(b.vx),
                      single(b.vy), single(b.spin)});
  }
  track_step_s_ = step_s;
}

bool SceneRun::would_act(const SceneBody& body, std::size_t most_bodies) const {
  // Without a track nothing can be excluded.
  if (track_ends_ || track_steps_.empty()) return true;
  Member member;
  compute_extents(*body.vehicle, member);
  // Lists that overflow leave out the furthest bodies, so even a listed body can matter.
  const double listed = most_bodies > most_near + 1 ? listed_m : 0.0;
  for (std::size_t place = 0; place < chain_.size(); ++place) {
    if (comes_near(body, member, place, listed)) return true;
  }
  return false;
}

/// Returns true if in some step the body might have pressed on the body at position `place` of the
/// chain, or shortened the step.
///
/// A pair shortens a step of length S if its gap G at the beginning of the step is less than S·c +
/// live_m / 2, with c its closing bound; it presses if the gap g in the middle of the step is less
/// than live_m. The track has g. From the beginning to the middle of the step the gap shrinks by at
/// most S·c / 2. In addition, the planned body is still placed for the middle of the previous step,
/// of length B, at the beginning: its own speed times B / 2. The pair therefore does neither if g >
/// 3/2 S·c + B / 2 · own + live_m / 2 and g > live_m. Where it also matters whether the body is
/// listed at the beginning of a step, `more_m` is added.
bool SceneRun::comes_near(const SceneBody& body, const Member& member, std::size_t place,
                          double more_m) const {
  const std::size_t i = chain_[place];
  if (!can_press(*bodies_[i].vehicle, *body.vehicle)) return false;
  // The track has single precision.
  constexpr double rounding_m = 1e-3;
  const bool movable = !body.vehicle->stands();
  MotionBound bound;
  if (movable) {
    bound = body.plan->bound(track_steps_.front().time_s, track_steps_.back().time_s);
  }
  const double arm_m = body.vehicle->center_m.head<2>().norm();
  const double turning_mps = bound.angular_radps * member.radius_m;
  const double own_mps = bound.speed_mps + bound.angular_radps * (member.radius_m + arm_m);
  // Change of velocity of the centre of mass: at kinks of the plan the yaw rate may drop to zero at
  // once.
  const double change_mps = bound.angular_radps * arm_m;
  const double change_mps2 =
      bound.acceleration_mps2 +
      (bound.angular_radps2 + bound.angular_radps * bound.angular_radps) * arm_m;
  const double closing_mps = track_fastest_mps_ + own_mps;
  const double most_needed_m =
      options_.rolling_step_s * (1.5 * closing_mps + 0.5 * own_mps) + live_m + more_m + rounding_m;
  ContactBody contact_body;
  contact_body.vehicle = body.vehicle;
  auto at_step =
      std::partition_point(track_steps_.begin(), track_steps_.end(),
                           [place](const TrackedStep& step) { return step.count <= place; });
  while (at_step != track_steps_.end()) {
    const TrackedStep& step = *at_step++;
    const PlanarBody own = track_[step.first + place].body();
    body.plan->state_at(step.time_s, contact_body.pose, contact_body.velocity);
    if (!movable) contact_body.velocity = {};
    const PlanarBody at = make_planar(contact_body, origin_m_);
    const double gap = gap_m(members_[i], own, member, at);
    if (gap > most_needed_m) {
      const double clear_until_s = step.time_s + (gap - most_needed_m) / closing_mps;
      at_step = std::partition_point(
          at_step, track_steps_.end(),
          [clear_until_s](const TrackedStep& next) { return next.time_s < clear_until_s; });
      continue;
    }
    // The velocities of plans given as timed poses are discontinuous.
    const double relative_mps = body.plan->holds_poses()
                                    ? plane_length(own.vx, own.vy) + own_mps
                                    : plane_length(own.vx - at.vx, own.vy - at.vy) + change_mps +
                                          change_mps2 * (step.step_s + step.before_s);
    const double step_closing_mps =
        relative_mps + members_[i].radius_m * std::abs(own.spin) + turning_mps;
    const double needed_m =
        1.5 * step.step_s * step_closing_mps + 0.5 * step.before_s * own_mps + 0.5 * live_m;
    if (!(gap > std::max(needed_m, live_m) + more_m + rounding_m)) return true;
  }
  return false;
}

}  // namespace crashrank::detail

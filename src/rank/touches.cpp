#include "rank/touches.hpp"

#include "crash/event_times.hpp"
#include "rank/hits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crashrank::detail {
namespace {

constexpr double never_s = -std::numeric_limits<double>::infinity();

bool are_one(const Scene& scene, std::size_t p, std::size_t q) {
  const std::size_t joined = p == ego_body ? Scene::not_joined : scene.joined_of[p];
  return p == q || (joined != Scene::not_joined && q != ego_body && scene.joined_of[q] == joined);
}

/// First time from which the ego and an actor press on each other; infinity: never.
double first_press_s(const Scene& scene, const CrashChain& chain, std::size_t actor) {
  double first_s = std::numeric_limits<double>::infinity();
  for (const SceneContact& contact : chain.contacts()) {
    if (chain.body(contact.a) == ego_body && are_one(scene, chain.body(contact.b), actor)) {
      first_s = std::min(first_s, contact.begin_s);
    }
  }
  return first_s;
}

/// First time from which the ego presses on an actor or, in the same contact, on a body that
/// adjoins it; infinity: never.
double first_force_s(const Scene& scene, const CrashChain& chain, std::size_t actor) {
  double first_s = std::numeric_limits<double>::infinity();
  for (const SceneContact& contact : chain.contacts()) {
    if (chain.body(contact.a) != ego_body) continue;
    bool presses = are_one(scene, chain.body(contact.b), actor);
    for (std::size_t k = 0; k < contact.pressed_count; ++k) {
      presses = presses || are_one(scene, chain.body(contact.pressed[k]), actor);
    }
    if (presses) first_s = std::min(first_s, contact.first_force_s);
  }
  return first_s;
}

void mark_contacts_without_force(const Scene& scene, Scratch& scratch) {
  for (Touch& touch : scratch.touches) {
    Contact& contact = touch.contact;
    const double speed_mps =
        contact.normal.isZero(0.0) ? contact.closing_speed_mps : contact.normal_speed_mps;
    const double within_s = std::min(force_within_s, force_within_m / speed_mps);
    contact.contact_without_force =
        speed_mps > least_forced_speed_mps &&
        first_force_s(scene, scratch.chain, contact.actor) > contact.time_of_impact_s + within_s;
  }
}

void add_touch(const Scene& scene, const Motion& ego, const Scratch::Hit& hit, Scratch& scratch) {
  const Motion& plan = scene.futures.plans[hit.plan].motion;
  Touch touch;
  touch.contact = first_contact(scene, ego, hit.actor, plan, hit.impact);
  touch.triangle_ego = hit.impact.triangle_a;
  touch.triangle_other = hit.impact.triangle_b;
  Velocity velocity;
  ego.state_at(hit.impact.time_s, touch.ego, velocity);
  touch.ego_mps = velocity.linear_mps.norm();
  plan.state_at(hit.impact.time_s, touch.other, velocity);
  touch.other_mps = velocity.linear_mps.norm();
  scratch.touches.push_back(touch);
}

bool is_listed(const Scene& scene, const Scratch& scratch, std::size_t actor) {
  return std::any_of(scratch.touches.begin(), scratch.touches.end(), [&](const Touch& touch) {
    return are_one(scene, touch.contact.actor, actor);
  });
}

}  // namespace

void begin_touches(const Scene& scene, const Motion& ego, const Scratch::Hit& first,
                   Scratch& scratch) {
  scratch.touches.clear();
  scratch.later_hits.clear();
  scratch.later_hits_known = false;
  scratch.touched_until_s = never_s;
  add_touch(scene, ego, first, scratch);
}

bool find_touches(const Scene& scene, const Motion& ego, std::size_t future, Scratch& scratch,
                  RankWork& work) {
  const CrashChain& chain = scratch.chain;
  scratch.touches.resize(1);
  scratch.touched_until_s = never_s;
  if (chain.first_acts()) {
    mark_contacts_without_force(scene, scratch);
    return true;
  }
  if (!scratch.later_hits_known) {
    const std::size_t except = scratch.touches.front().contact.actor;
    if (!find_all_hits(scene, ego, scene.futures.group(future), except, scratch, work) ||
        scratch.stopped()) {
      return false;
    }
    scratch.later_hits_known = true;
  }
  scratch.touched_until_s = chain.first_force_s();
  const auto presses = [&](std::size_t actor) { return first_press_s(scene, chain, actor); };
  Touch& first = scratch.touches.front();
  first.presses_later = std::isfinite(presses(first.contact.actor));
  for (const Scratch::Hit& hit : scratch.later_hits) {
    if (hit.impact.time_s > scratch.touched_until_s) break;
    if (!scene.futures.follows(future, hit.plan) || is_listed(scene, scratch, hit.actor)) continue;
    // Surfaces touch just before outlines press: where nothing has changed in between, the contact
    // with the force says all.
    const double press_s = presses(hit.actor);
    if (press_s == scratch.touched_until_s && press_s - hit.impact.time_s < same_event_s) continue;
    add_touch(scene, ego, hit, scratch);
    scratch.touches.back().presses_later = std::isfinite(press_s);
  }
  mark_contacts_without_force(scene, scratch);
  return true;
}

void mark_relevant_touches(const Scratch& scratch, std::vector<char>& relevant) {
  for (const Scratch::Hit& hit : scratch.later_hits) {
    if (hit.impact.time_s > scratch.touched_until_s) return;
    relevant[hit.plan] = 1;
  }
}

}  // namespace crashrank::detail

#include "rank/contact_force.hpp"

#include "rank/hits.hpp"
#include "rank/nearby_actors.hpp"
#include "rank/report_contacts.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace crashrank::detail {
namespace {

/// True for one body and for parts of one joined body.
bool are_one(const Scene& scene, std::size_t p, std::size_t q) {
  if (p == q) return true;
  if (p == ego_body || q == ego_body) return false;
  return scene.joined_of[p] != Scene::not_joined && scene.joined_of[p] == scene.joined_of[q];
}

/// First time from which the ego presses on an actor or, in the same contact, on a body that
/// adjoins it, s; infinity: never.
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

bool lacks_force(const Scene& scene, const CrashChain& chain, const Contact& contact) {
  const double speed_mps =
      contact.normal.isZero(0.0) ? contact.closing_speed_mps : contact.normal_speed_mps;
  if (!(speed_mps > least_forced_speed_mps)) return false;
  const double within_s = std::min(force_within_s, force_within_m / speed_mps);
  return first_force_s(scene, chain, contact.actor) > contact.time_of_impact_s + within_s;
}

/// Time until which an actor keeps to its plan in the simulation, s.
double on_plan_until_s(const Scene& scene, const CrashChain& chain, std::size_t actor) {
  std::size_t k = 0;
  while (k < chain.bodies() && !are_one(scene, chain.body(k), actor)) ++k;
  return k < chain.bodies() ? chain.run().on_plan_until_s(k)
                            : std::numeric_limits<double>::infinity();
}

}  // namespace

std::optional<std::size_t> actor_without_force(const Scene& scene, const Motion& ego,
                                               std::size_t future, const Contact& first,
                                               Scratch& scratch, RankWork& work) {
  const CrashChain& chain = scratch.chain;
  if (lacks_force(scene, chain, first)) return first.actor;
  const double from_s = first.time_of_impact_s;
  const double until_s = std::min(on_plan_until_s(scene, chain, ego_body), scene.slice_s.back());
  if (!(until_s > from_s)) return no_actor;
  find_nearby_actors(scene, ego, scene.futures.group(future), from_s, until_s, scratch, work);
  ImpactOptions options = scene.impact;
  options.stop = scratch.stop.ask;
  options.stop_context = scratch.stop.context;
  for (const Scratch::Near& near : scratch.near) {
    const Plan& plan = scene.futures.plans[near.plan];
    if (!scene.futures.follows(future, near.plan) || are_one(scene, plan.actor, first.actor)) {
      continue;
    }
    const double begin_s = std::max(from_s, scene.slice_s[near.first_slice]);
    const double end_s = std::min(
        {until_s, scene.slice_s[near.last_slice + 1], on_plan_until_s(scene, chain, plan.actor)});
    if (begin_s > end_s) continue;
    const Impact impact = find_impact(scene, ego, plan, begin_s, end_s, scratch.impact, options);
    work.impact += impact.work;
    if (impact.state == ImpactState::undecided && scratch.stopped()) return {};
    if (!impact.hit()) continue;
    const Contact contact = first_touch(scene, ego, plan.actor, plan.motion, impact).contact;
    if (lacks_force(scene, chain, contact)) return plan.actor;
  }
  return no_actor;
}

}  // namespace crashrank::detail

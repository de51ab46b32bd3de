#include "rank/contact_force.hpp"

#include "rank/report_contacts.hpp"

#include <algorithm>
#include <cmath>
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

/// Most deviation of the ego from its plan for which the contacts of the plan count, m.
constexpr double on_plan_m = 0.1;

/// Upper bound of the deviation of a body from its plan at a time, by the contacts before, m.
double deviation_m(const Scene& scene, const CrashChain& chain, std::size_t body, double time_s) {
  const Body& of = body == ego_body ? scene.ego : scene.actors[body];
  double deviation = 0.0;
  for (const SceneContact& contact : chain.contacts()) {
    const double after_s = time_s - contact.first_force_s;
    const bool is_a = are_one(scene, chain.body(contact.a), body);
    if (!(is_a || are_one(scene, chain.body(contact.b), body)) || !(after_s > 0.0)) continue;
    const BodyContact& own = is_a ? contact.outcome.a : contact.outcome.b;
    const double turned = std::abs(own.delta_yaw_rate_radps) * after_s;
    // From 1 m/s on the driver no longer follows the plan, but brakes or coasts.
    const double braked = 0.5 * standard_gravity_mps2 * std::min(1.0, own.delta_v_mps.norm());
    deviation += own.delta_v_mps.norm() * after_s + braked * after_s * after_s +
                 turned * (of.radius_m + 0.5 * own.after.linear_mps.norm() * after_s);
  }
  return deviation;
}

}  // namespace

std::size_t actor_without_force(const Scene& scene, const Motion& ego, std::size_t future,
                                const CrashChain& chain, const Contact& first,
                                ImpactWorkspace& workspace) {
  if (lacks_force(scene, chain, first)) return first.actor;
  double until_s = first.time_of_impact_s;
  constexpr double step_s = 0.05;
  while (until_s < scene.slice_s.back() &&
         deviation_m(scene, chain, ego_body, until_s + step_s) <= on_plan_m) {
    until_s += step_s;
  }
  if (!(until_s > first.time_of_impact_s)) return no_actor;
  for (std::size_t i = 0; i < scene.actors.size(); ++i) {
    const std::uint32_t followed = scene.futures.plan(future, i);
    if (followed == Futures::absent || are_one(scene, i, first.actor)) continue;
    const Motion& motion = scene.futures.plans[followed].motion;
    const Impact impact =
        time_of_impact(scene.ego.model->tree, ego, scene.actors[i].model->tree, motion,
                       first.time_of_impact_s, until_s, workspace, scene.impact);
    if (!impact.hit() || deviation_m(scene, chain, i, impact.time_s) > on_plan_m) continue;
    if (lacks_force(scene, chain, first_touch(scene, ego, i, motion, impact).contact)) return i;
  }
  return no_actor;
}

}  // namespace crashrank::detail

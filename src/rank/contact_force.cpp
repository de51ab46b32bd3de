#include "rank/contact_force.hpp"

#include <algorithm>
#include <cstddef>
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

}  // namespace

bool lacks_force(const Scene& scene, const CrashChain& chain, const Contact& first) {
  const double speed_mps =
      first.normal.isZero(0.0) ? first.closing_speed_mps : first.normal_speed_mps;
  if (!(speed_mps > least_forced_speed_mps)) return false;
  const double within_s = std::min(force_within_s, force_within_m / speed_mps);
  return first_force_s(scene, chain, first.actor) > first.time_of_impact_s + within_s;
}

}  // namespace crashrank::detail

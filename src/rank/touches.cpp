#include "rank/touches.hpp"

#include "rank/hits.hpp"

#include <algorithm>
#include <limits>

namespace crashrank::detail {
namespace {

constexpr double never_s = -std::numeric_limits<double>::infinity();

void add_touch(const Scene& scene, const Motion& ego, const Scratch::Hit& hit, Scratch& scratch) {
  const Motion& plan = scene.futures.plans[hit.plan].motion;
  Touch touch;
  touch.contact = first_contact(scene, ego, hit.actor, plan, hit.impact);
  touch.triangle_ego = hit.impact.triangle_a;
  touch.triangle_other = hit.impact.triangle_b;
  touch.ego = ego.pose_at(hit.impact.time_s);
  touch.other = plan.pose_at(hit.impact.time_s);
  scratch.touches.push_back(touch);
}

bool is_listed(const Scene& scene, const Scratch& scratch, std::size_t actor) {
  const std::size_t joined = scene.joined_of[actor];
  return std::any_of(scratch.touches.begin(), scratch.touches.end(), [&](const Touch& touch) {
    const std::size_t other = touch.contact.actor;
    return other == actor || (joined != Scene::not_joined && scene.joined_of[other] == joined);
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
  if (chain.first_acts()) return true;
  if (!scratch.later_hits_known) {
    const std::size_t first = scratch.touches.front().contact.actor;
    if (!find_all_hits(scene, ego, scene.futures.group(future), first, scratch, work) ||
        scratch.stopped()) {
      return false;
    }
    scratch.later_hits_known = true;
  }
  scratch.touched_until_s = chain.first_force_s();
  for (const Scratch::Hit& hit : scratch.later_hits) {
    if (hit.impact.time_s > scratch.touched_until_s) break;
    if (!scene.futures.follows(future, hit.plan) || chain.presses_on_ego(hit.actor) ||
        is_listed(scene, scratch, hit.actor)) {
      continue;
    }
    add_touch(scene, ego, hit, scratch);
  }
  return true;
}

void mark_relevant_touches(const Scratch& scratch, std::vector<char>& relevant) {
  for (const Scratch::Hit& hit : scratch.later_hits) {
    if (hit.impact.time_s > scratch.touched_until_s) return;
    relevant[hit.plan] = 1;
  }
}

}  // namespace crashrank::detail

#include "rank/nearby_actors.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace crashrank::detail {

void find_nearby_actors(const Scene& scene, const Motion& ego, const FutureGroup& group,
                        double from_s, double until_s, Scratch& scratch, RankWork& work) {
  const bool is_single_future = scene.futures.displaces_ego();
  constexpr std::size_t not_listed = std::numeric_limits<std::size_t>::max();
  scratch.near.clear();
  scratch.place.assign(scene.futures.plans.size(), not_listed);
  for (std::size_t s = 0; s < scene.slices.size(); ++s) {
    if (scene.slice_s[s + 1] < from_s || scene.slice_s[s] > until_s) continue;
    const Box box = swept_box(scene.ego, ego, std::max(scene.slice_s[s], from_s),
                              std::min(scene.slice_s[s + 1], until_s), scene.impact.tolerance_m);
    work.box_tests += scene.slices[s].query(box, [&](std::size_t plan) {
      if (is_single_future && !scene.futures.follows(group.begin, plan)) return;
      std::size_t& place = scratch.place[plan];
      if (place == not_listed) {
        place = scratch.near.size();
        scratch.near.push_back({plan, s, s});
      }
      scratch.near[place].last_slice = s;
    });
  }
  std::sort(
      scratch.near.begin(), scratch.near.end(), [](const Scratch::Near& p, const Scratch::Near& q) {
        return p.first_slice != q.first_slice ? p.first_slice < q.first_slice : p.plan < q.plan;
      });
}

bool all_are_clear(const Scene& scene, View<const Candidate> candidates, const Deadline& deadline,
                   std::uint64_t& box_tests) {
  constexpr std::size_t candidates_per_check = 64;
  for (std::size_t s = 0; s < scene.slices.size(); ++s) {
    Box all;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (i % candidates_per_check == 0 && deadline.expired()) return false;
      const Box box = swept_box(scene.ego, candidates[i].motion, scene.slice_s[s],
                                scene.slice_s[s + 1], scene.impact.tolerance_m);
      // a union with NaN can leave the box unchanged
      if (box.min.hasNaN() || box.max.hasNaN()) return false;
      all.grow(box);
    }
    bool clear = true;
    box_tests += scene.slices[s].query(all, [&clear](std::size_t) { clear = false; });
    if (!clear) return false;
  }
  return true;
}

}  // namespace crashrank::detail

#include "rank/reach.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace crashrank::detail {
namespace {

/// Margins around the area of the candidates, m: most crashes throw bodies less far than the
/// largest beyond it, and many concern nobody beyond the smallest.
constexpr std::array<float, 4> margins_m{2.0F, 8.0F, 20.0F, 50.0F};
/// Plans are followed for this time after the horizon, s, since a simulation continues after the
/// last contact.
constexpr double after_horizon_s = 3.0;
/// Approximate duration over which one box is swept, s.
constexpr double interval_s = 0.25;

/// Bounding box of a motion over [0, until].
Box swept_box_until(const Body& body, const Motion& motion, double until_s,
                    std::uint64_t& box_tests) {
  Box whole;
  const auto intervals = std::max<std::size_t>(1, static_cast<std::size_t>(until_s / interval_s));
  for (std::size_t i = 0; i < intervals; ++i) {
    const double share = 1.0 / static_cast<double>(intervals);
    whole.grow(swept_box(body, motion, until_s * share * static_cast<double>(i),
                         until_s * share * static_cast<double>(i + 1), 0.0));
    ++box_tests;
  }
  return whole;
}

/// Rings of actors: needed by a crash, within the margins, and beyond the largest of them.
constexpr char always = 0;
constexpr char first_ring = 1;
constexpr auto beyond = static_cast<char>(first_ring + static_cast<char>(margins_m.size()));

/// Ring of the smallest margin around `area` that the box reaches. Crashes are simulated in the
/// plane of the road, so heights do not matter.
char ring_of(const Box& box, const Box& area) {
  const float gap_m = std::max((box.min - area.max).head<2>().maxCoeff(),
                               (area.min - box.max).head<2>().maxCoeff());
  const auto within = [gap_m](float margin_m) { return !(gap_m > margin_m); };
  const auto margin = std::find_if(margins_m.begin(), margins_m.end(), within);
  return static_cast<char>(first_ring + (margin - margins_m.begin()));
}

/// What lies within the smallest margin may be hit along a plan, which no simulation would notice
/// if it were left out. Leaves out the actors beyond the largest margin for which the combinations
/// of the others can be listed; beyond the largest of all if there is none, or if the futures are a
/// sample in any case, which then spends futures on what is improbable of all within it.
bool leave_out_beyond_rings(Futures& futures, const std::vector<char>& rings) {
  const auto fits = [&](char last) {
    return futures.combinations_within(rings, last) <= double{Futures::max_combinations};
  };
  constexpr char largest = beyond - 1;
  char last = largest;
  while (last > first_ring && !fits(last)) --last;
  if (futures.summary.has_state_errors || !fits(last)) last = largest;
  return futures.leave_out_beyond(rings, last);
}

}  // namespace

bool leave_out_distant_actors(Scene& scene, View<const Candidate> candidates,
                              std::vector<char>& rings, std::uint64_t& box_tests) {
  Futures& futures = scene.futures;
  if (!futures.can_leave_out() || candidates.empty()) return false;
  const double horizon_s = scene.slice_s.back();
  Box near;
  for (const Candidate& candidate : candidates) {
    const Box box = swept_box_until(scene.ego, candidate.motion, horizon_s, box_tests);
    near.grow(box);
  }
  std::fill(rings.begin(), rings.end(), beyond);
  for (std::size_t p = 0; p < futures.own_plans(); ++p) {
    const std::size_t actor = futures.plans[p].actor;
    if (futures.is_certain(actor)) continue;
    const Box box = swept_box_until(scene.actors[actor], futures.plans[p].motion,
                                    horizon_s + after_horizon_s, box_tests);
    rings[actor] = std::min(rings[actor], ring_of(box, near));
  }
  return leave_out_beyond_rings(futures, rings);
}

bool include_needed_actors(Scene& scene, std::vector<char>& needed, int repeats,
                           std::vector<char>& rings) {
  constexpr int most_repeats = 6;
  bool any = false;
  for (std::size_t i = 0; i < needed.size(); ++i) {
    any = any || needed[i] != 0;
    if (needed[i] != 0) rings[i] = always;
    needed[i] = 0;
  }
  if (!any) return false;
  if (repeats >= most_repeats) std::fill(rings.begin(), rings.end(), always);
  leave_out_beyond_rings(scene.futures, rings);
  return true;
}

}  // namespace crashrank::detail

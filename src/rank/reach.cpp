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
constexpr double interval_s = 1.0;

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

/// Index of the smallest margin around `area` that the box reaches; their number if it reaches
/// none. Crashes are simulated in the plane of the road, so heights do not matter.
char ring_of(const Box& box, const Box& area) {
  const float gap_m = std::max((box.min - area.max).head<2>().maxCoeff(),
                               (area.min - box.max).head<2>().maxCoeff());
  const auto within = [gap_m](float margin_m) { return !(gap_m > margin_m); };
  return static_cast<char>(std::find_if(margins_m.begin(), margins_m.end(), within) -
                           margins_m.begin());
}

}  // namespace

bool leave_out_distant_actors(Scene& scene, View<const Candidate> candidates,
                              std::vector<char>& reached, std::uint64_t& box_tests) {
  Futures& futures = scene.futures;
  if (!futures.can_leave_out() || candidates.empty()) return false;
  const double horizon_s = scene.slice_s.back();
  Box near;
  for (const Candidate& candidate : candidates) {
    const Box box = swept_box_until(scene.ego, candidate.motion, horizon_s, box_tests);
    near.grow(box);
  }
  constexpr auto beyond = static_cast<char>(margins_m.size());
  std::fill(reached.begin(), reached.end(), beyond);
  for (std::size_t p = 0; p < futures.own_plans(); ++p) {
    const std::size_t actor = futures.plans[p].actor;
    if (futures.is_certain(actor)) continue;
    const Box box = swept_box_until(scene.actors[actor], futures.plans[p].motion,
                                    horizon_s + after_horizon_s, box_tests);
    reached[actor] = std::min(reached[actor], ring_of(box, near));
  }
  char last = beyond - 1;
  while (last > 0 && futures.combinations_within(reached, last) > futures.most_combinations()) {
    --last;
  }
  // With too many of them all are drawn: those within the largest margin then get futures.
  if (futures.combinations_within(reached, last) > futures.most_combinations()) last = beyond - 1;
  for (char& each : reached) each = each <= last ? 1 : 0;
  return futures.leave_out_unreached(reached);
}

bool include_needed_actors(Scene& scene, std::vector<char>& needed, int repeats,
                           std::vector<char>& reached) {
  constexpr int most_repeats = 4;
  bool any = false;
  for (std::size_t i = 0; i < needed.size(); ++i) {
    any = any || needed[i] != 0;
    reached[i] |= needed[i];
    needed[i] = 0;
  }
  if (!any) return false;
  if (repeats >= most_repeats) std::fill(reached.begin(), reached.end(), char{1});
  scene.futures.leave_out_unreached(reached);
  return true;
}

}  // namespace crashrank::detail

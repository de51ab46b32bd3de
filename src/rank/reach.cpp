#include "rank/reach.hpp"

#include <algorithm>
#include <cstddef>

namespace crashrank::detail {
namespace {

/// Margin around the area of the candidates, m: most crashes throw bodies less far beyond it.
constexpr float throw_distance_m = 50.0F;
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
  near.min.head<2>().array() -= throw_distance_m;
  near.max.head<2>().array() += throw_distance_m;
  std::fill(reached.begin(), reached.end(), char{0});
  for (std::size_t p = 0; p < futures.own_plans(); ++p) {
    const std::size_t actor = futures.plans[p].actor;
    if (reached[actor] != 0 || futures.is_certain(actor)) continue;
    const Box box = swept_box_until(scene.actors[actor], futures.plans[p].motion,
                                    horizon_s + after_horizon_s, box_tests);
    // Crashes are simulated in the plane of the road, so heights do not matter.
    const bool apart = (box.min.head<2>().array() > near.max.head<2>().array()).any() ||
                       (box.max.head<2>().array() < near.min.head<2>().array()).any();
    reached[actor] = apart ? 0 : 1;
  }
  return futures.leave_out_unreached(reached);
}

void include_all_actors(Scene& scene, std::vector<char>& reached) {
  std::fill(reached.begin(), reached.end(), char{1});
  scene.futures.leave_out_unreached(reached);
}

}  // namespace crashrank::detail

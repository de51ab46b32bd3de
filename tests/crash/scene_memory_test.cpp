// First contacts of the outlines against the exact search over the meshes, and further contacts of
// a pair of bodies that has crushed before.

#include "campaign.hpp"
#include "crash/contact_checks.hpp"
#include "crash/scene_cases.hpp"
#include "crashrank/collide/collide.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/motion/time_of_impact.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using detail::SceneRun;
using test::ContactDraw;
using test::ContactScene;
using test::flat_pose;
using test::for_random_contacts;
using test::named;
using test::percentile;
using test::Random;
using test::SceneSetup;
using test::test_bodies;

/// Bounding-volume trees of the test bodies, in their order.
std::vector<AabbTree> body_trees() {
  std::vector<AabbTree> trees;
  for (const test::ShippedModel& m : test::movable_models) {
    trees.push_back(test::tree_of(test::shipped_mesh(m.name)));
  }
  for (const test::ShippedModel& m : test::fixed_models) {
    trees.push_back(test::tree_of(test::shipped_mesh(m.name)));
  }
  for (const double diameter : test::post_diameters_m) {
    trees.push_back(test::tree_of(test::prism_mesh(0.5 * diameter, 3.0, 16)));
  }
  return trees;
}

/// Time of the first force between two bodies on their plans; infinity if there is none.
double first_force_s(SceneRun& run, SceneSetup& setup, double until_s) {
  run.begin(setup.make_bodies(false), 0, 1, 0.0, Eigen::Vector3d::Zero(), {});
  bool going = true;
  while (going && run.now_s() < until_s) {
    const double before_s = run.now_s();
    going = run.advance(1);
    if (run.at_once() > 0 && run.live(0).acts()) return 0.5 * (before_s + run.now_s());
    // The contact ended in the step in which it began.
    if (!run.contacts().empty()) return run.contacts()[0].begin_s;
  }
  return std::numeric_limits<double>::infinity();
}

// Campaigns set CRASHRANK_SCENE_COUNT and CRASHRANK_SCENE_SEED.
TEST(SceneFirstContact, MatchesTheExactSearch) {
  const std::uint64_t seed = test::wished("CRASHRANK_SCENE_SEED", 451);
  const auto count = static_cast<int>(test::wished("CRASHRANK_SCENE_COUNT", 2000));
  const std::vector<AabbTree> trees = body_trees();
  SceneRun run;
  ImpactWorkspace workspace;
  DistanceWorkspace distances;
  std::vector<double> early_m;
  std::vector<double> early_gap_m;  ///< distance of the meshes at the first force
  std::vector<double> late_m;
  std::size_t both = 0;
  std::size_t neither = 0;
  std::size_t exact_alone = 0;
  std::size_t outlines_alone = 0;
  for_random_contacts(
      seed, count, [&](int, const ContactDraw& draw, std::size_t a, std::size_t b, double closing) {
        ContactScene scene;
        if (!test::make_scene(draw, a, b, closing, scene, 1.0)) return;
        SceneSetup setup;
        setup.add(scene.a);
        setup.add(scene.b);
        const double until_s = 4.0 / closing;
        const Impact exact = time_of_impact(trees[a], setup.plans[0], trees[b], setup.plans[1], 0.0,
                                            until_s, workspace);
        ASSERT_NE(exact.state, ImpactState::undecided);
        if (exact.state == ImpactState::overlapping || exact.state == ImpactState::contained) {
          return;
        }
        const double force_s = first_force_s(run, setup, until_s);
        const bool presses = std::isfinite(force_s);
        if (!exact.hit() || !presses) {
          neither += !exact.hit() && !presses ? 1U : 0U;
          exact_alone += exact.hit() && !presses ? 1U : 0U;
          outlines_alone += presses && !exact.hit() ? 1U : 0U;
          return;
        }
        ++both;
        // Relative travel between the two times.
        const double travel_m = (force_s - exact.time_s) * closing;
        if (travel_m < 0.0) {
          const Pose apart =
              relative(setup.plans[0].pose_at(force_s), setup.plans[1].pose_at(force_s));
          early_gap_m.push_back(distance(trees[a], trees[b], apart, distances).distance_m);
        }
        (travel_m < 0.0 ? early_m : late_m).push_back(std::abs(travel_m));
      });
  std::vector<double> all = early_m;
  all.insert(all.end(), late_m.begin(), late_m.end());
  std::printf(
      "contacts found by both: %zu, by neither: %zu, by the exact search only: %zu, by outlines "
      "only: %zu\n",
      both, neither, exact_alone, outlines_alone);
  for (const auto& [name, values] :
       {std::pair{"absolute difference", &all}, std::pair{"outlines earlier than meshes", &early_m},
        std::pair{"distance of meshes then", &early_gap_m},
        std::pair{"outlines later than meshes", &late_m}}) {
    std::printf("%s, m of travel: %zu, p50 %.3g, p90 %.3g, p95 %.3g, p99 %.3g, most %.3g\n", name,
                values->size(), percentile(*values, 0.5), percentile(*values, 0.9),
                percentile(*values, 0.95), percentile(*values, 0.99), percentile(*values, 1.0));
  }
  EXPECT_GT(both, static_cast<std::size_t>(count) / 2);
  // A force needs some depth, so it begins a step later, or not at all where only corners graze.
  // Outlines hold everything within a band, so it begins earlier where bodies share a band, but
  // surfaces that slope meet at other heights of it further on: while the meshes are still a few
  // centimetres apart, which are more of travel where one passes along the other.
  EXPECT_LT(static_cast<double>(early_m.size()), 0.2 * static_cast<double>(both));
  EXPECT_LT(percentile(early_m, 0.9), 0.1);
  EXPECT_LT(percentile(early_gap_m, 0.9), 0.06);
  EXPECT_LT(percentile(early_gap_m, 1.0), 0.12);
  EXPECT_LT(percentile(late_m, 0.5), 0.08);
  EXPECT_LT(percentile(late_m, 0.95), 0.3);
  EXPECT_EQ(outlines_alone, 0U);
  EXPECT_LT(static_cast<double>(exact_alone), 0.01 * static_cast<double>(both));
}

/// Advance of the rear body relative to the front body at the first force of each contact, and its
/// maximum, m.
struct PushRecord {
  std::vector<double> first_force_m;
  std::vector<double> max_advance_m;
  double turned_rad = 0.0;  ///< greatest heading difference of the bodies
};

/// A body drives into a body at rest; a lorry then pushes it into that body again.
PushRecord simulate_second_push(const char* rear, const char* front, double speed_mps,
                                double lorry_mps, double y_m) {
  const Vehicle& first = named(rear);
  const Vehicle& second = named(front);
  const Vehicle& lorry = named("truck");
  const double gap_m = 0.5;
  const double nose = static_cast<double>(first.silhouettes.max_x);
  const double tail = static_cast<double>(first.silhouettes.min_x);
  SceneSetup setup;
  const double half = -static_cast<double>(second.silhouettes.min_x);
  setup.add(first, flat_pose(-half - gap_m - nose, y_m, 0), speed_mps);
  setup.add(second, flat_pose(0, 0, 0), 0.0);
  // The lorry arrives a second or more after the first crash.
  const double behind_m = lorry_mps * (gap_m / speed_mps + 1.2) + 3.0;
  setup.add(lorry,
            flat_pose(-half - gap_m - nose + tail - behind_m -
                          static_cast<double>(lorry.silhouettes.max_x),
                      y_m, 0),
            lorry_mps);
  SceneRun run;
  // Rolling bodies keep the scene running until the lorry arrives.
  detail::SceneOptions options;
  options.after = AfterContact::releases;
  run.begin(setup.make_bodies(true), 0, 1, 0.0, Eigen::Vector3d::Zero(), options);
  PushRecord reach;
  bool pressed = false;
  double forceless_s = 1.0;
  bool going = true;
  while (going) {
    const double before_s = run.now_s();
    const detail::PlanarBody p = run.body(0);
    const detail::PlanarBody q = run.body(1);
    going = run.advance(1);
    bool presses = false;
    for (std::size_t k = 0; k < run.at_once(); ++k) {
      const detail::ContactRun& live = run.live(k);
      const std::size_t other = live.first() == 2 || live.second() == 2 ? 2U : 1U;
      presses = presses || (other == 1 && live.presses());
    }
    const double advance_m = run.body(0).x - run.body(1).x;
    reach.turned_rad = std::max(reach.turned_rad, std::abs(p.cosine * q.sine - p.sine * q.cosine));
    forceless_s += run.now_s() - before_s;
    if (!presses) continue;
    // Forces less than 0.3 s apart belong to one contact.
    if (!pressed || forceless_s > 0.3) {
      reach.first_force_m.push_back(0.5 * (p.x - q.x + advance_m));
      reach.max_advance_m.push_back(advance_m);
    }
    pressed = true;
    forceless_s = 0.0;
    reach.max_advance_m.back() = std::max(reach.max_advance_m.back(), advance_m);
  }
  return reach;
}

TEST(SceneMemory, FurtherContactPressesBeyondTheEarlierCrush) {
  constexpr std::uint64_t seed = 452;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  std::size_t all = 0;
  for (const char* front : {"wall", "sedan", "hatch", "truck"}) {
    std::vector<double> crush;
    std::vector<double> off;
    std::size_t turned = 0;
    for (int i = 0; i < 40; ++i) {
      const char* const rear = i % 2 == 0 ? "hatch" : "sedan";
      const double speed = random.uniform(4, 16);
      const double lorry = random.uniform(6, 20);
      const double y = random.uniform(-0.1, 0.1);
      const PushRecord reach = simulate_second_push(rear, front, speed, lorry, y);
      if (reach.first_force_m.size() < 2) continue;
      // Bodies that have turned press with other outline pieces.
      if (reach.turned_rad > 0.03) {
        ++turned;
        continue;
      }
      crush.push_back(reach.max_advance_m[0] - reach.first_force_m[0]);
      off.push_back(reach.first_force_m[1] - reach.max_advance_m[0]);
    }
    all += off.size();
    std::printf(
        "into %s: %zu pairs with a further contact, %zu others turned; first crush p50 %.3g m; the "
        "second force begins beyond the greatest first advance by p50 %.3g m, least %.3g, most "
        "%.3g\n",
        front, off.size(), turned, percentile(crush, 0.5), percentile(off, 0.5),
        percentile(off, 0.0), percentile(off, 1.0));
    // Outlines other than the wall have corners that a laterally shifted body contacts for the
    // first time.
    if (std::string(front) != "wall" || off.empty()) continue;
    EXPECT_GT(percentile(crush, 0.0), 0.1);
    EXPECT_GT(percentile(off, 0.0), -0.01);
    // Tolerance: two steps of travel and one until the measured pose.
    EXPECT_LT(percentile(off, 1.0), 0.18);
  }
  ASSERT_GT(all, 20U);
}

}  // namespace
}  // namespace crashrank

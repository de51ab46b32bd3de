#include "crash/scene_run.hpp"

#include "crash/contact_checks.hpp"
#include "crash/scene_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <vector>

namespace crashrank {
namespace {

using detail::SceneContact;
using detail::SceneRun;
using Eigen::Vector3d;
using test::flat_pose;
using test::named;
using test::Random;
using test::random_pile_up;
using test::run_to_end;
using test::SceneSetup;

// A second contact on the other side at the same time does not reduce the delta-v of a person or a
// car.
TEST(SceneOutcome, ContactFromTheOtherSideDoesNotReduceDeltaV) {
  for (const auto& [name, speed_mps] : {std::pair{"pedestrian", 14.0}, std::pair{"hatch", 25.0}}) {
    const Vehicle& struck = named(name);
    const Vehicle& saloon = named("sedan");
    const double half =
        0.5 * static_cast<double>(struck.silhouettes.max_y - struck.silhouettes.min_y);
    const double away = half + 0.3 + static_cast<double>(saloon.silhouettes.max_x);
    std::vector<double> delta_v;
    for (const bool both : {false, true}) {
      SceneSetup setup;
      setup.add(saloon, flat_pose(0, -away, 0.5 * detail::pi), speed_mps);
      setup.add(struck, flat_pose(0, 0, 0.0), 0.0);
      if (both) setup.add(saloon, flat_pose(0, away, -0.5 * detail::pi), speed_mps);
      SceneRun run;
      run.begin(setup.make_bodies(true), 0, 1, 0.0, Vector3d::Zero(), {});
      run_to_end(run);
      double greatest = 0.0;
      for (const SceneContact& contact : run.contacts()) {
        if (contact.a == 1) greatest = std::max(greatest, contact.outcome.a.delta_v_mps.norm());
        if (contact.b == 1) greatest = std::max(greatest, contact.outcome.b.delta_v_mps.norm());
      }
      delta_v.push_back(greatest);
    }
    std::printf("%s: delta-v %.3g m/s with one car, %.3g between two\n", name, delta_v[0],
                delta_v[1]);
    EXPECT_GT(delta_v[1], 0.8 * delta_v[0]) << name;
  }
}

/// Intrusion is counted in the contact that causes it: no contact has a large intrusion without the
/// energy for it.
TEST(SceneOutcome, NoContactIntrudesWithoutEnergy) {
  constexpr std::uint32_t seed = 405;
  // Below 10 kN intrusion is reduced in proportion to the force; up to two thirds of the force may
  // crush the other body.
  constexpr double least_force_n = 3e3;
  constexpr double scratch_m = 0.03;
  std::printf("seed %u\n", seed);
  Random random(seed);
  std::size_t intruding = 0;
  for (int round = 0; round < 100; ++round) {
    SceneSetup setup = random_pile_up(random, 6, true);
    SceneRun run;
    run.begin(setup.make_bodies(true), 0, 1, 0.0, Vector3d::Zero(), {});
    run_to_end(run);
    for (const SceneContact& contact : run.contacts()) {
      for (const BodyContact* side : {&contact.outcome.a, &contact.outcome.b}) {
        if (side->intrusion_m > 0.0) ++intruding;
        EXPECT_LE(side->intrusion_m, scratch_m + side->crush_energy_j / least_force_n)
            << "round " << round << ", " << contact.a << " " << contact.b << " at "
            << contact.begin_s;
      }
    }
  }
  std::printf("%zu bodies with intrusion\n", intruding);
  EXPECT_GT(intruding, 50U);
}

/// Two cars that overlap by less than the thickness of the structure beside their compartments have
/// no intrusion.
TEST(SceneOutcome, IntrusionIsBoundedByTheOverlap) {
  const Vehicle& saloon = named("sedan");
  const double half_m = 0.5 * static_cast<double>(saloon.silhouettes.width_m());
  for (const double aside_m : {1.6, 1.7}) {
    SceneSetup setup;
    setup.add(saloon, flat_pose(0, 0, 0.0), 17.0);
    setup.add(saloon, flat_pose(8, aside_m, detail::pi), 0.0);
    SceneRun run;
    run.begin(setup.make_bodies(true), 0, 1, 0.0, Vector3d::Zero(), {});
    run_to_end(run);
    ASSERT_GT(run.contacts().size(), 0U);
    const double reach_m =
        std::max(0.0, saloon.strength.core.cage_half_width_m + half_m - aside_m) + 0.05;
    EXPECT_LE(run.contacts()[0].outcome.a.intrusion_m, reach_m);
    EXPECT_LE(run.contacts()[0].outcome.b.intrusion_m, reach_m);
  }
}

}  // namespace
}  // namespace crashrank

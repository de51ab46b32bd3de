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

/// Velocities of all bodies after each step.
struct VelocityLog {
  std::vector<double> time_s;
  std::vector<std::vector<Vector3d>> velocity_mps;

  void add(const SceneRun& run, std::size_t bodies) {
    time_s.push_back(run.now_s());
    velocity_mps.emplace_back();
    for (std::size_t i = 0; i < bodies; ++i) {
      velocity_mps.back().emplace_back(run.body(i).vx, run.body(i).vy, 0.0);
    }
  }
  /// Greatest change of a body's velocity between two times, relative to the velocity before the
  /// first one, m/s.
  double greatest_change_mps(std::size_t body, double begin_s, double end_s) const {
    std::size_t k = 0;
    while (k + 1 < time_s.size() && time_s[k + 1] < begin_s) ++k;
    const Vector3d before = velocity_mps[k][body];
    double greatest = 0.0;
    for (; k < time_s.size(); ++k) {
      greatest = std::max(greatest, (velocity_mps[k][body] - before).norm());
      if (time_s[k] > end_s) break;
    }
    return greatest;
  }
};

/// Simulates a scene to its end and records the velocities.
VelocityLog simulate_with_log(SceneRun& run, View<const detail::SceneBody> bodies) {
  run.begin(bodies, 0, 1, 0.0, Vector3d::Zero(), {});
  VelocityLog log;
  log.add(run, bodies.size());
  while (run.advance(1)) log.add(run, bodies.size());
  log.add(run, bodies.size());
  return log;
}

/// Speed at which a body's kinetic energy equals its crush energy, m/s.
double crush_energy_speed_mps(const BodyContact& contact, double mass_kg) {
  return std::sqrt(2.0 * contact.crush_energy_j / mass_kg);
}

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

// The delta-v of a body squeezed between others exceeds neither its observed velocity change nor
// the speed equivalent to its crush energy.
TEST(SceneOutcome, DeltaVOfASqueezedBodyMatchesItsMotion) {
  // A lorry drives into a car at rest in front of a wall.
  const Vehicle& lorry = named("truck");
  const Vehicle& saloon = named("sedan");
  constexpr double speed_mps = 10.0;
  constexpr double gap_m = 0.02;
  SceneSetup setup;
  const auto front = [](const Vehicle& v) { return static_cast<double>(v.silhouettes.max_x); };
  setup.add(lorry, flat_pose(-front(lorry) + static_cast<double>(saloon.silhouettes.min_x), 0, 0),
            speed_mps);
  setup.add(saloon, flat_pose(0, 0, 0), 0.0);
  setup.add(named("wall"), flat_pose(front(saloon) + gap_m, 0, 0), 0.0);
  SceneRun run;
  const VelocityLog log = simulate_with_log(run, setup.make_bodies(false));
  double impulse = 0.0;
  for (const SceneContact& contact : run.contacts()) {
    const bool first = contact.a == 1;
    if (!first && contact.b != 1) continue;
    const BodyContact& car = first ? contact.outcome.a : contact.outcome.b;
    const double observed =
        log.greatest_change_mps(1, contact.begin_s, contact.begin_s + contact.outcome.duration_s);
    EXPECT_LE(car.delta_v_mps.norm(),
              std::max(observed, crush_energy_speed_mps(car, saloon.mass_kg)) + 1e-6);
    impulse = std::max(impulse, car.impulse_ns.norm() / saloon.mass_kg);
  }
  // The impulse is far larger than the change of the car's momentum.
  EXPECT_GT(impulse, 4.0 * speed_mps);
  EXPECT_LT(log.greatest_change_mps(1, 0.0, 30.0), 1.5 * speed_mps);
}

TEST(SceneOutcome, DeltaVInPileUpsIsBoundedByTheMotion) {
  constexpr std::uint32_t seed = 404;
  std::printf("seed %u\n", seed);
  Random random(seed);
  std::size_t loaded_by_others = 0;
  std::size_t contacts = 0;
  for (int round = 0; round < 60; ++round) {
    SceneSetup setup = random_pile_up(random, 6, true);
    SceneRun run;
    const VelocityLog log = simulate_with_log(run, setup.make_bodies(false));
    for (const SceneContact& contact : run.contacts()) {
      ++contacts;
      for (const bool first : {true, false}) {
        const std::size_t body = first ? contact.a : contact.b;
        if (run.body(body).inverse_mass == 0.0) continue;
        const BodyContact& side = first ? contact.outcome.a : contact.outcome.b;
        const double observed = log.greatest_change_mps(
            body, contact.begin_s, contact.begin_s + contact.outcome.duration_s);
        const double crush = crush_energy_speed_mps(side, 1.0 / run.body(body).inverse_mass);
        EXPECT_LE(side.delta_v_mps.norm(), std::max(observed, crush) + 1e-6) << "round " << round;
        if (side.impulse_ns.norm() * run.body(body).inverse_mass > observed + 1e-6)
          ++loaded_by_others;
      }
    }
  }
  std::printf("%zu contacts, %zu bodies loaded by other contacts at the same time\n", contacts,
              loaded_by_others);
  EXPECT_GT(loaded_by_others, 5U);
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

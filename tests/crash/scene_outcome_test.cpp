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
using test::pile;
using test::Random;
using test::run_to_end;
using test::Stage;

/// Velocities of all bodies after each step.
struct Log {
  std::vector<double> time_s;
  std::vector<std::vector<Vector3d>> velocity_mps;

  void add(const SceneRun& run, std::size_t bodies) {
    time_s.push_back(run.now_s());
    velocity_mps.emplace_back();
    for (std::size_t i = 0; i < bodies; ++i) {
      velocity_mps.back().emplace_back(run.body(i).vx, run.body(i).vy, 0.0);
    }
  }
  /// The greatest change of a body's velocity from what it is before a time to what it is until
  /// another, m/s.
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

/// Simulates a scene to its end.
Log logged(SceneRun& run, View<const detail::SceneBody> bodies) {
  run.begin(bodies, 0, 1, 0.0, Vector3d::Zero(), {});
  Log log;
  log.add(run, bodies.size());
  while (run.advance(1)) log.add(run, bodies.size());
  log.add(run, bodies.size());
  return log;
}

/// At which a body's crush energy would be its kinetic energy, m/s.
double crush_speed_mps(const BodyContact& contact, double mass_kg) {
  return std::sqrt(2.0 * contact.crush_energy_j / mass_kg);
}

// What presses on the other side at the same time takes nothing off what a person or a car suffers.
TEST(SceneOutcome, BeingPressedFromBothSidesHealsNobody) {
  for (const auto& [name, speed_mps] : {std::pair{"pedestrian", 14.0}, std::pair{"hatch", 25.0}}) {
    const Vehicle& struck = named(name);
    const Vehicle& saloon = named("sedan");
    const double half =
        0.5 * static_cast<double>(struck.silhouettes.max_y - struck.silhouettes.min_y);
    const double away = half + 0.3 + static_cast<double>(saloon.silhouettes.max_x);
    std::vector<double> delta_v;
    for (const bool both : {false, true}) {
      Stage stage;
      stage.add(saloon, flat_pose(0, -away, 0.5 * detail::pi), speed_mps);
      stage.add(struck, flat_pose(0, 0, 0.0), 0.0);
      if (both) stage.add(saloon, flat_pose(0, away, -0.5 * detail::pi), speed_mps);
      SceneRun run;
      run.begin(stage.ready(true), 0, 1, 0.0, Vector3d::Zero(), {});
      run_to_end(run);
      double greatest = 0.0;
      for (const SceneContact& contact : run.contacts()) {
        if (contact.a == 1) greatest = std::max(greatest, contact.outcome.a.delta_v_mps.norm());
        if (contact.b == 1) greatest = std::max(greatest, contact.outcome.b.delta_v_mps.norm());
      }
      delta_v.push_back(greatest);
    }
    std::printf("%s: delta-v %.3g m/s by one saloon, %.3g between two\n", name, delta_v[0],
                delta_v[1]);
    EXPECT_GT(delta_v[1], 0.8 * delta_v[0]) << name;
  }
}

// No contact of a body that others hold counts for more than its motion shows or its crush is
// worth.
TEST(SceneOutcome, ASqueezedBodyUndergoesItsOwnMotion) {
  // A lorry drives into a saloon that stands before a wall.
  const Vehicle& lorry = named("truck");
  const Vehicle& saloon = named("sedan");
  constexpr double speed_mps = 10.0;
  constexpr double gap_m = 0.02;
  Stage stage;
  const auto front = [](const Vehicle& v) { return static_cast<double>(v.silhouettes.max_x); };
  stage.add(lorry, flat_pose(-front(lorry) + static_cast<double>(saloon.silhouettes.min_x), 0, 0),
            speed_mps);
  stage.add(saloon, flat_pose(0, 0, 0), 0.0);
  stage.add(named("wall"), flat_pose(front(saloon) + gap_m, 0, 0), 0.0);
  SceneRun run;
  const Log log = logged(run, stage.ready(false));
  double impulse = 0.0;
  for (const SceneContact& contact : run.contacts()) {
    const bool first = contact.a == 1;
    if (!first && contact.b != 1) continue;
    const BodyContact& car = first ? contact.outcome.a : contact.outcome.b;
    const double seen =
        log.greatest_change_mps(1, contact.begin_s, contact.begin_s + contact.outcome.duration_s);
    EXPECT_LE(car.delta_v_mps.norm(), std::max(seen, crush_speed_mps(car, saloon.mass_kg)) + 1e-6);
    impulse = std::max(impulse, car.impulse_ns.norm() / saloon.mass_kg);
  }
  // The force's impulse is far larger than what the car's velocity changes by.
  EXPECT_GT(impulse, 4.0 * speed_mps);
  EXPECT_LT(log.greatest_change_mps(1, 0.0, 30.0), 1.5 * speed_mps);
}

TEST(SceneOutcome, ContactsInPilesChangeNoVelocityMoreThanIsSeen) {
  constexpr std::uint32_t seed = 404;
  std::printf("seed %u\n", seed);
  Random random(seed);
  std::size_t squeezed = 0;
  std::size_t contacts = 0;
  for (int round = 0; round < 60; ++round) {
    Stage stage = pile(random, 6, true);
    SceneRun run;
    const Log log = logged(run, stage.ready(false));
    for (const SceneContact& contact : run.contacts()) {
      ++contacts;
      for (const bool first : {true, false}) {
        const std::size_t body = first ? contact.a : contact.b;
        if (run.body(body).inverse_mass == 0.0) continue;
        const BodyContact& side = first ? contact.outcome.a : contact.outcome.b;
        const double seen = log.greatest_change_mps(body, contact.begin_s,
                                                    contact.begin_s + contact.outcome.duration_s);
        const double crush = crush_speed_mps(side, 1.0 / run.body(body).inverse_mass);
        EXPECT_LE(side.delta_v_mps.norm(), std::max(seen, crush) + 1e-6) << "round " << round;
        if (side.impulse_ns.norm() * run.body(body).inverse_mass > seen + 1e-6) ++squeezed;
      }
    }
  }
  std::printf("%zu contacts, %zu sides held by others\n", contacts, squeezed);
  EXPECT_GT(squeezed, 5U);
}

/// What two bodies crushed counts in the contact that crushed it: none reaches far into a
/// compartment without the energy for it.
TEST(SceneOutcome, NoContactIntrudesWithoutEnergy) {
  constexpr std::uint32_t seed = 405;
  // A force under 10 kN counts in proportion to it; two thirds for what the other body takes.
  constexpr double least_force_n = 3e3;
  constexpr double scratch_m = 0.03;
  std::printf("seed %u\n", seed);
  Random random(seed);
  std::size_t intruding = 0;
  for (int round = 0; round < 100; ++round) {
    Stage stage = pile(random, 6, true);
    SceneRun run;
    run.begin(stage.ready(true), 0, 1, 0.0, Vector3d::Zero(), {});
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
  std::printf("%zu intrude\n", intruding);
  EXPECT_GT(intruding, 50U);
}

/// Two cars that meet with less overlap than their compartments' walls are thick intrude nowhere.
TEST(SceneOutcome, AShallowOverlapIntrudesNoDeeperThanItIs) {
  const Vehicle& saloon = named("sedan");
  const double half_m = 0.5 * static_cast<double>(saloon.silhouettes.width_m());
  for (const double aside_m : {1.6, 1.7}) {
    Stage stage;
    stage.add(saloon, flat_pose(0, 0, 0.0), 17.0);
    stage.add(saloon, flat_pose(8, aside_m, detail::pi), 0.0);
    SceneRun run;
    run.begin(stage.ready(true), 0, 1, 0.0, Vector3d::Zero(), {});
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

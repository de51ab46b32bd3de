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
using test::ContactDraw;
using test::ContactScene;
using test::flat_pose;
using test::for_random_contacts;
using test::named;
using test::percentile;
using test::Random;
using test::random_pile_up;
using test::run_to_end;
using test::SceneSetup;
using test::test_bodies;

TEST(SceneRun, TwoBodiesWithoutRoadAreOneContact) {
  std::vector<double> changes;
  SceneRun run;
  ContactWorkspace workspace;
  for_random_contacts(
      401, 900, [&](int, const ContactDraw& draw, std::size_t a, std::size_t b, double closing) {
        ContactScene scene;
        // No yaw rate: the plan keeps the origin's velocity constant, a free body that of the
        // centre of mass.
        if (!test::make_contact(draw, test_bodies().movable[a].vehicle,
                                test_bodies().any(b).vehicle, closing, 0.001, scene)) {
          return;
        }
        const ContactOutcome alone =
            simulate_contact(scene.a, scene.b, {}, scene.point_m, {}, workspace);
        SceneSetup setup;
        setup.add(scene.a);
        setup.add(scene.b);
        run.begin(setup.make_bodies(false), 0, 1, 0.0, scene.point_m, {});
        run_to_end(run);
        ASSERT_EQ(run.contacts().size() > 0, alone.acts);
        if (!alone.acts) return;
        const SceneContact& first = run.contacts()[0];
        EXPECT_EQ(first.a, 0U);
        EXPECT_EQ(first.b, 1U);
        // In a scene, contacts that follow within 0.1 s (a second impact of the tail, scraping) are
        // merged into it.
        if (first.outcome.steps != alone.steps) return;
        EXPECT_NEAR((first.outcome.a.impulse_ns - alone.a.impulse_ns).norm(), 0.0,
                    1e-3 * closing * scene.a.vehicle->mass_kg);
        changes.push_back(test::change(first.outcome, alone, closing));
        EXPECT_NEAR(first.outcome.duration_s, alone.duration_s, 1e-3);
      });
  test::print_changes("scene against contact alone", changes);
  ASSERT_GT(changes.size(), 200U);
  // Centres of mass have other rounding errors, which may change the rounding of a piece in single
  // precision.
  EXPECT_LT(percentile(changes, 0.99), 1e-12);
  EXPECT_LT(percentile(changes, 1.0), 1e-3);
}

TEST(SceneRun, BodiesPressAgainWhereTheyWereCrushed) {
  // A lorry pushes a car against a wall, from which it comes back.
  const Vehicle& lorry = named("truck");
  const Vehicle& car = named("hatch");
  for (const double gap_m : {2.0, 3.0, 4.0}) {
    for (const double speed_mps : {8.0, 9.0, 10.0, 12.0}) {
      SceneSetup setup;
      const double car_m = lorry.silhouettes.max_x - car.silhouettes.min_x + 0.1;
      const double wall_m = car_m + car.silhouettes.max_x - named("wall").silhouettes.min_x;
      setup.add(lorry, flat_pose(0, 0, 0), speed_mps);
      setup.add(car, flat_pose(car_m, -0.24, 0), 0.0);
      setup.add(named("wall"), flat_pose(wall_m + gap_m, 0, 0), 0.0);
      SceneRun run;
      run.begin(setup.make_bodies(false), 0, 1, 0.0, Vector3d::Zero(), {});
      double least_m = 1e9;
      double least_closing_mps = 1e9;
      double returning_mps = 0.0;
      bool returned = false;
      while (run.advance(1)) {
        const double apart_m = run.body(1).x - run.body(0).x;
        const double closing_mps = run.body(0).vx - run.body(1).vx;
        const bool parted = run.contacts().size() > 0;
        if (!parted) least_m = std::min(least_m, apart_m);
        if (parted && !returned && closing_mps > 1.0 && apart_m < least_m) {
          returned = true;
          returning_mps = closing_mps;
        }
        if (returned && apart_m > least_m - 0.15) {
          least_closing_mps = std::min(least_closing_mps, closing_mps);
        }
      }
      ASSERT_TRUE(returned) << gap_m << " m, " << speed_mps << " m/s";
      EXPECT_LT(least_closing_mps, 0.8 * returning_mps) << gap_m << " m, " << speed_mps << " m/s";
    }
  }
}

struct Totals {
  Vector3d momentum = Vector3d::Zero();
  double moment = 0.0;
  double energy = 0.0;
  double scale = 0.0;
  double moment_scale = 0.0;
};

Totals totals_of(const SceneRun& run, std::size_t count) {
  Totals sum;
  for (std::size_t i = 0; i < count; ++i) {
    const detail::PlanarBody& b = run.body(i);
    if (b.inverse_mass == 0.0) continue;
    const double mass = 1.0 / b.inverse_mass;
    sum.momentum += mass * Vector3d(b.vx, b.vy, 0);
    sum.moment += mass * (b.x * b.vy - b.y * b.vx) + b.spin / b.inverse_inertia;
    sum.energy += b.energy();
    sum.scale += mass * std::hypot(b.vx, b.vy);
    sum.moment_scale +=
        mass * std::hypot(b.x, b.y) * std::hypot(b.vx, b.vy) + std::abs(b.spin) / b.inverse_inertia;
  }
  return sum;
}

/// Distance by which the point at which a force begins lies outside the circle around a body, as
/// the body is then.
double outside_m(const SceneContact& contact, const ContactBody& body) {
  const Silhouettes& s = body.vehicle->silhouettes;
  const double x = std::max(std::abs(static_cast<double>(s.min_x)), static_cast<double>(s.max_x));
  const double y = std::max(std::abs(static_cast<double>(s.min_y)), static_cast<double>(s.max_y));
  const Vector3d away = contact.outcome.begin_point_m - body.pose.translation;
  return away.head<2>().norm() - std::hypot(x, y);
}

TEST(SceneRun, PilesOnIceConserveMomentumAndNeverGainEnergy) {
  constexpr std::uint64_t seed = 402;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  SceneRun run;
  double momentum = 0.0;
  double moment = 0.0;
  double gained = 0.0;
  double outside = 0.0;
  std::size_t contacts = 0;
  std::size_t bodies = 0;
  for (int i = 0; i < 60; ++i) {
    SceneSetup setup = random_pile_up(random, 3 + random.below(8), false);
    const std::size_t count = setup.plans.size();
    run.begin(setup.make_bodies(false), 0, 1, 0.0, Vector3d::Zero(), {});
    const Totals before = totals_of(run, count);
    // A rebound restores only part of the energy lost before it.
    bool going = true;
    while (going) {
      going = run.advance(1);
      gained = std::max(gained, (totals_of(run, count).energy - before.energy) / before.energy);
    }
    // A planned body moves straight on, so its angular momentum does not depend on when it was last
    // placed.
    const Totals after = totals_of(run, count);
    momentum = std::max(momentum, (after.momentum - before.momentum).norm() / before.scale);
    contacts += run.contacts().size();
    for (const SceneContact& contact : run.contacts()) {
      outside = std::max(
          {outside, outside_m(contact, contact.given_a), outside_m(contact, contact.given_b)});
    }
    for (std::size_t k = 0; k < count; ++k) bodies += run.touched(k) ? 1U : 0U;
    moment = std::max(moment, std::abs(after.moment - before.moment) / before.moment_scale);
  }
  std::printf(
      "%zu contacts, %zu bodies in contact; error of momentum %.3g, of angular momentum %.3g, "
      "energy gain "
      "%.3g\n",
      contacts, bodies, momentum, moment, gained);
  EXPECT_GT(contacts, 100U);
  EXPECT_LT(momentum, 1e-12);
  EXPECT_LT(moment, 1e-11);
  EXPECT_LT(gained, 1e-12);
  // Bodies move by up to a step between what is given and the middle of the step.
  EXPECT_LT(outside, 0.1);
}

TEST(SceneRun, ACarIsPushedIntoThePersonBehindIt) {
  const Vehicle& hatch = named("hatch");
  const Vehicle& sedan = named("sedan");
  const Vehicle& person = named("pedestrian");
  SceneSetup setup;
  setup.add(hatch, flat_pose(-10, 0, 0), 20.0);
  setup.add(sedan, flat_pose(0, 0, 0), 0.0);
  setup.add(person, flat_pose(8, 0, 0), 0.0);
  SceneRun run;
  run.begin(setup.make_bodies(true), 0, 1, 0.0, Vector3d::Zero(), {});
  run_to_end(run);
  bool struck = false;
  bool pushed = false;
  for (const SceneContact& c : run.contacts()) {
    std::printf("%u and %u at %.3f s: delta-v %.2f and %.2f m/s\n", c.a, c.b, c.begin_s,
                c.outcome.a.delta_v_mps.norm(), c.outcome.b.delta_v_mps.norm());
    struck = struck || (c.a == 0 && c.b == 1);
    pushed = pushed || (struck && c.a == 1 && c.b == 2);
  }
  EXPECT_TRUE(struck);
  EXPECT_TRUE(pushed);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(std::hypot(run.body(i).vx, run.body(i).vy), 0.05);
}

TEST(SceneRun, OnlyTheChainOfTheFirstBodyActs) {
  const Vehicle& hatch = named("hatch");
  SceneSetup setup;
  // Two other bodies drive into each other; the first body is elsewhere.
  setup.add(hatch, flat_pose(0, 50, 0), 10.0);
  setup.add(hatch, flat_pose(-10, 0, 0), 10.0);
  setup.add(hatch, flat_pose(10, 0, detail::pi), 10.0);
  SceneRun run;
  run.begin(setup.make_bodies(true), 0, 1, 0.0, Vector3d::Zero(), {});
  run_to_end(run);
  EXPECT_EQ(run.contacts().size(), 0U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_FALSE(run.touched(i));
}

/// A body on its plan contacts a body of the chain that has come to rest.
TEST(SceneRun, PlannedBodiesHitRestingBodies) {
  // A motorcycle grazes a lorry at rest and slides on; a car approaches from behind.
  constexpr double speed_mps = 20.0;
  const Vehicle& lorry = named("truck");
  const Vehicle& saloon = named("sedan");
  constexpr double away_m = 60.0;
  SceneSetup setup;
  setup.add(named("motorcycle"), flat_pose(-8, 1.45, 0.0), 25.0);
  setup.add(lorry, flat_pose(0, 0, 0.0), 0.0);
  setup.add(saloon, flat_pose(-away_m, 0, 0.0), speed_mps);
  SceneRun run;
  run.begin(setup.make_bodies(true), 0, 1, 0.0, Vector3d::Zero(), {});
  bool rested = false;
  while (run.advance(1)) {
    const detail::PlanarBody& b = run.body(1);
    rested = rested || (run.touched(1) && !run.touched(2) && b.vx == 0.0 && b.vy == 0.0);
  }
  ASSERT_TRUE(rested);
  const SceneContact* hit = nullptr;
  for (const SceneContact& contact : run.contacts()) {
    if (hit == nullptr && contact.a == 1 && contact.b == 2) hit = &contact;
  }
  ASSERT_NE(hit, nullptr);
  // The contact equals that with an untouched lorry, except for a step of 0.06 m and the
  // displacement of the lorry.
  SceneSetup alone;
  alone.add(saloon, flat_pose(-away_m, 0, 0.0), speed_mps);
  alone.add(lorry, flat_pose(0, 0, 0.0), 0.0);
  SceneRun control;
  control.begin(alone.make_bodies(true), 0, 1, 0.0, Vector3d::Zero(), {});
  run_to_end(control);
  ASSERT_GT(control.contacts().size(), 0U);
  EXPECT_NEAR(hit->begin_s, control.contacts()[0].begin_s, 0.08 / speed_mps);
  EXPECT_NEAR(hit->given_b.velocity.linear_mps.x(), speed_mps, 1e-9);
}

TEST(SceneRun, MirroredScenesGiveMirroredResults) {
  constexpr std::uint64_t seed = 403;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  SceneRun run;
  std::vector<double> off;
  for (int i = 0; i < 40; ++i) {
    const double y = random.uniform(-1.5, 1.5);
    const double yaw = random.uniform(-0.5, 0.5);
    const double speed = random.uniform(5, 30);
    std::vector<Vector3d> ends;
    for (const double side : {1.0, -1.0}) {
      const test::BodySet& cast = side > 0 ? test_bodies() : test::mirrored_bodies();
      SceneSetup setup;
      setup.add(cast.movable[1].vehicle, flat_pose(-7, side * y, side * yaw), speed);
      setup.add(cast.movable[0].vehicle, flat_pose(0, 0, side * 2.0), 8.0);
      setup.add(cast.movable[1].vehicle, flat_pose(6, side * 2.0, side * 0.7), 0.0);
      run.begin(setup.make_bodies(true), 0, 1, 0.0, Vector3d::Zero(), {});
      run_to_end(run);
      for (std::size_t k = 0; k < 3; ++k) ends.emplace_back(run.body(k).x, side * run.body(k).y, 0);
    }
    for (std::size_t k = 0; k < 3; ++k) off.push_back((ends[k] - ends[k + 3]).norm());
  }
  std::printf(
      "differences of rest positions of mirrored scenes, m: p50 %.3g, p90 %.3g, most %.3g\n",
      percentile(off, 0.5), percentile(off, 0.9), percentile(off, 1.0));
  EXPECT_LT(percentile(off, 0.9), 1e-4);
}
}  // namespace
}  // namespace crashrank

// Degenerate scenes end within the step limit, and all their results are finite.

#include "crash/scene_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace crashrank {
namespace {

using detail::SceneContact;
using detail::SceneOptions;
using detail::SceneRun;
using test::flat_pose;
using test::named;
using test::Random;
using test::SceneSetup;
using test::test_bodies;

bool is_number(const BodyContact& c) {
  return c.impulse_ns.allFinite() && c.delta_v_mps.allFinite() &&
         std::isfinite(c.delta_yaw_rate_radps) && c.after.linear_mps.allFinite() &&
         c.after.angular_radps.allFinite() && std::isfinite(c.pdof_deg) &&
         std::isfinite(c.crush_depth_m) && std::isfinite(c.crush_energy_j) &&
         std::isfinite(c.intrusion_m) && c.crush_energy_j >= 0.0;
}

/// Runs a scene to its end and checks its results. No scene takes more steps than its maximum
/// duration divided by the shortest step. Returns the number of steps.
std::uint64_t run_checked(SceneRun& run, const SceneSetup& setup, const SceneOptions& options) {
  const double least_step_s = 0.25 * options.contact.shortest_s;
  const auto most_steps = static_cast<std::uint64_t>(options.longest_s / least_step_s) + 2;
  while (run.advance(1)) {
    if (run.steps() > most_steps) {
      ADD_FAILURE() << "the scene does not end";
      break;
    }
  }
  EXPECT_LE(run.now_s(), options.longest_s + options.rolling_step_s);
  EXPECT_EQ(run.at_once(), 0U);
  for (std::size_t i = 0; i < setup.plans.size(); ++i) {
    const detail::PlanarBody& b = run.body(i);
    EXPECT_TRUE(std::isfinite(b.x) && std::isfinite(b.y) && std::isfinite(b.vx) &&
                std::isfinite(b.vy) && std::isfinite(b.spin) && std::isfinite(b.turned))
        << "body " << i;
    EXPECT_NEAR(std::hypot(b.cosine, b.sine), 1.0, 1e-9) << "body " << i;
  }
  for (const SceneContact& c : run.contacts()) {
    EXPECT_TRUE(is_number(c.outcome.a) && is_number(c.outcome.b)) << c.a << " and " << c.b;
    EXPECT_TRUE(std::isfinite(c.outcome.dissipated_j) && c.outcome.dissipated_j >= 0.0);
    EXPECT_TRUE(c.outcome.point_m.allFinite());
    EXPECT_LT(c.a, setup.plans.size());
    EXPECT_LT(c.b, setup.plans.size());
    EXPECT_NE(c.a, c.b);
  }
  return run.steps();
}

void print_end(const char* name, const SceneRun& run, std::size_t bodies) {
  std::size_t touched = 0;
  for (std::size_t i = 0; i < bodies; ++i) touched += run.touched(i) ? 1U : 0U;
  std::printf("%s: %llu steps, %.2f s, %zu contacts, %zu of %zu bodies in contact, %s\n", name,
              static_cast<unsigned long long>(run.steps()), run.now_s(), run.contacts().size(),
              touched, bodies, run.crowded() ? "limits exceeded" : "within limits");
}

/// Expects a scene of a thousand bodies to end in far fewer steps than the limit.
void expect_pile_ends(const char* name, SceneSetup& setup, std::size_t partner) {
  ASSERT_EQ(setup.plans.size(), 1000U);
  const SceneOptions options;
  SceneRun run;
  run.begin(setup.make_bodies(true), 0, partner, 0.0, Eigen::Vector3d::Zero(), options);
  EXPECT_LT(run_checked(run, setup, options), 40'000U);
  print_end(name, run, setup.plans.size());
  EXPECT_TRUE(run.crowded());
}

TEST(SceneFault, AThousandCarsNoseToTailEndInTime) {
  SceneSetup setup;
  setup.add(named("truck"), flat_pose(-12, 0, 0), 30.0);
  for (int row = 0; row < 27; ++row) {
    for (int column = 0; column < 37; ++column) {
      setup.add(named("hatch"), flat_pose(4.4 * column, 2.0 * (row - 13), 0), 0.0);
    }
  }
  expect_pile_ends("1,000 in rows", setup, 1 + 13 * 37);
}

TEST(SceneFault, AThousandBodiesInOnePlaceEndInTime) {
  constexpr std::uint64_t seed = 441;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  for (const double around_m : {0.0, 20.0}) {
    SceneSetup setup;
    const auto all = static_cast<std::uint32_t>(test_bodies().size());
    for (int i = 0; i < 1000; ++i) {
      const Vehicle& v = i < 2 ? named("hatch") : test_bodies().any(random.below(all)).vehicle;
      const double x = random.uniform(-around_m, around_m);
      const double y = random.uniform(-around_m, around_m);
      setup.add(v, flat_pose(x, y, random.uniform(-3, 3)),
                v.movable() ? random.uniform(-20, 20) : 0.0);
    }
    expect_pile_ends("1,000 in one place", setup, 1);
  }
}

TEST(SceneFault, BodiesThatOverlapAtTheStartStayDefined) {
  constexpr std::uint64_t seed = 442;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  SceneRun run;
  std::uint64_t most = 0;
  std::size_t contacts = 0;
  for (int i = 0; i < 150; ++i) {
    SCOPED_TRACE("scene " + std::to_string(i));
    SceneSetup setup;
    const auto movable = static_cast<std::uint32_t>(test_bodies().movable.size());
    const auto all = static_cast<std::uint32_t>(test_bodies().size());
    const std::size_t count = 2 + random.below(5);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t what = k == 0 ? random.below(movable) : random.below(all);
      const Vehicle& v = test_bodies().any(what).vehicle;
      const double x = random.uniform(-2, 2);
      const double y = random.uniform(-2, 2);
      const double yaw = random.uniform(-3, 3);
      setup.add(v, flat_pose(x, y, yaw), v.movable() ? random.uniform(-30, 30) : 0.0);
    }
    SceneOptions options;
    // No grip, and the least grip that a scenario may state.
    if (i % 3 > 0) options.grip = i % 3 == 1 ? 0.0 : 0.01;
    run.begin(setup.make_bodies(i % 2 == 0), 0, 1, 0.0, Eigen::Vector3d::Zero(), options);
    most = std::max(most, run_checked(run, setup, options));
    contacts += run.contacts().size();
  }
  std::printf("at most %llu steps, %zu contacts\n", static_cast<unsigned long long>(most),
              contacts);
}

TEST(SceneFault, CoincidentBodiesAreDefined) {
  for (const char* name : {"hatch", "truck", "pedestrian", "motorcycle"}) {
    for (const double speed : {0.0, 20.0}) {
      SceneSetup setup;
      setup.add(named(name), flat_pose(0, 0, 0), speed);
      setup.add(named(name), flat_pose(0, 0, 0), 0.0);
      const SceneOptions options;
      SceneRun run;
      run.begin(setup.make_bodies(true), 0, 1, 0.0, Eigen::Vector3d::Zero(), options);
      EXPECT_LT(run_checked(run, setup, options), 40'000U) << name;
    }
  }
}

TEST(SceneFault, FixedBodiesAreNotSimulated) {
  SceneSetup setup;
  setup.add(named("wall"), flat_pose(0, 0, 0), 0.0);
  setup.add(named("pole"), flat_pose(0, 0, 0), 0.0);
  setup.add(named("jersey_barrier"), flat_pose(0.1, 0, 0), 0.0);
  const SceneOptions options;
  SceneRun run;
  run.begin(setup.make_bodies(true), 0, 1, 0.0, Eigen::Vector3d::Zero(), options);
  EXPECT_LE(run_checked(run, setup, options), 1U);
  EXPECT_EQ(run.contacts().size(), 0U);
  // A scene of one body.
  SceneSetup one;
  one.add(named("hatch"), flat_pose(0, 0, 0), 10.0);
  run.begin(one.make_bodies(true), 0, 0, 0.0, Eigen::Vector3d::Zero(), options);
  EXPECT_EQ(run_checked(run, one, options), 0U);
}

TEST(SceneFault, BodiesThatNeverMeetEndWithoutContact) {
  SceneSetup setup;
  setup.add(named("hatch"), flat_pose(0, 0, 0), 20.0);
  setup.add(named("hatch"), flat_pose(0, 30, 0), 0.0);
  const SceneOptions options;
  SceneRun run;
  run.begin(setup.make_bodies(true), 0, 1, 0.0, Eigen::Vector3d::Zero(), options);
  EXPECT_LT(run_checked(run, setup, options), 1000U);
  EXPECT_EQ(run.contacts().size(), 0U);
}

TEST(SceneFault, WithoutGripNothingButContactsSlowsABody) {
  SceneSetup setup;
  setup.add(named("hatch"), flat_pose(-8, 0, 0), 15.0);
  setup.add(named("sedan"), flat_pose(0, 0, 0), 0.0);
  SceneOptions options;
  options.grip = 0.0;
  SceneRun run;
  run.begin(setup.make_bodies(true, 1.0), 0, 1, 0.0, Eigen::Vector3d::Zero(), options);
  run_checked(run, setup, options);
  double momentum = 0.0;
  for (std::size_t i = 0; i < 2; ++i) momentum += run.body(i).vx / run.body(i).inverse_mass;
  const double before = 15.0 / run.body(0).inverse_mass;
  EXPECT_NEAR(momentum, before, 1e-9 * before);
}

}  // namespace
}  // namespace crashrank

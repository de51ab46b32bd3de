#include "crash/tyres.hpp"

#include "crash/tyres_cases.hpp"
#include "crashrank/interop/frames.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace crashrank {
namespace {

using detail::Footing;
using detail::PlanarBody;
using detail::Wheels;
using test::at_rest;
using test::gravity_mps2;
using test::move_on_road;
using test::Random;
using test::random_body;
using test::random_footing;
using test::random_wheels;
using test::ReferenceCar;
using test::Saloon;
using test::step_on_road;

/// Prints the seed and returns its random generator.
Random seeded(std::uint64_t seed) {
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  return Random(seed);
}

TEST(Tyres, StoppingDistanceOfALockedCarFollowsTheSquareOfItsSpeed) {
  const Saloon car;
  const Wheels locked = detail::wheels_after(car.footing, AfterContact::locks, 0.2, 0.0);
  constexpr double grip = 0.7;
  for (const double speed : {5.0, 10.0, 20.0, 40.0, 60.0}) {
    for (const double step_s : {0.001, 0.005, 0.020}) {
      for (const double heading : {0.0, 0.4, 1.6}) {
        PlanarBody b = car.body(speed, heading, 0.3, 0.0);
        move_on_road(car.footing, locked, grip, step_s, speed / (grip * gravity_mps2) + 0.2, b);
        const double expected = speed * speed / (2.0 * grip * gravity_mps2);
        EXPECT_TRUE(at_rest(b)) << speed << " m/s, " << step_s << " s";
        EXPECT_NEAR(std::cos(0.3) * b.x + std::sin(0.3) * b.y, expected, 0.005 * expected)
            << speed << " m/s, " << step_s << " s";
        EXPECT_NEAR(std::cos(0.3) * b.y - std::sin(0.3) * b.x, 0.0, 0.001 * expected);
      }
    }
  }
}

TEST(Tyres, SpinningDiscOnPatchesStopsAfterTheClosedFormTime) {
  constexpr double grip = 0.6;
  constexpr double radius_m = 0.8;
  constexpr double gyration_m = 0.6;
  Footing f;
  f.front_m = radius_m * std::sqrt(0.5);
  f.rear_m = -f.front_m;
  f.y_m << f.front_m, f.rear_m;
  const Wheels locked = detail::wheels_after(f, AfterContact::releases, 0.0, 0.0);
  // The torque m·g·grip·r does not depend on the yaw rate.
  const double slowing = grip * gravity_mps2 * radius_m / (gyration_m * gyration_m);
  for (const double spin : {2.0, 10.0, -25.0}) {
    for (const double step_s : {0.001, 0.005, 0.020}) {
      PlanarBody b;
      b.inverse_mass = 1.0 / 300.0;
      b.inverse_inertia = b.inverse_mass / (gyration_m * gyration_m);
      b.spin = spin;
      const double stops_s = std::abs(spin) / slowing;
      double time_s = 0.0;
      while (!at_rest(b) && time_s < 2.0 * stops_s + 0.2) {
        step_on_road(f, locked, grip, step_s, b);
        time_s += step_s;
        // A step that removes the share 1/k of the yaw rate has an error of 1/(6k³) of it: 0.3
        // steps in total, most of it in the last ones.
        if (time_s < stops_s - 2.0 * step_s) {
          EXPECT_NEAR(std::abs(b.spin), std::abs(spin) - slowing * time_s, 0.3 * slowing * step_s);
        }
      }
      EXPECT_TRUE(at_rest(b));
      // The last hundredths of the yaw rate decay over a few steps.
      EXPECT_NEAR(time_s, stops_s, 0.005 * stops_s + 5.0 * step_s) << spin << ", " << step_s;
      EXPECT_NEAR(std::abs(b.turned), spin * spin / (2.0 * slowing),
                  0.002 * spin * spin / (2.0 * slowing) + slowing * step_s * step_s);
      EXPECT_EQ(b.x, 0.0);
      EXPECT_EQ(b.y, 0.0);
    }
  }
}

TEST(Tyres, ReleasedCarRollsOnAlongItsHeading) {
  const Saloon car;
  const Wheels released = detail::wheels_after(car.footing, AfterContact::releases, 0.0, 0.5);
  for (const double heading : {0.0, 0.7, -2.4}) {
    for (const double speed : {0.01, 20.0, -15.0}) {
      PlanarBody b = car.body(speed, heading, heading, 0.0);
      move_on_road(car.footing, released, 0.8, 0.01, 5.0, b);
      EXPECT_NEAR(std::hypot(b.vx, b.vy), std::abs(speed), 1e-12 * std::abs(speed));
      EXPECT_NEAR(b.x, 5.0 * speed * std::cos(heading), 1e-9);
      EXPECT_NEAR(b.y, 5.0 * speed * std::sin(heading), 1e-9);
    }
  }
}

/// The reference model with the given state of the wheels.
ReferenceCar reference_of(const Saloon& car, double grip, double steering, double brake,
                          bool locked, unsigned damaged) {
  ReferenceCar reference;
  reference.mass_kg = car.mass_kg;
  reference.inertia_kgm2 = car.inertia_kgm2;
  reference.grip = grip;
  reference.cornering = car.footing.cornering;
  for (int i = 0; i < 4; ++i) {
    const bool front = i < 2;
    const Footing& f = car.footing;
    reference.wheels.push_back({front ? f.front_m : f.rear_m, f.y_m[i % 2],
                                (front ? f.front_load : f.rear_load)[i % 2], front ? steering : 0.0,
                                brake, locked || ((damaged >> i) & 1U) != 0U});
  }
  return reference;
}

TEST(Tyres, BrakingCarInACurveFollowsTheBicycleModel) {
  const Saloon car;
  for (const double degrees : {1.0, 2.5, -4.0, 8.0}) {
    for (const double brake : {0.0, 0.3, 0.7}) {
      ReferenceCar bicycle;
      bicycle.mass_kg = car.mass_kg;
      bicycle.inertia_kgm2 = car.inertia_kgm2;
      const double steering = degrees * detail::pi / 180.0;
      bicycle.wheels = {{car.footing.front_m, 0.0, 0.58, steering, brake, false},
                        {car.footing.rear_m, 0.0, 0.42, 0.0, brake, false}};
      ReferenceCar::State s;
      s << 0, 0, 0, 20, 0, 0;
      s = bicycle.after(s, 2.0);
      const Wheels wheels =
          detail::wheels_after(car.footing, AfterContact::brakes, steering, brake);
      for (const double step_s : {0.005, 0.010, 0.020}) {
        PlanarBody b = car.body(20.0, 0.0, 0.0, 0.0);
        move_on_road(car.footing, wheels, bicycle.grip, step_s, 2.0, b);
        EXPECT_LT(std::hypot(b.x - s[0], b.y - s[1]), 0.1)
            << degrees << " degrees, brake " << brake << ", " << step_s << " s: " << b.x << ' '
            << b.y << ", bicycle " << s[0] << ' ' << s[1];
      }
    }
  }
}

TEST(Tyres, SkidsFollowTheReference) {
  Random random = seeded(811);
  const Saloon car;
  std::vector<double> errors;
  for (int i = 0; i < 60; ++i) {
    const double heading = random.uniform(-detail::pi, detail::pi);
    const double speed = random.uniform(8, 35);
    const double spin = random.uniform(-4, 4);
    const double steering = random.uniform(-0.2, 0.2);
    const double brake = random.uniform(0, 0.9);
    const double grip = random.uniform(0.3, 1.0);
    const bool locked = i % 4 == 0;
    const unsigned damaged = i % 2 == 0 ? 0U : random.below(16);
    ReferenceCar::State s;
    s << 0, 0, heading, speed, 0, spin;
    s = reference_of(car, grip, steering, brake, locked, damaged).after(s, 1.5);
    const Wheels wheels = detail::wheels_after(
        car.footing, locked ? AfterContact::locks : AfterContact::brakes, steering, brake, damaged);
    PlanarBody b = car.body(speed, heading, 0.0, spin);
    move_on_road(car.footing, wheels, grip, 0.005, 1.5, b);
    errors.push_back(std::hypot(b.x - s[0], b.y - s[1]) / std::hypot(s[0], s[1]));
    EXPECT_LT(errors.back(), 0.01) << "draw " << i;
    EXPECT_NEAR(heading + b.turned, s[2], 0.05) << "draw " << i;
  }
  std::sort(errors.begin(), errors.end());
  std::printf("position over travel: median %.5f, worst %.5f\n", errors[errors.size() / 2],
              errors.back());
}

TEST(Tyres, SpunRollingCarLosesEnergyUntilItRollsStraight) {
  const Saloon car;
  const Wheels released = detail::wheels_after(car.footing, AfterContact::releases, 0.0, 0.0);
  for (const double step_s : {0.002, 0.01, 0.02}) {
    for (const double heading : {0.0, 0.5, 1.5, 3.0}) {
      PlanarBody b = car.body(20.0, heading, 0.0, detail::pi);
      double energy = b.energy();
      for (double t = 0.0; t < 20.0; t += step_s) {
        step_on_road(car.footing, released, 0.7, step_s, b);
        ASSERT_LE(b.energy(), energy * (1.0 + 1e-15));
        energy = b.energy();
      }
      const double speed = std::hypot(b.vx, b.vy);
      EXPECT_LT(std::abs(b.spin), 1e-3);
      EXPECT_LT(std::abs(b.cosine * b.vy - b.sine * b.vx), 1e-3 * std::max(speed, 1.0));
      std::printf("step %.3f s, heading %.1f: final speed %.3f m/s\n", step_s, heading, speed);
    }
  }
}

TEST(Tyres, HalvedStepsChangeThePathLittle) {
  Random random = seeded(812);
  const Saloon car;
  std::array<std::vector<double>, 3> changes;
  for (int i = 0; i < 300; ++i) {
    const Wheels wheels = random_wheels(random, car.footing);
    const double grip = random.uniform(0.2, 1.0);
    const double speed = random.uniform(5, 40);
    const PlanarBody start =
        car.body(speed, random.uniform(-detail::pi, detail::pi), 0.0, random.uniform(-5, 5));
    std::array<PlanarBody, 4> ends{start, start, start, start};
    for (std::size_t k = 0; k < 4; ++k) {
      move_on_road(car.footing, wheels, grip, 0.02 / static_cast<double>(1 << k), 3.0, ends[k]);
    }
    const double travel = std::hypot(ends[3].x, ends[3].y);
    for (std::size_t k = 0; k < 3; ++k) {
      changes[k].push_back(std::hypot(ends[k].x - ends[k + 1].x, ends[k].y - ends[k + 1].y) /
                           travel);
      EXPECT_LT(changes[k].back(), 0.02) << "draw " << i << ", halved " << k;
    }
  }
  for (std::vector<double>& c : changes) {
    std::sort(c.begin(), c.end());
    std::printf("change over travel: median %.6f, 95 %% %.6f, worst %.6f\n", c[c.size() / 2],
                c[c.size() * 95 / 100], c.back());
  }
}

TEST(Tyres, NoStepAddsEnergyOrMoreMomentumThanTheGripGives) {
  Random random = seeded(813);
  double most_share = 0.0;
  double most_growth = -1.0;
  for (int i = 0; i < 1000000; ++i) {
    const Footing f = random_footing(random);
    const Wheels wheels = random_wheels(random, f);
    const double grip = i % 10 == 0 ? 0.0 : random.uniform(0, 1.5);
    const double seconds = std::exp(random.uniform(std::log(1e-5), std::log(0.02)));
    PlanarBody b = random_body(random, f);
    const PlanarBody start = b;
    detail::apply_tyre_forces(f, wheels, grip, seconds, b);
    ASSERT_TRUE(std::isfinite(b.energy()));
    most_growth = std::max(most_growth, b.energy() / start.energy() - 1.0);
    ASSERT_LE(b.energy(), start.energy() * (1.0 + 1e-15)) << "draw " << i;
    const double change = std::hypot(b.vx - start.vx, b.vy - start.vy);
    const double most = grip * gravity_mps2 * seconds;
    // Tolerance for the rounding of the velocities.
    ASSERT_LE(change, most * (1.0 + 1e-12) + 1e-15 * std::hypot(start.vx, start.vy))
        << "draw " << i;
    if (most > 0.0) most_share = std::max(most_share, change / most);
    ASSERT_EQ(b.x, start.x);
    ASSERT_EQ(b.y, start.y);
    ASSERT_EQ(b.cosine, start.cosine);
    ASSERT_EQ(b.turned, start.turned);
  }
  std::printf(
      "relative growth of energy at most %.1e; momentum change at most %.6f of grip·g·time\n",
      most_growth, most_share);
  EXPECT_GT(most_share, 0.99);
}

TEST(Tyres, CreepingRoundACurveAddsNoEnergy) {
  // Wheels that roll in their own direction dissipate nothing: only rounding changes the energy,
  // while the tyres are stiffest.
  Random random = seeded(816);
  double most_growth = -1.0;
  for (int i = 0; i < 300; ++i) {
    Footing f = random_footing(random);
    // No track width: parallel wheels of an axle would drag slightly in a curve.
    f.y_m.setZero();
    const Wheels wheels =
        detail::wheels_after(f, AfterContact::releases, random.uniform(-0.6, 0.6), 0.0);
    PlanarBody b = random_body(random, f);
    const double slow = std::exp(random.uniform(std::log(1e-4), std::log(2.0)));
    const double speed = std::hypot(b.vx, b.vy);
    b.vx *= slow / speed;
    b.vy *= slow / speed;
    b.spin *= slow / speed;
    double energy = b.energy();
    for (int k = 0; k < 500; ++k) {
      step_on_road(f, wheels, 0.8, 0.02, b);
      if (energy > 0.0) most_growth = std::max(most_growth, b.energy() / energy - 1.0);
      ASSERT_LE(b.energy(), energy * (1.0 + 1e-15)) << "draw " << i << ", step " << k;
      energy = b.energy();
    }
  }
  std::printf("relative growth of energy at most %.1e\n", most_growth);
}

TEST(Tyres, BrakedAndLockedBodiesComeToRestAndStay) {
  Random random = seeded(814);
  double longest_s = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const Footing f = random_footing(random);
    const auto after = i % 2 == 0 ? AfterContact::locks : AfterContact::brakes;
    const double steering = random.uniform(-0.6, 0.6);
    const double brake = random.uniform(0.3, 0.95);
    const Wheels wheels = detail::wheels_after(f, after, steering, brake, random.below(16));
    PlanarBody b = random_body(random, f);
    const double grip = random.uniform(0.3, 1.5);
    const double step_s = random.uniform(0.001, 0.02);
    double time_s = 0.0;
    double energy = b.energy();
    while (!at_rest(b) && time_s < 60.0) {
      step_on_road(f, wheels, grip, step_s, b);
      time_s += step_s;
      ASSERT_LE(b.energy(), energy * (1.0 + 1e-15)) << "draw " << i;
      energy = b.energy();
    }
    ASSERT_TRUE(at_rest(b)) << "draw " << i << ": " << b.vx << ' ' << b.vy << ' ' << b.spin;
    longest_s = std::max(longest_s, time_s);
    const PlanarBody rest = b;
    move_on_road(f, wheels, grip, step_s, 1.0, b);
    ASSERT_EQ(b.x, rest.x);
    ASSERT_EQ(b.y, rest.y);
    ASSERT_EQ(b.cosine, rest.cosine);
    ASSERT_EQ(b.sine, rest.sine);
    ASSERT_TRUE(at_rest(b));
  }
  std::printf("longest stop %.1f s\n", longest_s);
}

TEST(Tyres, MirroredStateGivesTheMirroredBits) {
  Random random = seeded(815);
  for (int i = 0; i < 2000; ++i) {
    const Footing f = random_footing(random);
    const auto after = static_cast<AfterContact>(random.below(3));
    const double steering = random.uniform(-0.6, 0.6);
    const double brake = random.uniform(0, 1);
    const unsigned damaged = random.below(16);
    Footing g = f;
    g.y_m << -f.y_m[1], -f.y_m[0];
    g.front_load << f.front_load[1], f.front_load[0];
    g.rear_load << f.rear_load[1], f.rear_load[0];
    const unsigned exchanged = ((damaged & 5U) << 1U) | ((damaged & 10U) >> 1U);
    const Wheels wheels = detail::wheels_after(f, after, steering, brake, damaged);
    const Wheels mirrored = detail::wheels_after(g, after, -steering, brake, exchanged);
    PlanarBody b = random_body(random, f);
    PlanarBody m = b;
    m.sine = -b.sine;
    m.vy = -b.vy;
    m.spin = -b.spin;
    const double grip = random.uniform(0, 1.5);
    const double step_s = random.uniform(0.001, 0.02);
    for (int k = 0; k < 20; ++k) {
      step_on_road(f, wheels, grip, step_s, b);
      step_on_road(g, mirrored, grip, step_s, m);
      ASSERT_EQ(m.x, b.x) << "draw " << i;
      ASSERT_EQ(m.y, -b.y);
      ASSERT_EQ(m.vx, b.vx);
      ASSERT_EQ(m.vy, -b.vy);
      ASSERT_EQ(m.spin, -b.spin);
      ASSERT_EQ(m.cosine, b.cosine);
      ASSERT_EQ(m.sine, -b.sine);
    }
  }
}

TEST(Tyres, WithoutGripTimeOrMassNothingChanges) {
  const Saloon car;
  const Wheels locked = detail::wheels_after(car.footing, AfterContact::locks, 0.0, 0.0);
  const PlanarBody start = car.body(20.0, 0.3, 1.0, 2.0);
  for (const std::array<double, 2> none : {std::array{0.0, 0.01}, std::array{-1.0, 0.01},
                                           std::array{0.8, 0.0}, std::array{0.8, -0.01}}) {
    PlanarBody b = start;
    detail::apply_tyre_forces(car.footing, locked, none[0], none[1], b);
    EXPECT_EQ(b.vx, start.vx);
    EXPECT_EQ(b.vy, start.vy);
    EXPECT_EQ(b.spin, start.spin);
  }
  PlanarBody fixed = start;
  fixed.inverse_mass = 0.0;
  fixed.inverse_inertia = 0.0;
  detail::apply_tyre_forces(car.footing, locked, 0.8, 0.01, fixed);
  EXPECT_EQ(fixed.vx, start.vx);
}

}  // namespace
}  // namespace crashrank

#include "crashrank/crash/pulse.hpp"

#include "crash/random.hpp"
#include "crash/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace crashrank {
namespace {

using Eigen::Vector3d;
using test::box_mesh;
using test::mirrored;
using test::Random;

CrushStrength even(double yield_npm, double slope_npm2, double low, double high) {
  CrushStrength strength;
  strength.front = {yield_npm, slope_npm2};
  strength.side = strength.front;
  strength.rear = strength.front;
  strength.low_m = low;
  strength.high_m = high;
  return strength;
}

/// A body whose mesh is about its origin on the ground.
PulseBody body_of(const TriangleMesh& mesh, double mass, const Pose& pose, const Vector3d& v,
                  const CrushStrength& strength, double spin = 0.0) {
  const Vector3d size = mesh.bounds().extent().cast<double>();
  PulseBody body;
  body.mesh = &mesh;
  body.pose = pose;
  MassProperties mass_properties;
  mass_properties.mass_kg = mass;
  mass_properties.inertia_kgm2 *= mass * (size.x() * size.x() + size.y() * size.y()) / 12.0;
  body.rigid = place(mass_properties, pose, {v, {0, 0, spin}});
  body.strength = strength;
  return body;
}

PulseBody wall_of(const TriangleMesh& mesh, const Pose& pose) {
  PulseBody wall;
  wall.mesh = &mesh;
  wall.pose = pose;
  wall.strength = CrushStrength::unyielding();
  return wall;
}

Pose at(double x, double y, double yaw = 0.0) { return pose_from_angles({x, y, 0}, yaw, 0, 0); }

TEST(Pulse, AFullWidthWallStopsACarAtTheDepthOfItsLaw) {
  // A block 2 m wide and 1 m high, all of which carries: E = 2·(A·C + B·C²/2).
  const TriangleMesh car = box_mesh({2, 1, 0.5}, {0, 0, 0.5}, 4);
  const TriangleMesh wall = box_mesh({0.5, 3, 1}, {0, 0, 1}, 2);
  const double yield = 50e3;
  const double slope = 600e3;
  const PulseBody a = body_of(car, 1500, at(-2.5, 0), {15, 0, 0}, even(yield, slope, 0, 1));
  const PulseResult r = simulate_pulse(a, wall_of(wall, at(0, 0)), {-0.5, 0, 0}, {1, 0, 0});
  ASSERT_TRUE(r.acts);
  EXPECT_FALSE(r.slides);
  const double energy = 0.5 * 1500 * 225;
  const double depth = (-yield + std::sqrt(yield * yield + 2 * slope * energy / 2)) / slope;
  EXPECT_NEAR(r.a.delta_v_mps.x(), -15.0, 0.05);
  EXPECT_NEAR(r.deepest_m, depth, 0.02);
  EXPECT_NEAR(r.dissipated_j, energy, 0.01 * energy);
  // Cells of the two bodies need not be mirror images of each other.
  EXPECT_NEAR(r.a.delta_v_mps.y(), 0.0, 0.05);
  EXPECT_NEAR(r.a.delta_omega_radps.z(), 0.0, 0.02);
  EXPECT_NEAR(std::fmod(r.a.pdof_deg + 1.0, 360.0), 1.0, 0.3);
  EXPECT_EQ(r.a.clock, 12);
}

TEST(Pulse, AnOffCentreWallTurnsTheCarTowardsIt) {
  const TriangleMesh car = box_mesh({2, 0.9, 0.5}, {0, 0, 0.5}, 4);
  const TriangleMesh wall = box_mesh({0.5, 1, 1}, {0, 0, 1}, 2);
  const PulseBody a = body_of(car, 1500, at(-2.5, 0), {15, 0, 0}, even(50e3, 600e3, 0, 1));
  const PulseResult left = simulate_pulse(a, wall_of(wall, at(0, 1.4)), {-0.5, 0.6, 0}, {1, 0, 0});
  ASSERT_TRUE(left.acts);
  EXPECT_GT(left.a.delta_omega_radps.z(), 0.5);
  EXPECT_LT(left.a.delta_v_mps.y(), 0.0);
  // In the mirror everything mirrors.
  const TriangleMesh car_m = mirrored(car);
  const TriangleMesh wall_m = mirrored(wall);
  PulseBody b = a;
  b.mesh = &car_m;
  const PulseResult right =
      simulate_pulse(b, wall_of(wall_m, at(0, -1.4)), {-0.5, -0.6, 0}, {1, 0, 0});
  EXPECT_NEAR(right.a.delta_v_mps.x(), left.a.delta_v_mps.x(), 0.02 * 15);
  EXPECT_NEAR(right.a.delta_v_mps.y(), -left.a.delta_v_mps.y(), 0.02 * 15);
  EXPECT_NEAR(right.a.delta_omega_radps.z(), -left.a.delta_omega_radps.z(), 0.15);
}

TEST(Pulse, WithoutOverlapNothingHappens) {
  const TriangleMesh car = box_mesh({2, 0.9, 0.5}, {0, 0, 0.5});
  const TriangleMesh wall = box_mesh({0.5, 1, 1}, {0, 0, 1});
  const PulseBody a = body_of(car, 1500, at(-2.5, 0), {15, 0, 0}, even(50e3, 600e3, 0, 1));
  const PulseResult past = simulate_pulse(a, wall_of(wall, at(0, 1.95)), {-0.5, 0.9, 0}, {1, 0, 0});
  EXPECT_FALSE(past.acts);
  EXPECT_TRUE(past.a.delta_v_mps.isZero(0.0));
  const TriangleMesh bridge = box_mesh({0.5, 1, 1}, {0, 0, 3});
  EXPECT_FALSE(simulate_pulse(a, wall_of(bridge, at(0, 0)), {-0.5, 0, 0}, {1, 0, 0}).acts);
}

// A car that runs at a flat angle into the flank of a long wall is turned aside by it, wherever the
// wall begins behind the car.
TEST(Pulse, AWallIsFeltAlongItsWholeFlank) {
  const TriangleMesh car = box_mesh({2, 0.9, 0.5}, {0, 0, 0.5}, 8);
  const double heading = 0.17;
  const double speed = 33.0;
  const Vector3d v(speed * std::cos(heading), speed * std::sin(heading), 0.0);
  // The front left corner touches the wall's face y = 0.
  const double y = -(2.0 * std::sin(heading) + 0.9 * std::cos(heading)) - 1e-4;
  const PulseBody a = body_of(car, 1500, at(0, y, heading), v, even(50e3, 600e3, 0, 1));
  const double corner_x = 2.0 * std::cos(heading) - 0.9 * std::sin(heading);
  std::vector<double> across;
  for (const double behind : {2.0, 8.0, 20.0}) {
    const double length = 0.5 * (behind + 12.0);
    const TriangleMesh wall = box_mesh({length, 0.25, 1}, {12.0 - length, 0.25, 1}, 4);
    const PulseResult r =
        simulate_pulse(a, wall_of(wall, at(0, 0)), {corner_x, 0, 0}, {v.x(), v.y(), 0});
    ASSERT_TRUE(r.acts);
    across.push_back(-r.a.delta_v_mps.y());
    // It is heavy work to push a corner in by the way that it would go otherwise.
    EXPECT_GT(across.back(), 0.25 * v.y()) << behind;
    EXPECT_LT(across.back(), 1.2 * v.y()) << behind;
  }
  // The cells lie a little differently.
  EXPECT_NEAR(across[1], across[0], 0.05 * across[0]);
  EXPECT_NEAR(across[2], across[0], 0.05 * across[0]);
}

// What lies further behind than anything can come within the pulse takes neither room nor time.
TEST(Pulse, ASpikeBehindTheCarIsNoneOfItsBusinessHoweverLong) {
  const TriangleMesh car = box_mesh({2, 0.9, 0.5}, {0, 0, 0.5}, 8);
  const PulseBody a = body_of(car, 1500, at(0, 0), {15, 0, 0}, even(50e3, 600e3, 0, 1));
  std::vector<double> stopped;
  for (const double behind : {100.0, 1e4, 1e6}) {
    TriangleMesh wall = box_mesh({0.5, 3, 1}, {2.5, 0, 1}, 2);
    const double half = 0.5 * (behind + 2.0);
    const TriangleMesh rail = box_mesh({half, 0.1, 1}, {2.0 - half, 1.2, 1}, 1);
    const auto first = static_cast<std::uint32_t>(wall.vertices.size());
    for (const auto& vertex : rail.vertices) wall.vertices.push_back(vertex);
    for (const auto& t : rail.triangles) {
      wall.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
    const PulseResult r = simulate_pulse(a, wall_of(wall, at(0, 0)), {2, 0, 0}, {1, 0, 0});
    ASSERT_TRUE(r.acts);
    stopped.push_back(-r.a.delta_v_mps.x());
  }
  EXPECT_NEAR(stopped[0], 15.0, 1.5);
  EXPECT_NEAR(stopped[1], stopped[0], 0.02 * stopped[0]);
  EXPECT_NEAR(stopped[2], stopped[0], 0.02 * stopped[0]);
}

TEST(Pulse, MassRatiosRunToTheirLimits) {
  const TriangleMesh car = box_mesh({2, 0.9, 0.5}, {0, 0, 0.5}, 2);
  const CrushStrength strength = even(50e3, 600e3, 0, 1);
  for (const double other : {7.5, 75.0, 1500.0, 40e3, 1e7}) {
    const PulseBody a = body_of(car, 1500, at(-2, 0), {15, 0, 0}, strength);
    const PulseBody b = body_of(car, other, at(2, 0), {0, 0, 0}, strength);
    const PulseResult r = simulate_pulse(a, b, {0, 0, 0}, {1, 0, 0});
    ASSERT_TRUE(r.acts) << other;
    const double common = 15.0 * 1500 / (1500 + other);
    EXPECT_NEAR(15.0 + r.a.delta_v_mps.x(), common, 0.15) << other;
    EXPECT_NEAR(r.b.delta_v_mps.x(), common, 0.15) << other;
  }
}

TEST(PulseProperty, MomentumIsConservedAndEnergyNeverGained) {
  constexpr std::uint64_t seed = 21;
  Random random(seed);
  const TriangleMesh car = box_mesh({2, 0.9, 0.5}, {0, 0, 0.5}, 2);
  const TriangleMesh ball = test::sphere_mesh(0.8, 8, {0, 0, 0.8});
  int acted = 0;
  PulseOptions coarse;
  coarse.cell_w_m = 0.1;
  coarse.cell_h_m = 0.25;
  coarse.step_s = 0.002;
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", case " + std::to_string(i));
    coarse.friction = random.uniform(0, 1);
    const double yaw = random.uniform(-3, 3);
    const PulseBody a = body_of(car, random.uniform(500, 20000), at(0, 0, random.uniform(-3, 3)),
                                {random.uniform(5, 30), random.uniform(-5, 5), 0},
                                even(50e3, 600e3, 0, 1), random.uniform(-2, 2));
    const PulseBody b = body_of(i % 2 == 0 ? ball : car, random.uniform(50, 5000),
                                at(random.uniform(1.5, 3), random.uniform(-1, 1), yaw),
                                {random.uniform(-20, 5), random.uniform(-5, 5), 0},
                                even(20e3, 300e3, 0, 1.6), random.uniform(-2, 2));
    const PulseResult r = simulate_pulse(a, b, {1, 0, 0}, {1, 0, 0}, coarse);
    if (!r.acts) continue;
    ++acted;
    const auto momentum = [](const RigidBody& body, const Velocity& v) -> Vector3d {
      return body.mass_kg * v.linear_mps;
    };
    const Vector3d before =
        momentum(a.rigid, a.rigid.velocity) + momentum(b.rigid, b.rigid.velocity);
    const Vector3d after = momentum(a.rigid, r.a.after) + momentum(b.rigid, r.b.after);
    const double scale =
        momentum(a.rigid, a.rigid.velocity).norm() + momentum(b.rigid, b.rigid.velocity).norm();
    ASSERT_LE((after - before).norm(), 1e-12 * scale);
    const double had = kinetic_energy(a.rigid) + kinetic_energy(b.rigid);
    ASSERT_LE(r.a.energy_change_j + r.b.energy_change_j, 1e-9 * had);
    ASSERT_GE(r.dissipated_j, 0.0);
    ASSERT_TRUE(r.a.delta_v_mps.allFinite());
  }
  EXPECT_GT(acted, 40);
}

TEST(Pulse, FinerCellsAndStepsTellTheSame) {
  const TriangleMesh car = box_mesh({2, 0.9, 0.5}, {0, 0, 0.5}, 4);
  const TriangleMesh post = test::sphere_mesh(0.7, 24, {0, 0, 0.5});
  double last = 0.0;
  double change = 1.0;
  for (const double cell : {0.1, 0.05, 0.025, 0.0125}) {
    const PulseBody a = body_of(car, 1500, at(-2.7, 0), {15, 0, 0}, even(50e3, 600e3, 0, 1));
    PulseOptions options;
    options.cell_w_m = cell;
    options.cell_h_m = cell;
    options.step_s = cell / 50;
    const PulseResult r =
        simulate_pulse(a, wall_of(post, at(0, 0.6)), {-0.7, 0.5, 0}, {1, 0, 0}, options);
    change = std::abs(r.a.delta_v_mps.norm() - last);
    last = r.a.delta_v_mps.norm();
  }
  EXPECT_LT(change, 0.01 * 15);
}

TEST(Strength, SharingIsBalancedAndSpendsTheWork) {
  const CrushPressure soft{5e4, 2e5, std::numeric_limits<double>::infinity(), false};
  const CrushPressure hard{2e5, 8e5, 0.1, false};
  CrushPressure rigid;
  rigid.rigid = true;
  double work = 0.0;
  double last = 0.0;
  double last_pressure = 0.0;
  for (double depth = 0.001; depth < 3.0; depth += 0.001) {
    const SharedCrush s = share_crush(soft, hard, depth);
    ASSERT_NEAR(s.depth_a_m + s.depth_b_m, depth, 1e-9);
    ASSERT_GE(s.pressure_pa, last_pressure);
    work += 0.5 * (s.pressure_pa + last_pressure) * (depth - last);
    last = depth;
    last_pressure = s.pressure_pa;
    const SharedCrush turned = share_crush(hard, soft, depth);
    ASSERT_EQ(turned.depth_b_m, s.depth_a_m);
  }
  const SharedCrush end = share_crush(soft, hard, last);
  EXPECT_NEAR(end.energy_a_jpm2 + end.energy_b_jpm2, work, 1e-3 * work);
  EXPECT_EQ(share_crush(soft, rigid, 0.3).depth_a_m, 0.3);
  EXPECT_EQ(share_crush(rigid, soft, 0.3).depth_b_m, 0.3);
}

TEST(Strength, ACarsCoreKeepsTheSumOfItsWidth) {
  const CrushStrength car = car_strength({1500, 1.8, 0.0, 2.7});
  double sum = 0.0;
  constexpr int steps = 1800;
  for (int i = 0; i < steps; ++i) {
    const double y = -0.9 + 1.8 * (i + 0.5) / steps;
    sum += car.core.share_at(3.5, y) / steps;
  }
  EXPECT_NEAR(sum, 1.0, 1e-3);
  // A full-width barrier at 15.6 m/s is what the law was made from: 0.5 m.
  const double c = 0.5;
  const double per_width = car.front.yield_npm * c + 0.5 * car.front.slope_npm2 * c * c;
  EXPECT_NEAR(1.8 * per_width, 0.5 * 1500 * (15.6 * 15.6 - 2.2 * 2.2), 1.0);
}

}  // namespace
}  // namespace crashrank

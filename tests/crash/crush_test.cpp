#include "crashrank/crash/crush.hpp"

#include "crashrank/crash/severity.hpp"

#include "crash/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace crashrank {
namespace {

using Eigen::Vector3d;
using test::box_mesh;
using test::sphere_mesh;

CrushStrength even(double yield_npm, double slope_npm2, double height) {
  CrushStrength strength;
  strength.front = {yield_npm, slope_npm2};
  strength.side = strength.front;
  strength.rear = strength.front;
  strength.low_m = -10;
  strength.high_m = -10 + height;
  strength.rest = 1.0;
  return strength;
}

PulseBody body_of(const TriangleMesh& mesh, double x, const CrushStrength& strength) {
  PulseBody body;
  body.mesh = &mesh;
  body.pose.translation.x() = x;
  body.rigid.mass_kg = 1000;
  body.strength = strength;
  return body;
}

PulseBody wall_of(const TriangleMesh& mesh, double x) {
  PulseBody wall = body_of(mesh, x, CrushStrength::unyielding());
  wall.rigid.mass_kg = std::numeric_limits<double>::infinity();
  return wall;
}

TEST(Crush, AFlatFaceIsPushedInByTheDepthOfItsLaw) {
  // 2 m wide, 1 m high, law over 1 m of height: E = 2·(A·C + B·C²/2).
  TriangleMesh car = box_mesh({2, 1, 0.5}, {0, 0, 0.5}, 8);
  car.parts = {{"all", 0, static_cast<std::uint32_t>(car.size())}};
  const TriangleMesh wall = box_mesh({0.5, 3, 2}, {0, 0, 1});
  const double c = 0.4;
  const double energy = 2 * (40e3 * c + 0.5 * 500e3 * c * c);
  const CrushResult r = crush(body_of(car, -2.5, even(40e3, 500e3, 1)), wall_of(wall, 0),
                              {-0.5, 0, 0}, {1, 0, 0}, energy);
  EXPECT_NEAR(r.energy_j, energy, 1e-6 * energy);
  EXPECT_NEAR(r.a.energy_j, energy, 1e-6 * energy);
  EXPECT_EQ(r.b.energy_j, 0.0);
  EXPECT_NEAR(r.a.deepest_m, c, 1e-6);
  EXPECT_NEAR(r.a.volume_m3, 2 * c, 1e-6);
  EXPECT_NEAR(r.a.ees_mps, std::sqrt(2 * energy / 1000), 1e-9 * energy);
  EXPECT_EQ(r.b.deepest_m, 0.0);
  // The front (2 m²) and 0.4 m of the sides, top and bottom move.
  EXPECT_NEAR(r.a.area_m2, 2 + c * (1 + 1 + 2 + 2), 0.3);
  ASSERT_EQ(r.a.parts.size(), 1U);
  EXPECT_NEAR(r.a.parts[0].intrusion_m, c, 1e-6);
}

TEST(Crush, TwoBodiesBearTheSamePressure) {
  const TriangleMesh car = box_mesh({2, 1, 0.5}, {0, 0, 0.5}, 2);
  const PulseBody a = body_of(car, -2, even(40e3, 200e3, 1));
  const PulseBody b = body_of(car, 2, even(40e3, 600e3, 1));
  const CrushResult r = crush(a, b, {0, 0, 0}, {1, 0, 0}, 100e3);
  EXPECT_NEAR(r.energy_j, 100e3, 0.1);
  EXPECT_NEAR(r.a.energy_j + r.b.energy_j, 100e3, 0.1);
  EXPECT_NEAR(r.a.deepest_m, 3 * r.b.deepest_m, 1e-6);
  EXPECT_NEAR(r.a.deepest_m + r.b.deepest_m, r.pressed_m, 1e-9);
  const CrushResult turned = crush(b, a, {0, 0, 0}, {-1, 0, 0}, 100e3);
  EXPECT_NEAR(turned.b.deepest_m, r.a.deepest_m, 1e-9);
}

// One ball at four resolutions against a wall: what the crush tells converges, and to the values of
// the round shape.
TEST(Crush, ConvergesUnderRefinement) {
  const TriangleMesh wall = box_mesh({0.5, 3, 3}, {0, 0, 1});
  const double slope = 500e3;
  // A ball of radius 1 pressed flat by s: ∬ B·C²/2 over the cap, C = s − ρ²/2 to second order.
  double last_area = 0.0;
  double last_change = 1e9;
  double depth = 0.0;
  double area = 0.0;
  for (const std::uint32_t rings : {8U, 16U, 32U, 64U}) {
    const TriangleMesh ball = sphere_mesh(1, rings, {0, 0, 1});
    const CrushResult r = crush(body_of(ball, -1.5, even(0, slope, 1)), wall_of(wall, 0),
                                {-0.5, 0, 0}, {1, 0, 0}, 20e3, {0.02, 0.01, 20});
    EXPECT_NEAR(r.energy_j, 20e3, 0.1);
    const double change = std::abs(r.a.area_m2 - last_area);
    EXPECT_LT(change, last_change);
    last_change = change;
    last_area = r.a.area_m2;
    depth = r.a.deepest_m;
    area = r.a.area_m2;
  }
  // The exact cap: E(s) = B/2 ∫ (√(1−ρ²) − (1−s))² 2πρ dρ.
  const auto energy = [&](double s) {
    const double q = 1 - s;
    // With z = √(1−ρ²): ∫ from q to 1 of (z−q)²·z dz times 2π.
    const auto part = [&](double z) {
      return z * z * z * z / 4 - 2 * q * z * z * z / 3 + q * q * z * z / 2;
    };
    return 0.5 * slope * 2 * std::numbers::pi * (part(1) - part(q));
  };
  double low = 0;
  double high = 1;
  for (int i = 0; i < 60; ++i)
    ((energy(0.5 * (low + high)) < 20e3) ? low : high) = 0.5 * (low + high);
  EXPECT_NEAR(depth, low, 0.01);
  EXPECT_NEAR(area, 2 * std::numbers::pi * low, 0.05 * 2 * std::numbers::pi * low);
}

TEST(Crush, NothingToSpendOrToMeetMovesNothing) {
  const TriangleMesh car = box_mesh({2, 1, 0.5}, {0, 0, 0.5});
  const TriangleMesh wall = box_mesh({0.5, 3, 2}, {0, 0, 1});
  const TriangleMesh bridge = box_mesh({0.5, 3, 1}, {0, 0, 4});
  const PulseBody a = body_of(car, -2.5, even(40e3, 500e3, 1));
  EXPECT_TRUE(crush(a, wall_of(wall, 0), {-0.5, 0, 0}, {1, 0, 0}, 0).a.triangles.empty());
  EXPECT_TRUE(crush(a, wall_of(bridge, 0), {-0.5, 0, 0}, {1, 0, 0}, 1e5).a.triangles.empty());
  EXPECT_TRUE(
      crush(wall_of(wall, 0), wall_of(wall, 1), {0, 0, 0}, {1, 0, 0}, 1e5).a.depth_m.size() > 0);
}

TEST(Severity, CdcCodesTellWhereAndHow) {
  Deformation d;
  d.body.min = {-1, -0.9F, 0};
  d.body.max = {3.8F, 0.9F, 1.45F};
  d.region.min = {3.3F, -0.9F, 0.2F};
  d.region.max = {3.8F, 0.9F, 0.8F};
  d.depth_m = 0.5;
  EXPECT_EQ(cdc_code(d), "12FDEW2");
  d.region.min.y() = 0.4F;
  d.pdof_deg = 340;
  EXPECT_EQ(cdc_code(d), "11FLEW2");
  d.region.min.y() = 0.55F;
  EXPECT_EQ(cdc_code(d), "11FLEN2");
  d.region.min = {-0.8F, 0.7F, 0.2F};
  d.region.max = {3.5F, 0.9F, 0.8F};
  d.pdof_deg = 350;
  d.sideswipe = true;
  d.depth_m = 0.1;
  EXPECT_EQ(cdc_code(d), "12LDES1");
  d.region.min = {0.8F, -0.9F, 0.2F};
  d.region.max = {2.0F, -0.4F, 1.2F};
  d.pdof_deg = 90;
  d.sideswipe = false;
  d.depth_m = 0.5;
  EXPECT_EQ(cdc_code(d), "03RPAW3");
  d.region = Box{};
  EXPECT_EQ(cdc_code(d), "");
}

TEST(Severity, AHeadOnCrashIsToldForBothBodies) {
  const TriangleMesh car = box_mesh({2, 0.9, 0.5}, {0, 0, 0.5}, 4);
  PulseBody a = body_of(car, -2, car_strength({1500, 1.8, -1.4, 2.8}));
  a.rigid.mass_kg = 1500;
  a.rigid.center_m = {-2, 0, 0.5};
  a.rigid.inertia_kgm2 *= 2500;
  a.rigid.velocity.linear_mps.x() = 12;
  PulseBody b = a;
  b.pose = pose_from_angles({2, 0, 0}, std::numbers::pi, 0, 0);
  b.rigid.center_m.x() = 2;
  b.rigid.velocity.linear_mps.x() = -12;
  b.rigid.forward = {-1, 0, 0};
  const Severity s = crash_severity(a, b, {0, 0, 0}, {1, 0, 0});
  ASSERT_TRUE(s.pulse.acts);
  EXPECT_NEAR(s.a.delta_v_mps.x(), -12, 0.3);
  EXPECT_NEAR(s.b.delta_v_mps.x(), -12, 0.3);
  EXPECT_EQ(s.a.cdc.substr(0, 3), "12F");
  EXPECT_EQ(s.b.cdc.substr(0, 3), "12F");
  EXPECT_NEAR(s.a.crush_energy_j, s.b.crush_energy_j, 0.05 * s.a.crush_energy_j);
  EXPECT_NEAR(s.a.crush_energy_j + s.b.crush_energy_j, s.pulse.dissipated_j - s.pulse.friction_j,
              0.01 * s.pulse.dissipated_j);
  EXPECT_NEAR(s.a.ees_mps, 12, 0.8);
  EXPECT_GT(s.a.crush_m, 0.2);
  EXPECT_LT(s.a.intrusion_m, s.a.crush_m);
}

}  // namespace
}  // namespace crashrank

#include "crashrank/crash/impulse.hpp"

#include "crash/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace crashrank {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::Random;
constexpr double pi = std::numbers::pi;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double mph = 0.44704;

// Rose, "Quantifying the uncertainty in the coefficient of restitution obtained with accelerometer
// data" family of reconstructions (SAE 2006-01-0908): four crash tests as tabulated for the open
// program pycrash (src/test_inputs_rose.py). A reference solution without sliding, not a
// measurement; inputs are rounded, hence the tolerances.
struct RoseTest {
  int id;
  double weight_lb[2];
  double izz_slug_ft2[2];
  double arm_ft[2];
  double arm_deg[2];  ///< counter-clockwise from the heading, centre of mass to contact
  double heading_deg[2];
  double speed_mph[2];
  double normal_deg;
  double restitution;
  double delta_v_mph[2];
  double delta_omega_dps[2];
};

constexpr RoseTest rose_tests[] = {
    {4363,
     {3451.1, 4695.4},
     {2152, 2805},
     {2.6, 5.7},
     {23.8, 10.6},
     {180, 32},
     {35.1, 35.0},
     55.0,
     .126,
     {39.5, 29.1},
     {31, 182}},
    {4364,
     {3451.1, 5192.5},
     {2152, 3563},
     {2.3, 7.1},
     {45.7, 11.2},
     {180, 30},
     {35.0, 34.9},
     51.9,
     .089,
     {40.1, 26.6},
     {108, 148}},
    {4438,
     {3305.7, 4725.3},
     {2066, 2889},
     {2.8, 5.0},
     {35.3, 13.2},
     {180, 30},
     {34.7, 35.0},
     50.7,
     .095,
     {39.7, 27.8},
     {68, 166}},
    {4474,
     {3305.7, 4657.0},
     {2066, 2863},
     {2.9, 5.5},
     {34.7, 15.2},
     {180, 31.6},
     {35.0, 35.0},
     51.8,
     .150,
     {40.5, 28.7},
     {40, 194}},
};

RigidBody rose_body(const RoseTest& t, int i) {
  const double heading = t.heading_deg[i] * pi / 180;
  const double arm = heading + t.arm_deg[i] * pi / 180;
  RigidBody body;
  body.mass_kg = t.weight_lb[i] * 0.45359237;
  body.inertia_kgm2 = Matrix3d::Identity() * (t.izz_slug_ft2[i] * 1.3558179483);
  body.forward = Vector3d(std::cos(heading), std::sin(heading), 0);
  body.center_m = -0.3048 * t.arm_ft[i] * Vector3d(std::cos(arm), std::sin(arm), 0);
  body.velocity.linear_mps = t.speed_mph[i] * mph * body.forward;
  return body;
}

TEST(Impulse, RoseReconstructionsAreReproduced) {
  for (const RoseTest& t : rose_tests) {
    const RigidBody bodies[2] = {rose_body(t, 0), rose_body(t, 1)};
    const double n = t.normal_deg * pi / 180;
    Vector3d normal(std::cos(n), std::sin(n), 0);
    if (normal.dot(bodies[0].velocity.linear_mps - bodies[1].velocity.linear_mps) < 0) {
      normal = -normal;
    }
    for (const ImpulseSpace space : {ImpulseSpace::planar, ImpulseSpace::spatial}) {
      const ImpulseResult result =
          impulse(bodies[0], bodies[1], {0, 0, 0}, normal, {t.restitution, infinity, space});
      ASSERT_TRUE(result.acts);
      EXPECT_FALSE(result.slides);
      EXPECT_EQ(result.restitution, t.restitution);
      const BodyImpulse* told[2] = {&result.a, &result.b};
      for (int i = 0; i < 2; ++i) {
        EXPECT_NEAR(told[i]->delta_v_mps.norm() / mph, t.delta_v_mph[i], 0.2)
            << t.id << " vehicle " << i + 1;
        EXPECT_NEAR(std::abs(told[i]->delta_omega_radps.z()) * 180 / pi, t.delta_omega_dps[i], 2.0)
            << t.id << " vehicle " << i + 1;
      }
      EXPECT_GT(result.dissipated_j, 0.0);
    }
  }
}

RigidBody ball(double mass, const Vector3d& center, const Vector3d& velocity) {
  RigidBody body;
  body.mass_kg = mass;
  body.center_m = center;
  body.inertia_kgm2 = Matrix3d::Identity() * (0.4 * mass);
  body.velocity.linear_mps = velocity;
  return body;
}

TEST(Impulse, CentralImpactHasItsClosedForm) {
  const RigidBody a = ball(1500, {-1, 0, 0}, {20, 0, 0});
  const RigidBody b = ball(1000, {1, 0, 0}, {-10, 0, 0});
  const ImpulseResult r = impulse(a, b, {0, 0, 0}, {1, 0, 0}, {0.2, 0.3, ImpulseSpace::planar});
  EXPECT_DOUBLE_EQ(r.normal_speed_mps, 30.0);
  const double p = 1.2 * 30 * (1500.0 * 1000 / 2500);
  EXPECT_NEAR(r.b.impulse_ns.x(), p, 1e-9);
  EXPECT_NEAR(r.a.delta_v_mps.x(), -p / 1500, 1e-12);
  EXPECT_NEAR(r.dissipated_j, 0.5 * 600 * 900 * (1 - 0.04), 1e-7);
  EXPECT_NEAR(r.separation_speed_mps, 6.0, 1e-12);
  EXPECT_EQ(r.a.pdof_deg, 0.0);
  EXPECT_EQ(r.a.clock, 12);
  EXPECT_EQ(r.b.pdof_deg, 180.0);
  EXPECT_EQ(r.b.clock, 6);
}

TEST(Impulse, AWallStopsAndIsNotMoved) {
  const RigidBody car = ball(1500, {-2, 0, 0}, {15, 0, 0});
  RigidBody wall;
  wall.center_m = Vector3d(9, 9, 9);
  const ImpulseResult r = impulse(car, wall, {0, 0, 0.5}, {1, 0, 0}, {0.0, 0.3});
  EXPECT_NEAR(r.a.delta_v_mps.x(), -15.0, 1e-12);
  EXPECT_TRUE(r.b.delta_v_mps.isZero(0.0));
  EXPECT_NEAR(r.dissipated_j, 0.5 * 1500 * 225, 1e-7);
  EXPECT_FALSE(impulse(wall, wall, {0, 0, 0}, {1, 0, 0}).acts);
}

TEST(Impulse, PartingBodiesAndVerticalNormalsDoNothing) {
  const RigidBody a = ball(1500, {-1, 0, 0}, {-5, 0, 0});
  const RigidBody b = ball(1000, {1, 0, 0}, {0, 0, 0});
  EXPECT_FALSE(impulse(a, b, {0, 0, 0}, {1, 0, 0}).acts);
  const RigidBody drop = ball(1000, {0, 0, 2}, {0, 0, -4});
  EXPECT_FALSE(impulse(drop, b, {0, 0, 1}, {0, 0, -1}).acts);
  ImpulseOptions spatial;
  spatial.space = ImpulseSpace::spatial;
  EXPECT_TRUE(impulse(drop, b, {0, 0, 1}, {0, 0, -1}, spatial).acts);
}

TEST(Impulse, ASideswipeSlidesAndAnAnchoredContactDoesNot) {
  const RigidBody a = ball(1500, {0, -1, 0}, {30, 1, 0});
  RigidBody rail;
  const ImpulseResult slide = impulse(a, rail, {0, 0, 0}, {0, 1, 0}, {0.1, 0.3});
  EXPECT_TRUE(slide.slides);
  EXPECT_GT(slide.friction_needed, 0.3);
  EXPECT_GT(slide.sliding_speed_mps, 20.0);
  EXPECT_NEAR(std::abs(slide.a.impulse_ns.x() / slide.a.impulse_ns.y()), 0.3, 1e-12);
  EXPECT_LT(slide.a.delta_v_mps.x(), 0.0);
  const ImpulseResult stick = impulse(a, rail, {0, 0, 0}, {0, 1, 0}, {0.1, infinity});
  EXPECT_FALSE(stick.slides);
  EXPECT_NEAR(stick.sliding_speed_mps, 0.0, 1e-12);
  const ImpulseResult smooth = impulse(a, rail, {0, 0, 0}, {0, 1, 0}, {0.1, 0.0});
  EXPECT_EQ(smooth.a.delta_v_mps.x(), 0.0);
  EXPECT_NEAR(smooth.a.delta_v_mps.y(), -1.1, 1e-12);
}

TEST(Impulse, DirectionsOfForceFollowTheConvention) {
  // Frontal 0, from the right 90: clockwise from above, in [0, 360).
  const Vector3d ahead(1, 0, 0);
  EXPECT_EQ(pdof_deg({-5, 0, 0}, ahead), 0.0);
  EXPECT_EQ(pdof_deg({0, 5, 0}, ahead), 90.0);
  EXPECT_EQ(pdof_deg({5, 0, 0}, ahead), 180.0);
  EXPECT_EQ(pdof_deg({0, -5, 0}, ahead), 270.0);
  EXPECT_NEAR(pdof_deg({-1, -1, 7}, ahead), 315.0, 1e-12);
  EXPECT_EQ(pdof_deg({0, 0, 3}, ahead), 0.0);
  EXPECT_NEAR(pdof_deg({-1, -1e-300, 0}, ahead), 0.0, 1e-12);
  EXPECT_LT(pdof_deg({-1, -1e-300, 0}, ahead), 360.0);
  // Turned with the body.
  EXPECT_NEAR(pdof_deg({0, -5, 0}, {0, 1, 0}), 0.0, 1e-12);
  EXPECT_EQ(clock_of(0.0), 12);
  EXPECT_EQ(clock_of(14.999), 12);
  EXPECT_EQ(clock_of(15.0), 1);
  EXPECT_EQ(clock_of(90.0), 3);
  EXPECT_EQ(clock_of(344.999), 11);
  EXPECT_EQ(clock_of(345.0), 12);
  EXPECT_EQ(clock_of(359.999), 12);
}

Matrix3d any_inertia(Random& random, double mass) {
  // Of a box, turned: positive definite and obeying the triangle inequality.
  const Vector3d e(random.uniform(0.3, 6), random.uniform(0.3, 3), random.uniform(0.3, 3));
  const Vector3d sq = e.cwiseProduct(e);
  const Vector3d moments = mass / 12 * Vector3d(sq.y() + sq.z(), sq.z() + sq.x(), sq.x() + sq.y());
  const Matrix3d r = random.rotation();
  return r * moments.asDiagonal() * r.transpose();
}

RigidBody any_body(Random& random, ImpulseSpace space) {
  RigidBody body;
  body.mass_kg = std::exp(random.uniform(std::log(10.0), std::log(40000.0)));
  body.center_m = random.vector(3);
  body.velocity.linear_mps = random.vector(30);
  body.velocity.angular_radps = random.vector(5);
  body.inertia_kgm2 = any_inertia(random, body.mass_kg);
  if (space == ImpulseSpace::planar) {
    body.velocity.linear_mps.z() = 0.0;
    body.velocity.angular_radps.head<2>().setZero();
    const double izz = body.inertia_kgm2(2, 2);
    body.inertia_kgm2 = Matrix3d::Identity() * izz;
  }
  return body;
}

Vector3d momentum(const RigidBody& body, const Velocity& v) { return body.mass_kg * v.linear_mps; }

Vector3d spin(const RigidBody& body, const Velocity& v) {
  return body.center_m.cross(momentum(body, v)) + body.inertia_kgm2 * v.angular_radps;
}

TEST(ImpulseProperty, MomentumIsConservedAndEnergyNeverGained) {
  constexpr std::uint64_t seed = 9;
  Random random(seed);
  int sliding = 0;
  int full = 0;
  int lowered = 0;
  for (int i = 0; i < 20000; ++i) {
    const ImpulseSpace space = i % 2 == 0 ? ImpulseSpace::planar : ImpulseSpace::spatial;
    const RigidBody a = any_body(random, space);
    const RigidBody b = any_body(random, space);
    const Vector3d point = random.vector(3);
    Vector3d normal = random.rotation().col(0);
    if (space == ImpulseSpace::planar) {
      normal.z() = 0.0;
      normal.normalize();
    }
    const double restitution = random.uniform(0, 1);
    const double friction = i % 10 == 0 ? infinity : random.uniform(0, 1.5);
    const ImpulseResult r = impulse(a, b, point, normal, {restitution, friction, space});
    SCOPED_TRACE("seed " + std::to_string(seed) + ", case " + std::to_string(i));
    if (!r.acts) {
      ASSERT_LE(r.normal_speed_mps, 0.0);
      continue;
    }
    (r.slides ? sliding : full) += 1;
    lowered += r.restitution < restitution ? 1 : 0;
    // Momentum, relative to what was exchanged and what there was.
    const Vector3d before = momentum(a, a.velocity) + momentum(b, b.velocity);
    const Vector3d after = momentum(a, r.a.after) + momentum(b, r.b.after);
    const double scale = momentum(a, a.velocity).norm() + momentum(b, b.velocity).norm();
    ASSERT_LE((after - before).norm(), 1e-12 * scale);
    Vector3d turned =
        spin(a, r.a.after) + spin(b, r.b.after) - spin(a, a.velocity) - spin(b, b.velocity);
    if (space == ImpulseSpace::planar) turned.head<2>().setZero();
    const double spin_scale =
        spin(a, a.velocity).norm() + spin(b, b.velocity).norm() + r.a.impulse_ns.norm() * 3;
    ASSERT_LE(turned.norm(), 1e-12 * spin_scale);
    // Energy: never gained, and what the bodies lose is what is said to be dissipated.
    const double had = kinetic_energy(a) + kinetic_energy(b);
    const double change = r.a.energy_change_j + r.b.energy_change_j;
    ASSERT_LE(change, 1e-12 * had);
    ASSERT_NEAR(-change, r.dissipated_j, 1e-10 * had);
    // The law itself.
    ASSERT_GE(normal.dot(r.b.impulse_ns), -1e-9 * r.b.impulse_ns.norm());
    ASSERT_NEAR(r.separation_speed_mps, r.restitution * r.normal_speed_mps,
                1e-9 * (1 + r.normal_speed_mps));
    const double normal_part = normal.dot(r.b.impulse_ns);
    const double across = (r.b.impulse_ns - normal_part * normal).norm();
    if (r.slides) {
      // Endless friction slides only where holding on would have to pull, and then without
      // pressing.
      ASSERT_NEAR(friction == infinity ? 0.0 : across,
                  friction == infinity ? normal_part : friction * normal_part,
                  1e-9 * r.b.impulse_ns.norm());
    } else {
      ASSERT_NEAR(r.sliding_speed_mps, 0.0, 1e-9 * (1 + r.normal_speed_mps));
      ASSERT_LE(across, friction * normal_part * (1 + 1e-9) + 1e-9);
    }
  }
  EXPECT_GT(sliding, 1000);
  EXPECT_GT(full, 1000);
  EXPECT_GT(lowered, 10);
}

TEST(ImpulseProperty, InThePlaneSpaceAndPlaneAgree) {
  constexpr std::uint64_t seed = 10;
  Random random(seed);
  for (int i = 0; i < 2000; ++i) {
    RigidBody a = any_body(random, ImpulseSpace::planar);
    RigidBody b = any_body(random, ImpulseSpace::planar);
    a.center_m.z() = b.center_m.z() = 0.6;
    Vector3d point = random.vector(3);
    point.z() = 0.6;
    const double angle = random.uniform(-pi, pi);
    const Vector3d normal(std::cos(angle), std::sin(angle), 0);
    ImpulseOptions options{random.uniform(0, 0.5), random.uniform(0, 1)};
    const ImpulseResult planar = impulse(a, b, point, normal, options);
    options.space = ImpulseSpace::spatial;
    const ImpulseResult spatial = impulse(a, b, point, normal, options);
    ASSERT_EQ(planar.acts, spatial.acts);
    if (!planar.acts) continue;
    ASSERT_EQ(planar.slides, spatial.slides) << "seed " << seed << ", case " << i;
    ASSERT_NEAR((planar.b.impulse_ns - spatial.b.impulse_ns).norm(), 0.0,
                1e-9 * planar.b.impulse_ns.norm());
    ASSERT_NEAR(planar.dissipated_j, spatial.dissipated_j, 1e-8 * (1 + planar.dissipated_j));
  }
}

TEST(ImpulseProperty, MirrorImagesMirror) {
  constexpr std::uint64_t seed = 14;
  Random random(seed);
  const auto mirror = [](Vector3d v) {
    v.y() = -v.y();
    return v;
  };
  const auto turn = [](const Vector3d& w) { return Vector3d(-w.x(), w.y(), -w.z()); };
  const Matrix3d m = Vector3d(1, -1, 1).asDiagonal();
  for (int i = 0; i < 2000; ++i) {
    RigidBody a = any_body(random, ImpulseSpace::spatial);
    RigidBody b = any_body(random, ImpulseSpace::spatial);
    const Vector3d point = random.vector(2);
    const Vector3d normal = random.rotation().col(0);
    const ImpulseOptions options{0.2, 0.4, ImpulseSpace::spatial};
    const ImpulseResult r = impulse(a, b, point, normal, options);
    for (RigidBody* body : {&a, &b}) {
      body->center_m = mirror(body->center_m);
      body->velocity.linear_mps = mirror(body->velocity.linear_mps);
      body->velocity.angular_radps = turn(body->velocity.angular_radps);
      body->inertia_kgm2 = m * body->inertia_kgm2 * m;
    }
    const ImpulseResult q = impulse(a, b, mirror(point), mirror(normal), options);
    ASSERT_EQ(r.acts, q.acts);
    if (!r.acts) continue;
    ASSERT_NEAR((mirror(q.a.delta_v_mps) - r.a.delta_v_mps).norm(), 0.0,
                1e-9 * (1 + r.a.delta_v_mps.norm()));
    ASSERT_NEAR((turn(q.b.delta_omega_radps) - r.b.delta_omega_radps).norm(), 0.0,
                1e-9 * (1 + r.b.delta_omega_radps.norm()));
    const double there_and_back = r.a.pdof_deg + q.a.pdof_deg;
    ASSERT_NEAR(std::fmod(there_and_back + 1e-6, 360.0), 1e-6, 1e-5);
  }
}

TEST(Impulse, ABodyIsPlacedWithItsCentreOfMass) {
  MassProperties car;
  car.mass_kg = 1500;
  car.center_m = Vector3d(1.4, 0, 0.5);
  car.inertia_kgm2 = Vector3d(500, 2300, 2500).asDiagonal();
  const Pose pose = pose_from_angles({10, 5, 0}, pi / 2, 0, 0);
  const RigidBody body = place(car, pose, {{0, 12, 0}, {0, 0, 0.5}});
  EXPECT_TRUE(body.center_m.isApprox(Vector3d(10, 6.4, 0.5), 1e-14));
  EXPECT_TRUE(body.velocity.linear_mps.isApprox(Vector3d(-0.7, 12, 0), 1e-14));
  EXPECT_NEAR(body.inertia_kgm2(0, 0), 2300, 1e-9);
  EXPECT_NEAR(body.inertia_kgm2(2, 2), 2500, 1e-9);
  EXPECT_TRUE(body.forward.isApprox(Vector3d(0, 1, 0), 1e-14));
}

}  // namespace
}  // namespace crashrank

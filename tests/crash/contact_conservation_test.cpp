#include "crash/contact_checks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using Eigen::Vector3d;
using test::change;
using test::ContactDraw;
using test::ContactScene;
using test::for_random_contacts;
using test::make_scene;
using test::percentile;
using test::Random;
using test::simulate;
using test::test_bodies;
using test::uniform_law;
using test::variant_for;

TEST(ContactLaw, MomentumAndAngularMomentumAreConserved) {
  std::vector<double> momentum;
  std::vector<double> moment;
  for_random_contacts(
      105, 2000, [&](int i, const ContactDraw& draw, std::size_t a, std::size_t b, double closing) {
        ContactScene scene;
        if (b >= test_bodies().movable.size() || !make_scene(draw, a, b, closing, scene)) return;
        const ContactOutcome r = simulate(scene, variant_for(i));
        const std::array<const ContactBody*, 2> bodies{&scene.a, &scene.b};
        const std::array<const BodyContact*, 2> results{&r.a, &r.b};
        Vector3d change = Vector3d::Zero();
        double turning = 0.0;
        double scale = 0.0;
        double moment_scale = 0.0;
        for (std::size_t k = 0; k < 2; ++k) {
          const Vehicle& v = *bodies[k]->vehicle;
          const Vector3d start = test::center_of(*bodies[k]) - scene.point_m;
          const Vector3d end = start + results[k]->moved_m;
          const Vector3d before = test::center_velocity(*bodies[k]);
          const Vector3d after = before + results[k]->delta_v_mps;
          change += v.mass_kg * results[k]->delta_v_mps;
          turning += v.mass_kg * (end.cross(after) - start.cross(before)).z() +
                     v.yaw_inertia_kgm2 * results[k]->delta_yaw_rate_radps;
          scale += v.mass_kg * before.norm();
          moment_scale += v.mass_kg * before.norm() * (start.norm() + end.norm()) +
                          v.yaw_inertia_kgm2 * std::abs(bodies[k]->velocity.angular_radps.z());
        }
        momentum.push_back(change.head<2>().norm() / scale);
        moment.push_back(std::abs(turning) / moment_scale);
      });
  std::printf("error of momentum at most %.3g, of angular momentum p50 %.3g, p90 %.3g, most %.3g\n",
              percentile(momentum, 1.0), percentile(moment, 0.5), percentile(moment, 0.9),
              percentile(moment, 1.0));
  EXPECT_GT(momentum.size(), 500U);
  EXPECT_LT(percentile(momentum, 1.0), 1e-12);
  EXPECT_LT(percentile(moment, 1.0), 1e-12);
}

TEST(ContactLaw, EnergyNeverGrows) {
  double most = -1.0;
  for_random_contacts(
      106, 2000, [&](int i, const ContactDraw& draw, std::size_t a, std::size_t b, double closing) {
        ContactScene scene;
        if (!make_scene(draw, a, b, closing, scene)) return;
        const ContactOutcome r = simulate(scene, variant_for(i));
        double before = 0.0;
        double after = 0.0;
        for (const auto& [body, result] : {std::pair{&scene.a, &r.a}, std::pair{&scene.b, &r.b}}) {
          const Vector3d velocity = test::center_velocity(*body);
          const double rate = body->velocity.angular_radps.z();
          before += test::energy_j(*body->vehicle, velocity, rate);
          after += test::energy_j(*body->vehicle, velocity + result->delta_v_mps,
                                  rate + result->delta_yaw_rate_radps);
        }
        most = std::max(most, after / before - 1.0);
        ASSERT_LE(after, before * (1.0 + 1e-12));
        ASSERT_NEAR(r.dissipated_j, before - after, 1e-9 * before);
        ASSERT_GE(r.friction_j, 0.0);
        ASSERT_NEAR(r.friction_j + r.a.crush_energy_j + r.b.crush_energy_j, r.dissipated_j,
                    1e-9 * before);
      });
  std::printf("relative growth of kinetic energy: at most %.3g\n", most);
}

TEST(ContactLaw, FixedBodiesDoNotMove) {
  for_random_contacts(
      107, 500, [&](int i, const ContactDraw& draw, std::size_t a, std::size_t b, double closing) {
        ContactScene scene;
        if (b < test_bodies().movable.size() || !make_scene(draw, a, b, closing, scene)) return;
        // The velocity of a fixed body is ignored.
        if (i % 2 == 0) scene.b.velocity.linear_mps = Vector3d(3, 4, 0);
        const ContactOutcome r = simulate(scene, variant_for(i));
        EXPECT_TRUE(r.b.delta_v_mps.isZero(0.0));
        EXPECT_TRUE(r.b.moved_m.isZero(0.0));
        EXPECT_EQ(r.b.turned_rad, 0.0);
        EXPECT_EQ(r.b.delta_yaw_rate_radps, 0.0);
        EXPECT_EQ(r.b.crush_energy_j, 0.0);
        EXPECT_EQ(r.b.crush_depth_m, 0.0);
        EXPECT_TRUE(Vector3d(r.b.impulse_ns + r.a.impulse_ns).isZero(0.0));
        ASSERT_FALSE(testing::Test::HasFailure());
      });
  const Vehicle& wall = test_bodies().fixed[0].vehicle;
  const Vehicle& post = test_bodies().fixed[4].vehicle;
  ContactScene scene;
  scene.a = {&post, test::flat_pose(-0.06, 0, 0), {{20, 0, 0}, {0, 0, 0}}};
  scene.b = {&wall, test::flat_pose(0, 0, 0), {}};
  EXPECT_FALSE(simulate(scene).acts);
}

TEST(ContactLaw, OverlapAtTheStartProducesNoForce) {
  const Vehicle block = test::uniform_block(4.0, 1.8, 1.0, 1500.0, uniform_law);
  ContactScene scene;
  scene.a = {&block, test::flat_pose(0, 0, 0), {{1, 0.5, 0}, {0, 0, 0}}};
  // One body inside the other.
  const Vehicle large = test::uniform_block(12.0, 8.0, 1.0, 15000.0, uniform_law);
  scene.b = {&large, test::flat_pose(0, 0, 0.3), {}};
  const ContactOutcome r = simulate(scene);
  EXPECT_FALSE(r.acts);
  EXPECT_TRUE(r.a.delta_v_mps.isZero(0.0));
  EXPECT_TRUE(r.a.impulse_ns.isZero(0.0));
  EXPECT_EQ(r.dissipated_j, 0.0);
}

TEST(ContactLaw, EveryContactEndsWithFiniteNumbers) {
  for_random_contacts(
      113, 400, [&](int i, const ContactDraw& draw, std::size_t a, std::size_t b, double) {
        constexpr std::array<double, 6> speeds{0.0, 1e-9, 1e-3, 0.3, 40.0, 300.0};
        ContactScene scene;
        if (!make_scene(draw, a, b, 1.0, scene)) return;
        const double speed = speeds[static_cast<std::size_t>(i) % speeds.size()];
        for (ContactBody* body : {&scene.a, &scene.b}) {
          body->velocity.linear_mps *= speed;
          body->velocity.angular_radps *= std::min(speed, 1.0);
        }
        const ContactOutcome r = simulate(scene, variant_for(i));
        // The maximum duration of a contact plus one step.
        EXPECT_LE(r.duration_s, 1.5 + ContactOptions{}.longest_s);
        EXPECT_GE(r.duration_s, 0.0);
        EXPECT_LT(r.steps, 20000U);
        EXPECT_TRUE(r.point_m.allFinite());
        EXPECT_TRUE(std::isfinite(r.closing_mps) && std::isfinite(r.restitution) &&
                    std::isfinite(r.dissipated_j) && std::isfinite(r.friction_j));
        for (const BodyContact* body : {&r.a, &r.b}) {
          EXPECT_TRUE(body->impulse_ns.allFinite() && body->delta_v_mps.allFinite() &&
                      body->moved_m.allFinite() && body->after.linear_mps.allFinite() &&
                      body->after.angular_radps.allFinite());
          EXPECT_TRUE(std::isfinite(body->crush_depth_m) && std::isfinite(body->crush_energy_j) &&
                      std::isfinite(body->intrusion_m) && std::isfinite(body->turned_rad));
          EXPECT_TRUE(body->pdof_deg >= 0.0 && body->pdof_deg < 360.0);
        }
        if (speed == 0.0) {
          EXPECT_FALSE(r.acts);
          EXPECT_TRUE(r.a.delta_v_mps.isZero(0.0));
        }
        ASSERT_FALSE(testing::Test::HasFailure());
      });
}

TEST(ContactLaw, SeparatingConvexBodiesDoNotAct) {
  constexpr std::uint64_t seed = 114;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  const Vehicle block = test::uniform_block(4.0, 1.8, 1.0, 1500.0, uniform_law);
  const std::array<const Vehicle*, 3> others{&block, &test_bodies().fixed[0].vehicle,
                                             &test_bodies().fixed[4].vehicle};
  int parted = 0;
  for (int i = 0; i < 300; ++i) {
    const ContactDraw draw(random);
    const double closing = std::exp(random.uniform(0.0, std::log(140.0)));
    ContactScene scene;
    if (!make_contact(draw, block, *others[static_cast<std::size_t>(i) % 3], closing, 0.001,
                      scene)) {
      continue;
    }
    ++parted;
    scene.a.velocity.linear_mps *= -1.0;
    scene.b.velocity.linear_mps *= -1.0;
    const ContactOutcome r = simulate(scene);
    ASSERT_FALSE(r.acts) << "contact " << i;
    EXPECT_EQ(r.duration_s, 0.0);
    EXPECT_TRUE(r.a.delta_v_mps.isZero(0.0));
    EXPECT_TRUE(r.b.delta_v_mps.isZero(0.0));
  }
  EXPECT_GT(parted, 200);
}

}  // namespace
}  // namespace crashrank

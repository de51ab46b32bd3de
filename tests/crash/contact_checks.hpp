#pragma once

#include "crash/contact_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace crashrank::test {

inline ContactOutcome simulate(const ContactScene& scene, const ContactVariant& variant = {},
                               const ContactOptions& options = {}) {
  static ContactWorkspace workspace;
  return simulate_contact(scene.a, scene.b, {}, scene.point_m, variant, workspace, options);
}

/// Calls a check for random contacts of all pairs of bodies, with number, draw, indices of the
/// bodies and closing speed.
inline void for_random_contacts(
    std::uint64_t seed, int count,
    const std::function<void(int, const ContactDraw&, std::size_t, std::size_t, double)>& check) {
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  const auto movable = static_cast<std::uint32_t>(test_bodies().movable.size());
  const auto all = static_cast<std::uint32_t>(test_bodies().size());
  for (int i = 0; i < count; ++i) {
    const std::size_t a = random.below(movable);
    const std::size_t b = random.below(all);
    const double closing = std::exp(random.uniform(0.0, std::log(140.0)));
    const ContactDraw draw(random);
    SCOPED_TRACE("contact " + std::to_string(i) + " of " + test_bodies().movable[a].name + " and " +
                 test_bodies().any(b).name + " at " + std::to_string(closing) + " m/s");
    check(i, draw, a, b, closing);
    if (::testing::Test::HasFatalFailure()) return;
  }
}

inline bool make_scene(const ContactDraw& draw, std::size_t a, std::size_t b, double closing,
                       ContactScene& scene, double gap_m = 0.001) {
  const bool meets = make_contact(draw, test_bodies().movable[a].vehicle,
                                  test_bodies().any(b).vehicle, closing, gap_m, scene);
  if (meets) spin(draw, scene);
  return meets;
}

inline ContactVariant variant_for(int i) {
  constexpr std::array<ContactVariant, 4> variants{
      {{1, 1, 1}, {0.33, 0.7, 3.0}, {2.0, 1.4, 0.0}, {0.0, 1.0, 1.0}}};
  return variants[static_cast<std::size_t>(i) % variants.size()];
}

inline bool same_bits(double p, double q) {
  return std::bit_cast<std::uint64_t>(p) == std::bit_cast<std::uint64_t>(q);
}
inline bool same_bits(const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
  return same_bits(p.x(), q.x()) && same_bits(p.y(), q.y()) && same_bits(p.z(), q.z());
}

inline void expect_same_bits(const BodyContact& p, const BodyContact& q) {
  EXPECT_TRUE(same_bits(p.impulse_ns, q.impulse_ns));
  EXPECT_TRUE(same_bits(p.delta_v_mps, q.delta_v_mps));
  EXPECT_TRUE(same_bits(p.delta_yaw_rate_radps, q.delta_yaw_rate_radps));
  EXPECT_TRUE(same_bits(p.after.linear_mps, q.after.linear_mps));
  EXPECT_TRUE(same_bits(p.after.angular_radps, q.after.angular_radps));
  EXPECT_TRUE(same_bits(p.moved_m, q.moved_m));
  EXPECT_TRUE(same_bits(p.turned_rad, q.turned_rad));
  EXPECT_TRUE(same_bits(p.pdof_deg, q.pdof_deg));
  EXPECT_TRUE(same_bits(p.crush_depth_m, q.crush_depth_m));
  EXPECT_TRUE(same_bits(p.crush_energy_j, q.crush_energy_j));
  EXPECT_TRUE(same_bits(p.intrusion_m, q.intrusion_m));
  EXPECT_EQ(p.damaged.min, q.damaged.min);
  EXPECT_EQ(p.damaged.max, q.damaged.max);
}

inline void expect_same_bits(const ContactOutcome& p, const ContactOutcome& q) {
  EXPECT_EQ(p.acts, q.acts);
  EXPECT_EQ(p.slides, q.slides);
  EXPECT_TRUE(same_bits(p.duration_s, q.duration_s));
  EXPECT_TRUE(same_bits(p.closing_mps, q.closing_mps));
  EXPECT_TRUE(same_bits(p.restitution, q.restitution));
  EXPECT_TRUE(same_bits(p.dissipated_j, q.dissipated_j));
  EXPECT_TRUE(same_bits(p.friction_j, q.friction_j));
  EXPECT_TRUE(same_bits(p.point_m, q.point_m));
  EXPECT_EQ(p.steps, q.steps);
  EXPECT_EQ(p.pieces, q.pieces);
}

/// Difference of the delta-v of A and of B, relative to the closing speed; the greater of the two.
inline double change(const ContactOutcome& p, const ContactOutcome& q, double closing) {
  return std::max((p.a.delta_v_mps - q.a.delta_v_mps).norm(),
                  (p.b.delta_v_mps - q.b.delta_v_mps).norm()) /
         closing;
}

inline void print_changes(const char* name, const std::vector<double>& changes) {
  std::printf(
      "%s, change of delta-v over closing speed in %zu contacts: p50 %.3g, p90 %.3g, "
      "p95 %.3g, p99 %.3g, most %.3g\n",
      name, changes.size(), percentile(changes, 0.5), percentile(changes, 0.9),
      percentile(changes, 0.95), percentile(changes, 0.99), percentile(changes, 1.0));
}

/// 41 closing speeds from 1 to 140 m/s, evenly spaced on a logarithmic scale.
inline std::vector<double> all_speeds() {
  constexpr int count = 40;
  std::vector<double> speeds;
  for (int i = 0; i <= count; ++i) speeds.push_back(std::pow(140.0, 1.0 * i / count));
  return speeds;
}

/// A body that drives forward, centred on the other body.
inline ContactScene full_frontal_hit(const Vehicle& a, const Vehicle& b, double speed) {
  ContactScene scene;
  scene.a = {&a, flat_pose(0, 0, 0), {{speed, 0, 0}, {0, 0, 0}}};
  scene.b = {&b, flat_pose(0, 0, 0), {}};
  EXPECT_TRUE(move_to_contact(scene, 0.001));
  return scene;
}

/// A wall along x = 0, 12 m wide, cut into `count` adjoining blocks.
inline std::vector<Vehicle> wall_in_blocks(int count, double thickness) {
  std::vector<Vehicle> blocks;
  const double width = 12.0 / count;
  for (int i = 0; i < count; ++i) {
    VehicleFacts facts;
    facts.kind = BodyKind::building;
    blocks.push_back(vehicle_from(block_mesh(thickness, width, 3.0), facts));
  }
  return blocks;
}

inline constexpr CrushLaw uniform_law{100e3, 1000e3, std::numeric_limits<double>::infinity()};

}  // namespace crashrank::test

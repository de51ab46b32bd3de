#include "crashrank/crash/contact_law.hpp"

#include "crash/contact_cases.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::Company;
using test::company;
using test::ContactDraw;
using test::ContactScene;
using test::percentile;
using test::Random;

ContactOutcome simulate(const ContactScene& scene, const ContactVariant& variant = {},
                        const ContactOptions& options = {}) {
  static ContactWorkspace workspace;
  return simulate_contact(scene.a, scene.b, {}, scene.point_m, variant, workspace, options);
}

/// Calls a test with random contacts of all pairs: number, draw, indices of the bodies, speed.
void for_random_contacts(
    std::uint64_t seed, int count,
    const std::function<void(int, const ContactDraw&, std::size_t, std::size_t, double)>& check) {
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  const auto movable = static_cast<std::uint32_t>(company().movable.size());
  const auto all = static_cast<std::uint32_t>(company().size());
  for (int i = 0; i < count; ++i) {
    const std::size_t a = random.below(movable);
    const std::size_t b = random.below(all);
    const double closing = std::exp(random.uniform(0.0, std::log(140.0)));
    const ContactDraw draw(random);
    SCOPED_TRACE("contact " + std::to_string(i) + " of " + company().movable[a].name + " and " +
                 company().any(b).name + " at " + std::to_string(closing) + " m/s");
    check(i, draw, a, b, closing);
    if (testing::Test::HasFatalFailure()) return;
  }
}

bool make_scene(const ContactDraw& draw, std::size_t a, std::size_t b, double closing,
                ContactScene& scene, double gap_m = 0.001) {
  const bool meets = make_contact(draw, company().movable[a].vehicle, company().any(b).vehicle,
                                  closing, gap_m, scene);
  if (meets) spin(draw, scene);
  return meets;
}

ContactVariant any_variant(int i) {
  constexpr std::array<ContactVariant, 4> variants{
      {{1, 1, 1}, {0.33, 0.7, 3.0}, {2.0, 1.4, 0.0}, {0.0, 1.0, 1.0}}};
  return variants[static_cast<std::size_t>(i) % variants.size()];
}

bool same_bits(double p, double q) {
  return std::bit_cast<std::uint64_t>(p) == std::bit_cast<std::uint64_t>(q);
}
bool same_bits(const Vector3d& p, const Vector3d& q) {
  return same_bits(p.x(), q.x()) && same_bits(p.y(), q.y()) && same_bits(p.z(), q.z());
}

void expect_same_bits(const BodyContact& p, const BodyContact& q) {
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

void expect_same_bits(const ContactOutcome& p, const ContactOutcome& q) {
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

TEST(ContactLaw, ExchangeOfTheBodiesChangesNoBit) {
  int acting = 0;
  for_random_contacts(
      101, 1000, [&](int i, const ContactDraw& draw, std::size_t a, std::size_t b, double closing) {
        ContactScene scene;
        if (!make_scene(draw, a, b, closing, scene)) return;
        const ContactOutcome plain = simulate(scene, any_variant(i));
        std::swap(scene.a, scene.b);
        const ContactOutcome exchanged = simulate(scene, any_variant(i));
        acting += plain.acts ? 1 : 0;
        expect_same_bits(plain, exchanged);
        expect_same_bits(plain.a, exchanged.b);
        expect_same_bits(plain.b, exchanged.a);
        ASSERT_FALSE(testing::Test::HasFailure());
      });
  EXPECT_GT(acting, 800);
}

TEST(ContactLaw, AWorkspaceKeepsNothingBetweenContacts) {
  ContactWorkspace used;
  for_random_contacts(
      102, 200, [&](int i, const ContactDraw& draw, std::size_t a, std::size_t b, double closing) {
        ContactScene scene;
        if (!make_scene(draw, a, b, closing, scene)) return;
        ContactWorkspace fresh;
        const ContactVariant variant = any_variant(i);
        const ContactOutcome first =
            simulate_contact(scene.a, scene.b, {}, scene.point_m, variant, fresh);
        const ContactOutcome again =
            simulate_contact(scene.a, scene.b, {}, scene.point_m, variant, used);
        expect_same_bits(first, again);
        expect_same_bits(first.a, again.a);
        expect_same_bits(first.b, again.b);
        ASSERT_FALSE(testing::Test::HasFailure());
      });
}

/// Shares of the closing speed by which delta-v of A and of B differ, the greater of the two.
double change(const ContactOutcome& p, const ContactOutcome& q, double closing) {
  return std::max((p.a.delta_v_mps - q.a.delta_v_mps).norm(),
                  (p.b.delta_v_mps - q.b.delta_v_mps).norm()) /
         closing;
}

void print_changes(const char* name, const std::vector<double>& changes) {
  std::printf(
      "%s, change of delta-v over closing speed in %zu contacts: p50 %.3g, p90 %.3g, "
      "p95 %.3g, p99 %.3g, most %.3g\n",
      name, changes.size(), percentile(changes, 0.5), percentile(changes, 0.9),
      percentile(changes, 0.95), percentile(changes, 0.99), percentile(changes, 1.0));
}

TEST(ContactLaw, TurningTheWorldTurnsTheOutcome) {
  std::vector<double> changes;
  for_random_contacts(
      103, 1500, [&](int i, const ContactDraw& draw, std::size_t a, std::size_t b, double closing) {
        ContactScene scene;
        if (!make_scene(draw, a, b, closing, scene)) return;
        const ContactOutcome before = simulate(scene);
        const Pose turn = test::flat_pose(0, 0, 0.1 + 0.37 * i);
        for (ContactBody* body : {&scene.a, &scene.b}) {
          body->pose = compose(turn, body->pose);
          body->velocity.linear_mps = turn.rotation * body->velocity.linear_mps;
        }
        scene.point_m = turn.rotation * scene.point_m;
        ContactOutcome after = simulate(scene);
        for (BodyContact* body : {&after.a, &after.b}) {
          body->delta_v_mps = turn.rotation.transpose() * body->delta_v_mps;
        }
        changes.push_back(change(before, after, closing));
      });
  print_changes("rotation", changes);
  EXPECT_LT(percentile(changes, 0.99), 1e-6);
}

/// The vehicle with its outlines mirrored at the plane y = 0, piece by piece.
Vehicle in_mirror(const Vehicle& v) {
  Vehicle m = v;
  Profile profile = *v.profile;
  for (OutlinePiece& piece : profile.pieces) {
    piece.y = -piece.y;
    piece.normal_y = -piece.normal_y;
  }
  m.center_m.y() = -v.center_m.y();
  m.profile = std::make_shared<const Profile>(std::move(profile));
  m.silhouettes = make_silhouettes(*m.profile);
  return m;
}

/// Changes of delta-v in a mirror whose bodies are given by index.
std::vector<double> mirror_changes(const std::function<const Vehicle*(std::size_t)>& mirrored) {
  std::vector<double> changes;
  for_random_contacts(
      104, 1500, [&](int, const ContactDraw& draw, std::size_t a, std::size_t b, double closing) {
        ContactScene scene;
        if (!make_scene(draw, a, b, closing, scene)) return;
        const ContactOutcome before = simulate(scene);
        const Matrix3d m = Vector3d(1, -1, 1).asDiagonal();
        scene.a.vehicle = mirrored(a);
        scene.b.vehicle = mirrored(b);
        for (ContactBody* body : {&scene.a, &scene.b}) {
          body->pose.rotation = m * body->pose.rotation * m;
          body->pose.translation = m * body->pose.translation;
          body->velocity.linear_mps = m * body->velocity.linear_mps;
          body->velocity.angular_radps *= -1.0;
        }
        scene.point_m = m * scene.point_m;
        ContactOutcome after = simulate(scene);
        for (BodyContact* body : {&after.a, &after.b}) body->delta_v_mps = m * body->delta_v_mps;
        changes.push_back(change(before, after, closing));
      });
  return changes;
}

TEST(ContactLaw, MirroredOutlinesMirrorTheOutcome) {
  std::vector<Vehicle> mirrored;
  for (std::size_t i = 0; i < company().size(); ++i) {
    mirrored.push_back(in_mirror(company().any(i).vehicle));
  }
  const std::vector<double> changes = mirror_changes([&](std::size_t i) { return &mirrored[i]; });
  print_changes("mirrored outlines", changes);
  EXPECT_LT(percentile(changes, 0.5), 0.001) << "the goal is 1e-6 in 99 % of contacts";
  EXPECT_LT(percentile(changes, 0.9), 0.025);
  EXPECT_LT(percentile(changes, 0.95), 0.1);
}

TEST(ContactLaw, MirroredMeshesMirrorTheOutcome) {
  const std::vector<double> changes =
      mirror_changes([](std::size_t i) { return &test::mirrored_company().any(i).vehicle; });
  print_changes("mirrored meshes", changes);
  EXPECT_LT(percentile(changes, 0.5), 0.005) << "the goal is 1e-6 in 99 % of contacts";
  EXPECT_LT(percentile(changes, 0.9), 0.07);
  EXPECT_LT(percentile(changes, 0.95), 0.16);
}

TEST(ContactLaw, MomentumAndMomentOfMomentumAreConserved) {
  std::vector<double> momentum;
  std::vector<double> moment;
  for_random_contacts(
      105, 2000, [&](int i, const ContactDraw& draw, std::size_t a, std::size_t b, double closing) {
        ContactScene scene;
        if (b >= company().movable.size() || !make_scene(draw, a, b, closing, scene)) return;
        const ContactOutcome r = simulate(scene, any_variant(i));
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
  std::printf("momentum off by at most %.3g, moment of momentum p50 %.3g, p90 %.3g, most %.3g\n",
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
        const ContactOutcome r = simulate(scene, any_variant(i));
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
  std::printf("energy after over energy before less 1: at most %.3g\n", most);
}

TEST(ContactLaw, WhatNothingMovesDoesNotMove) {
  for_random_contacts(
      107, 500, [&](int i, const ContactDraw& draw, std::size_t a, std::size_t b, double closing) {
        ContactScene scene;
        if (b < company().movable.size() || !make_scene(draw, a, b, closing, scene)) return;
        // A stated velocity of a body that nothing moves is not read.
        if (i % 2 == 0) scene.b.velocity.linear_mps = Vector3d(3, 4, 0);
        const ContactOutcome r = simulate(scene, any_variant(i));
        EXPECT_TRUE(r.b.delta_v_mps.isZero(0.0));
        EXPECT_TRUE(r.b.moved_m.isZero(0.0));
        EXPECT_EQ(r.b.turned_rad, 0.0);
        EXPECT_EQ(r.b.delta_yaw_rate_radps, 0.0);
        EXPECT_EQ(r.b.crush_energy_j, 0.0);
        EXPECT_EQ(r.b.crush_depth_m, 0.0);
        EXPECT_TRUE(Vector3d(r.b.impulse_ns + r.a.impulse_ns).isZero(0.0));
        ASSERT_FALSE(testing::Test::HasFailure());
      });
  const Vehicle& wall = company().fixed[0].vehicle;
  const Vehicle& post = company().fixed[4].vehicle;
  ContactScene scene;
  scene.a = {&post, test::flat_pose(-0.06, 0, 0), {{20, 0, 0}, {0, 0, 0}}};
  scene.b = {&wall, test::flat_pose(0, 0, 0), {}};
  EXPECT_FALSE(simulate(scene).acts);
}

/// Speeds of closing from 1 to 140 m/s.
std::vector<double> all_speeds() {
  constexpr int count = 40;
  std::vector<double> speeds;
  for (int i = 0; i <= count; ++i) speeds.push_back(std::pow(140.0, 1.0 * i / count));
  return speeds;
}

TEST(ContactLaw, FasterIsMilderInFewGeometries) {
  constexpr std::uint64_t seed = 108;
  constexpr int geometries = 12;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  const std::vector<double> speeds = all_speeds();
  std::vector<double> drops;
  std::vector<double> full;  // of contacts that at 10 m/s take most of the closing speed
  for (std::size_t a = 0; a < company().movable.size(); ++a) {
    for (std::size_t b = 0; b < company().size(); ++b) {
      for (int i = 0; i < geometries; ++i) {
        const ContactDraw draw(random);
        ContactScene scene;
        if (!make_contact(draw, company().movable[a].vehicle, company().any(b).vehicle, 1.0, 0.001,
                          scene)) {
          continue;
        }
        const Vector3d of_a = scene.a.velocity.linear_mps;
        const Vector3d of_b = scene.b.velocity.linear_mps;
        double top = 0.0;
        double drop = 0.0;
        for (const double speed : speeds) {
          scene.a.velocity.linear_mps = speed * of_a;
          scene.b.velocity.linear_mps = speed * of_b;
          const double delta_v = simulate(scene).a.delta_v_mps.norm();
          drop = std::max(drop, (top - delta_v) / std::max(top, 0.5));
          top = std::max(top, delta_v);
        }
        drops.push_back(drop);
        scene.a.velocity.linear_mps = 10.0 * of_a;
        scene.b.velocity.linear_mps = 10.0 * of_b;
        const ContactOutcome slow = simulate(scene);
        if ((slow.a.delta_v_mps - slow.b.delta_v_mps).norm() > 9.0) full.push_back(drop);
      }
    }
  }
  const auto share_over = [](const std::vector<double>& values, double limit) {
    double over = 0.0;
    for (const double value : values) over += value > limit ? 1.0 : 0.0;
    return over / static_cast<double>(values.size());
  };
  for (const auto* of : {&drops, &full}) {
    std::printf(
        "%zu %s: delta-v drops by over 2 %% in %.1f %%, over 5 %% in %.1f %%, over 10 %% in "
        "%.1f %%, at most by %.1f %%\n",
        of->size(), of == &drops ? "geometries" : "full hits", 100 * share_over(*of, 0.02),
        100 * share_over(*of, 0.05), 100 * share_over(*of, 0.1), 100 * percentile(*of, 1.0));
  }
  EXPECT_GT(full.size(), 150U);
  EXPECT_LE(share_over(drops, 0.02), 0.49);
  EXPECT_LE(share_over(drops, 0.05), 0.45) << "the goal is 8 %";
  EXPECT_LE(share_over(drops, 0.1), 0.37);
  EXPECT_LE(share_over(full, 0.02), 0.29);
  EXPECT_LE(share_over(full, 0.05), 0.25) << "the goal is 8 %";
  EXPECT_LE(share_over(full, 0.1), 0.22);
}

/// Driven forward, centred on the other body.
ContactScene square_hit(const Vehicle& a, const Vehicle& b, double speed) {
  ContactScene scene;
  scene.a = {&a, test::flat_pose(0, 0, 0), {{speed, 0, 0}, {0, 0, 0}}};
  scene.b = {&b, test::flat_pose(0, 0, 0), {}};
  EXPECT_TRUE(test::bring_together(scene, 0.001));
  return scene;
}

TEST(ContactLaw, SquareHitsTakeTheClosingSpeed) {
  for (const test::Cast& a : company().movable) {
    for (const std::size_t b : {0U, 2U, 3U, 4U, 5U}) {
      const test::Cast& obstacle = company().fixed[b];
      double least = 1e9;
      double most = 0.0;
      int outside = 0;
      for (const double speed : all_speeds()) {
        const ContactOutcome r = simulate(square_hit(a.vehicle, obstacle.vehicle, speed));
        const double share = r.a.delta_v_mps.norm() / speed;
        outside += share < 0.95 || share > 1.4 ? 1 : 0;
        least = std::min(least, share);
        most = std::max(most, share);
      }
      std::printf("%s into %s: delta-v %.3f to %.3f of the closing speed\n", a.name.c_str(),
                  obstacle.name.c_str(), least, most);
      if (b > 2) continue;
      // Of 41 speeds. People, who are thrown rather than pressed, do not reach the goal.
      const int allowed = a.name == "pedestrian" ? 20 : 0;
      EXPECT_LE(outside, allowed) << a.name << " into " << obstacle.name
                                  << ": delta-v outside 0.95 to 1.4 of the closing speed, the "
                                     "goal is at no speed";
    }
  }
}

/// A wall across x = 0, 12 m wide, in that many adjoining blocks.
std::vector<Vehicle> wall_in_blocks(int count, double thickness) {
  std::vector<Vehicle> blocks;
  const double width = 12.0 / count;
  for (int i = 0; i < count; ++i) {
    VehicleFacts facts;
    facts.kind = BodyKind::building;
    blocks.push_back(test::vehicle_from(test::block_mesh(thickness, width, 3.0), facts));
  }
  return blocks;
}

TEST(ContactLaw, AWallCutInBlocksActsAsOne) {
  constexpr std::uint64_t seed = 109;
  constexpr double thickness = 0.6;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  for (const int count : {2, 5, 20}) {
    const std::vector<Vehicle> whole = wall_in_blocks(1, thickness);
    const std::vector<Vehicle> cut = wall_in_blocks(count, thickness);
    const auto at = [&](const Vehicle& v, int i, int of) {
      return ContactBody{&v, test::flat_pose(0.5 * thickness, 12.0 * (0.5 + i) / of - 6.0, 0), {}};
    };
    Random random(seed);
    std::vector<double> changes;
    std::vector<double> crush;
    ContactWorkspace workspace;
    for (int i = 0; i < 60; ++i) {
      const test::Cast& car = company().movable[random.below(5)];
      const double course = random.uniform(-0.9, 0.9);
      const double yaw = course + random.uniform(-0.5, 0.5);
      const double y = random.uniform(-2, 2);
      const double speed = std::exp(random.uniform(0.0, std::log(100.0)));
      ContactScene scene;
      scene.a = {&car.vehicle,
                 test::flat_pose(0, y, yaw),
                 {{speed * std::cos(course), speed * std::sin(course), 0}, {0, 0, 0}}};
      scene.b = at(whole[0], 0, 1);
      ASSERT_TRUE(test::bring_together(scene, 0.001));
      const ContactOutcome one = simulate(scene);
      // The block that holds the point of first contact is met first.
      const int met = std::clamp(
          static_cast<int>(std::floor((scene.point_m.y() + 6.0) * count / 12.0)), 0, count - 1);
      std::vector<ContactBody> fixed;
      for (int k = 0; k < count; ++k) {
        const ContactBody block = at(cut[static_cast<std::size_t>(k)], k, count);
        if (k == met) {
          scene.b = block;
        } else {
          fixed.push_back(block);
        }
      }
      const ContactOutcome many =
          simulate_contact(scene.a, scene.b, fixed, scene.point_m, {}, workspace);
      const double delta_v = one.a.delta_v_mps.norm();
      ASSERT_TRUE(one.acts);
      changes.push_back((one.a.delta_v_mps - many.a.delta_v_mps).norm() / delta_v);
      crush.push_back(std::abs(one.a.crush_depth_m - many.a.crush_depth_m) /
                      std::max(0.01, one.a.crush_depth_m));
      std::swap(scene.a, scene.b);
      const ContactOutcome exchanged =
          simulate_contact(scene.a, scene.b, fixed, scene.point_m, {}, workspace);
      expect_same_bits(many.a, exchanged.b);
    }
    std::printf(
        "%d blocks: change of delta-v p50 %.3g, p95 %.3g, most %.3g, of crush depth most "
        "%.3g\n",
        count, percentile(changes, 0.5), percentile(changes, 0.95), percentile(changes, 1.0),
        percentile(crush, 1.0));
    EXPECT_LT(percentile(changes, 0.5), 0.01) << count << " blocks";
    EXPECT_LT(percentile(changes, 0.9), 0.07)
        << count << " blocks: the goal is 0.02 in all contacts";
  }
}

TEST(ContactLaw, ThicknessOfAWallChangesDeltaVLittle) {
  const Vehicle& sedan = company().movable[0].vehicle;
  const double speed = 15.6;
  std::vector<double> depths;
  std::vector<double> delta_v;
  for (const double thickness : {0.25, 0.6, 3.0}) {
    const std::vector<Vehicle> wall = wall_in_blocks(1, thickness);
    const ContactOutcome r = simulate(square_hit(sedan, wall[0], speed));
    depths.push_back(r.a.crush_depth_m);
    delta_v.push_back(r.a.delta_v_mps.norm());
    std::printf("wall of %.2f m: crush depth %.3f m, delta-v %.3f m/s\n", thickness,
                r.a.crush_depth_m, r.a.delta_v_mps.norm());
  }
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(delta_v[i], delta_v[2], 0.025 * delta_v[2]);
    EXPECT_NEAR(depths[i], depths[2], 0.3 * depths[2]) << "the goal is 0.02";
  }
}

TEST(ContactLaw, ShorterStepsChangeLittle) {
  std::vector<double> changes;
  for_random_contacts(
      110, 1500, [&](int, const ContactDraw& draw, std::size_t a, std::size_t b, double closing) {
        ContactScene scene;
        if (!make_scene(draw, a, b, closing, scene)) return;
        ContactOptions half;
        half.travel_m *= 0.5;
        half.shortest_s *= 0.5;
        half.longest_s *= 0.5;
        half.speed_change *= 0.5;
        changes.push_back(change(simulate(scene), simulate(scene, {}, half), closing));
      });
  print_changes("half the steps", changes);
  EXPECT_LT(percentile(changes, 0.5), 0.005);
  EXPECT_LT(percentile(changes, 0.95), 0.12) << "the goal is 0.02";
}

/// Cars and lorries against each other, walls, barriers and poles.
bool between_vehicles(std::size_t a, std::size_t b) {
  const std::size_t movable = company().movable.size();
  return a < 3 && (b < 3 || (b >= movable && b < movable + 3));
}

TEST(ContactLaw, AMillimetreAtTheStartChangesLittle) {
  std::vector<double> changes;
  std::vector<double> of_vehicles;
  for_random_contacts(
      111, 1500, [&](int, const ContactDraw& draw, std::size_t a, std::size_t b, double closing) {
        ContactScene near;
        ContactScene far;
        if (!make_scene(draw, a, b, closing, near, 0.001)) return;
        ASSERT_TRUE(make_scene(draw, a, b, closing, far, 0.002));
        changes.push_back(change(simulate(near), simulate(far), closing));
        if (between_vehicles(a, b)) of_vehicles.push_back(changes.back());
      });
  print_changes("1 mm along the path", changes);
  print_changes("1 mm along the path, vehicles", of_vehicles);
  EXPECT_LT(percentile(changes, 0.9), 0.02);
  EXPECT_LT(percentile(changes, 0.95), 0.035) << "the goal is 0.02";
  EXPECT_LT(percentile(of_vehicles, 0.95), 0.02);
}

TEST(ContactLaw, AMillimetreAsideChangesLittle) {
  std::vector<double> changes;
  std::vector<double> of_vehicles;
  for_random_contacts(
      112, 1500, [&](int, const ContactDraw& draw, std::size_t a, std::size_t b, double closing) {
        ContactScene scene;
        if (!make_scene(draw, a, b, closing, scene)) return;
        const ContactOutcome before = simulate(scene);
        const Vector3d aside(-std::sin(draw.course), std::cos(draw.course), 0);
        scene.a.pose.translation += 0.001 * aside;
        changes.push_back(change(before, simulate(scene), closing));
        if (between_vehicles(a, b)) of_vehicles.push_back(changes.back());
      });
  print_changes("1 mm aside", changes);
  print_changes("1 mm aside, vehicles", of_vehicles);
  EXPECT_LT(percentile(changes, 0.9), 0.02);
  EXPECT_LT(percentile(changes, 0.95), 0.035) << "the goal is 0.02";
  EXPECT_LT(percentile(of_vehicles, 0.95), 0.02);
}

constexpr CrushLaw even_law{100e3, 1000e3, std::numeric_limits<double>::infinity()};

TEST(ContactLaw, CrushOfAnEvenBlockFollowsItsEnergy) {
  constexpr double width = 1.8;
  constexpr double mass = 1500.0;
  const Vehicle block = test::even_block(4.0, width, 1.0, mass, even_law);
  const std::vector<Vehicle> wall = wall_in_blocks(1, 3.0);
  for (const double speed : {8.0, 12.0, 16.0, 20.0, 25.0}) {
    const ContactOutcome r = simulate(square_hit(block, wall[0], speed));
    // yield·C + slope·C²/2 = m·v²/(2·width)
    const double work = 0.5 * mass * speed * speed / width;
    const double y = even_law.yield_npm;
    const double s = even_law.slope_npm2;
    const double depth = (std::sqrt(y * y + 2.0 * s * work) - y) / s;
    std::printf("%.0f m/s: crush depth %.4f m, closed form %.4f m\n", speed, r.a.crush_depth_m,
                depth);
    EXPECT_NEAR(r.a.crush_depth_m, depth, 0.05 * depth) << speed << " m/s";
    EXPECT_NEAR(r.a.delta_v_mps.y(), 0.0, 1e-3 * speed);
    EXPECT_NEAR(r.a.delta_yaw_rate_radps, 0.0, 1e-3 * speed);
    EXPECT_NEAR(r.a.pdof_deg > 180.0 ? r.a.pdof_deg - 360.0 : r.a.pdof_deg, 0.0, 0.5);
  }
}

TEST(ContactLaw, EqualBlocksHeadOnShareEverything) {
  const Vehicle block = test::even_block(4.0, 1.8, 1.0, 1500.0, even_law);
  for (const double speed : {3.0, 10.0, 20.0}) {
    ContactScene scene;
    scene.a = {&block, test::flat_pose(0, 0, 0), {{speed, 0, 0}, {0, 0, 0}}};
    scene.b = {&block, test::flat_pose(0, 0, detail::pi), {{-speed, 0, 0}, {0, 0, 0}}};
    ASSERT_TRUE(test::bring_together(scene, 0.001));
    const ContactOutcome r = simulate(scene);
    EXPECT_NEAR(r.a.delta_v_mps.x(), -r.b.delta_v_mps.x(), 1e-12 * speed);
    EXPECT_NEAR(r.a.crush_depth_m, r.b.crush_depth_m, 0.01 * r.a.crush_depth_m);
    EXPECT_NEAR(r.a.crush_energy_j, r.b.crush_energy_j, 0.01 * r.a.crush_energy_j);
    // The reported restitution is the rebound's: delta-v = speed·(1 + e).
    EXPECT_GT(r.restitution, 0.05);
    EXPECT_NEAR(-r.a.delta_v_mps.x(), speed * (1.0 + r.restitution), 0.01 * speed);
    EXPECT_NEAR(r.dissipated_j, 1500.0 * speed * speed * (1.0 - r.restitution * r.restitution),
                0.02 * 1500.0 * speed * speed);
    const ContactOutcome dead = simulate(scene, {1, 1, 0});
    EXPECT_NEAR(-dead.a.delta_v_mps.x(), speed, 0.01 * speed);
    EXPECT_EQ(dead.restitution, 0.0);
  }
}

TEST(ContactLaw, OverlapAtTheStartProducesNoForce) {
  const Vehicle block = test::even_block(4.0, 1.8, 1.0, 1500.0, even_law);
  ContactScene scene;
  scene.a = {&block, test::flat_pose(0, 0, 0), {{1, 0.5, 0}, {0, 0, 0}}};
  // One inside the other, as deep as they go.
  const Vehicle large = test::even_block(12.0, 8.0, 1.0, 15000.0, even_law);
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
        const ContactOutcome r = simulate(scene, any_variant(i));
        // The longest that a contact is followed, and a step.
        EXPECT_LT(r.duration_s, 1.505);
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

TEST(ContactLaw, ConvexBodiesThatPartDoNotAct) {
  constexpr std::uint64_t seed = 114;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  const Vehicle block = test::even_block(4.0, 1.8, 1.0, 1500.0, even_law);
  const std::array<const Vehicle*, 3> others{&block, &company().fixed[0].vehicle,
                                             &company().fixed[4].vehicle};
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

TEST(ContactLaw, FrictionIsSymmetricInTheSurfaces) {
  constexpr std::array<Surface, 6> all{Surface::sheet_metal, Surface::steel,  Surface::concrete,
                                       Surface::wood,        Surface::rubber, Surface::person};
  for (const Surface a : all) {
    for (const Surface b : all) {
      EXPECT_EQ(friction_between(a, b), friction_between(b, a));
      EXPECT_GT(friction_between(a, b), 0.0);
      EXPECT_LT(friction_between(a, b), 1.0);
    }
  }
  EXPECT_EQ(friction_between(Surface::sheet_metal, Surface::sheet_metal), 0.3);
  EXPECT_EQ(friction_between(Surface::sheet_metal, Surface::concrete), 0.3);
  EXPECT_EQ(friction_between(Surface::sheet_metal, Surface::steel), 0.1);
}

TEST(ContactLaw, RestitutionFallsWithTheClosingSpeed) {
  double before = 1.0;
  for (const double speed : all_speeds()) {
    const double e = restitution_at(speed);
    EXPECT_GT(e, 0.0);
    EXPECT_LT(e, std::min(before, 0.5));
    before = e;
  }
}

TEST(ContactLaw, ASmoothFlankTakesOnlyTheSpeedAcross) {
  // Along a wall at a small angle: what is taken along the wall is at most the friction's share of
  // what is taken across.
  const Vehicle& sedan = company().movable[0].vehicle;
  VehicleFacts facts;
  facts.kind = BodyKind::building;
  const Vehicle wall = test::vehicle_from(test::block_mesh(3.0, 60.0, 3.0), facts);
  ContactScene scene;
  scene.a = {&sedan, test::flat_pose(0, 0, 1.4), {}};
  scene.a.velocity.linear_mps = 20.0 * Vector3d(std::cos(1.4), std::sin(1.4), 0);
  scene.b = {&wall, test::flat_pose(1.5, 0, 0), {}};
  ASSERT_TRUE(test::bring_together(scene, 0.001));
  for (const double factor : {0.0, 1.0}) {
    const ContactOutcome r = simulate(scene, {factor, 1, 1});
    std::printf(
        "along a wall at 10 degrees, friction times %.0f: delta-v across %.3f, along %.3f\n",
        factor, r.a.delta_v_mps.x(), r.a.delta_v_mps.y());
    ASSERT_TRUE(r.acts);
    EXPECT_TRUE(r.slides);
    EXPECT_LT(r.a.delta_v_mps.x(), -3.0);
    EXPECT_LE(std::abs(r.a.delta_v_mps.y()), (0.05 + factor * 0.3) * -r.a.delta_v_mps.x());
  }
}

}  // namespace
}  // namespace crashrank

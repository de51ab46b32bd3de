#include "crash/contact_checks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using Eigen::Vector3d;
using test::all_speeds;
using test::change;
using test::ContactDraw;
using test::ContactScene;
using test::expect_same_bits;
using test::for_random_contacts;
using test::full_frontal_hit;
using test::make_scene;
using test::percentile;
using test::print_changes;
using test::Random;
using test::simulate;
using test::test_bodies;
using test::wall_in_blocks;

TEST(ContactLaw, DeltaVRarelyFallsWithTheClosingSpeed) {
  constexpr std::uint64_t seed = 108;
  constexpr int geometries = 48;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  const std::vector<double> speeds = all_speeds();
  std::vector<double> drops;
  std::vector<double> full;  // contacts whose delta-v at 10 m/s is most of the closing speed
  for (std::size_t a = 0; a < test_bodies().movable.size(); ++a) {
    for (std::size_t b = 0; b < test_bodies().size(); ++b) {
      for (int i = 0; i < geometries; ++i) {
        const ContactDraw draw(random);
        ContactScene scene;
        if (!make_contact(draw, test_bodies().movable[a].vehicle, test_bodies().any(b).vehicle, 1.0,
                          0.001, scene)) {
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
        "%zu %s: delta-v falls at a higher speed by over 2 %% in %.1f %%, over 5 %% in %.1f %%, "
        "over 10 %% in "
        "%.1f %%, at most by %.1f %%\n",
        of->size(), of == &drops ? "geometries" : "full-overlap contacts",
        100 * share_over(*of, 0.02), 100 * share_over(*of, 0.05), 100 * share_over(*of, 0.1),
        100 * percentile(*of, 1.0));
  }
  EXPECT_GT(full.size(), 600U);
  EXPECT_LE(share_over(drops, 0.02), 0.30);
  EXPECT_LE(share_over(drops, 0.05), 0.26) << "the goal is 5 %";
  EXPECT_LE(share_over(drops, 0.1), 0.22) << "the goal is none";
  EXPECT_LE(share_over(full, 0.02), 0.14);
  EXPECT_LE(share_over(full, 0.05), 0.11) << "the goal is none";
  EXPECT_LE(share_over(full, 0.1), 0.08) << "the goal is none";
}

TEST(ContactLaw, WallCutIntoBlocksActsAsOneWall) {
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
      const test::NamedBody& car = test_bodies().movable[random.below(5)];
      const double course = random.uniform(-0.9, 0.9);
      const double yaw = course + random.uniform(-0.5, 0.5);
      const double y = random.uniform(-2, 2);
      const double speed = std::exp(random.uniform(0.0, std::log(100.0)));
      ContactScene scene;
      scene.a = {&car.vehicle,
                 test::flat_pose(0, y, yaw),
                 {{speed * std::cos(course), speed * std::sin(course), 0}, {0, 0, 0}}};
      scene.b = at(whole[0], 0, 1);
      ASSERT_TRUE(test::move_to_contact(scene, 0.001));
      const ContactOutcome one = simulate(scene);
      // The block with the point of first contact is the second body.
      const int hit_block = std::clamp(
          static_cast<int>(std::floor((scene.point_m.y() + 6.0) * count / 12.0)), 0, count - 1);
      std::vector<ContactBody> fixed;
      for (int k = 0; k < count; ++k) {
        const ContactBody block = at(cut[static_cast<std::size_t>(k)], k, count);
        if (k == hit_block) {
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
    EXPECT_LT(percentile(changes, 0.5), 0.010) << count << " blocks";
    EXPECT_LT(percentile(changes, 0.9), 0.05)
        << count << " blocks: the goal is 0.02 in all contacts";
  }
}

TEST(ContactLaw, ThicknessOfAWallChangesDeltaVLittle) {
  const Vehicle& sedan = test_bodies().movable[0].vehicle;
  const double speed = 15.6;
  std::vector<double> depths;
  std::vector<double> delta_v;
  for (const double thickness : {0.25, 0.6, 3.0}) {
    const std::vector<Vehicle> wall = wall_in_blocks(1, thickness);
    const ContactOutcome r = simulate(full_frontal_hit(sedan, wall[0], speed));
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
  EXPECT_LT(percentile(changes, 0.95), 0.10) << "the goal is 0.02";
}

/// Returns true for contacts of cars and lorries with each other, walls, barriers and poles.
bool between_vehicles(std::size_t a, std::size_t b) {
  const std::size_t movable = test_bodies().movable.size();
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

}  // namespace
}  // namespace crashrank

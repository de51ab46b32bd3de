#include "crashrank/crash/contact_law.hpp"

#include "crash/contact_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>

namespace crashrank {
namespace {

using Eigen::Vector3d;
using test::ContactDraw;
using test::ContactScene;
using test::Random;
using test::test_bodies;

bool same_pose(const Pose& p, const Pose& q) {
  return p.rotation == q.rotation && p.translation == q.translation;
}

/// Calls a check with the outcome of random contacts of the test bodies.
template <class Check> void for_random_outcomes(std::uint64_t seed, int count, Check&& check) {
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  ContactWorkspace workspace;
  for (int i = 0; i < count; ++i) {
    const std::size_t a = random.below(static_cast<std::uint32_t>(test_bodies().movable.size()));
    const std::size_t b = random.below(static_cast<std::uint32_t>(test_bodies().size()));
    const double closing = std::exp(random.uniform(0.0, std::log(140.0)));
    const ContactDraw draw(random);
    SCOPED_TRACE("contact " + std::to_string(i) + " of " + test_bodies().movable[a].name + " and " +
                 test_bodies().any(b).name + " at " + std::to_string(closing) + " m/s");
    ContactScene scene;
    if (!test::make_contact(draw, test_bodies().movable[a].vehicle, test_bodies().any(b).vehicle,
                            closing, 0.001, scene)) {
      continue;
    }
    test::spin(draw, scene);
    check(scene, simulate_contact(scene.a, scene.b, {}, scene.point_m, {}, workspace), workspace);
    if (testing::Test::HasFailure()) return;
  }
}

// The first and last poses agree with the outcome: the given poses, and centres of mass and
// headings changed by `moved_m` and `turned_rad`.
TEST(ContactMotion, BeginsAtFirstContactAndEndsWithTheForce) {
  int acting = 0;
  std::size_t most = 0;
  for_random_outcomes(301, 600, [&](const ContactScene& scene, const ContactOutcome& r, auto&) {
    const View<const ContactPoses> poses = r.motion.all();
    ASSERT_GE(poses.size(), 1U);
    ASSERT_LE(poses.size(), ContactMotion::most);
    most = std::max(most, poses.size());
    EXPECT_EQ(poses[0].time_s, 0.0);
    EXPECT_TRUE(same_pose(poses[0].a, scene.a.pose));
    EXPECT_TRUE(same_pose(poses[0].b, scene.b.pose));
    EXPECT_EQ(poses.size() > 1, r.acts);
    if (!r.acts) return;
    ++acting;
    EXPECT_EQ(poses[poses.size() - 1].time_s, r.duration_s);
    for (std::size_t i = 1; i < poses.size(); ++i) {
      EXPECT_GT(poses[i].time_s, poses[i - 1].time_s);
    }
    const auto ends = [&](const ContactBody& given, const Pose& last, const BodyContact& contact) {
      EXPECT_LT((last.rotation.transpose() * last.rotation - Eigen::Matrix3d::Identity()).norm(),
                1e-12);
      const Vector3d before = given.pose.rotation * given.vehicle->center_m;
      const Vector3d after = last.rotation * given.vehicle->center_m;
      const Vector3d moved = last.translation + after - given.pose.translation - before;
      EXPECT_LT((moved - contact.moved_m).norm(), 1e-9);
      // The rotation of a step differs from the angle that the integration adds up by (w·t)³/12.
      const double turned = std::atan2(before.x() * after.y() - before.y() * after.x(),
                                       before.x() * after.x() + before.y() * after.y());
      if (before.head<2>().norm() > 1e-3 && std::abs(contact.turned_rad) < 3.0) {
        EXPECT_NEAR(turned, contact.turned_rad, 1e-4 + 0.01 * std::abs(contact.turned_rad));
      }
    };
    ends(scene.a, poses[poses.size() - 1].a, r.a);
    ends(scene.b, poses[poses.size() - 1].b, r.b);
  });
  EXPECT_GT(acting, 400);
  EXPECT_EQ(most, ContactMotion::most);
}

TEST(ContactMotion, ExchangeOfTheBodiesExchangesThePoses) {
  for_random_outcomes(302, 300,
                      [](ContactScene scene, const ContactOutcome& r, ContactWorkspace& workspace) {
                        std::swap(scene.a, scene.b);
                        const ContactOutcome q =
                            simulate_contact(scene.a, scene.b, {}, scene.point_m, {}, workspace);
                        ASSERT_EQ(r.motion.count, q.motion.count);
                        for (std::size_t i = 0; i < r.motion.count; ++i) {
                          EXPECT_EQ(r.motion.poses[i].time_s, q.motion.poses[i].time_s);
                          EXPECT_TRUE(same_pose(r.motion.poses[i].a, q.motion.poses[i].b));
                          EXPECT_TRUE(same_pose(r.motion.poses[i].b, q.motion.poses[i].a));
                        }
                      });
}

// The entries are spread over the contact, so that the deepest of them is close to the crush depth
// of the outcome.
TEST(ContactMotion, DeepestPoseOfAUniformBlockIsItsCrushDepth) {
  constexpr CrushLaw law{100e3, 1000e3, std::numeric_limits<double>::infinity()};
  constexpr double half_length = 2.0;
  const Vehicle block = test::uniform_block(2.0 * half_length, 1.8, 1.0, 1500.0, law);
  VehicleFacts facts;
  facts.kind = BodyKind::building;
  Vehicle wall = test::vehicle_from(test::block_mesh(1.0, 10.0, 2.0), facts);
  wall.strength.rigid = true;
  ContactWorkspace workspace;
  double before = 0.0;
  for (const double speed : {3.0, 8.0, 15.0, 25.0, 40.0}) {
    ContactScene scene;
    scene.a = {&block, test::flat_pose(0, 0, 0), {{speed, 0, 0}, {0, 0, 0}}};
    scene.b = {&wall, test::flat_pose(10, 0, 0), {}};
    ASSERT_TRUE(test::move_to_contact(scene, 0.001));
    const ContactOutcome r = simulate_contact(scene.a, scene.b, {}, scene.point_m, {}, workspace);
    double deepest = 0.0;
    for (const ContactPoses& poses : r.motion.all()) {
      deepest = std::max(deepest, poses.a.translation.x() + half_length - 9.5);
    }
    std::printf("%.0f m/s: deepest pose %.4f m, crush depth %.4f m, %zu poses\n", speed, deepest,
                r.a.crush_depth_m, r.motion.count);
    EXPECT_NEAR(deepest, r.a.crush_depth_m, 0.02 + 0.02 * r.a.crush_depth_m);
    EXPECT_GT(deepest, before);
    before = deepest;
  }
}

}  // namespace
}  // namespace crashrank

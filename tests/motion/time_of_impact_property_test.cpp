#include "crashrank/tree/build.hpp"
#include "motion/impact_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

namespace crashrank {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;
using test::box_mesh;
using test::moving;
using test::Random;
using test::sphere_mesh;
using test::tolerance;
using test::tree_of;

class TimeOfImpactProperty : public test::TimeOfImpact {};

// A motion of some kind near the origin.
Motion any_motion(Random& random, double distance) {
  const Pose start = [&] {
    Pose pose = random.pose(1);
    pose.translation = distance * random.vector(1);
    return pose;
  }();
  switch (random.below(4)) {
    case 0: {
      const Vector3d v = -start.translation * random.uniform(0.3, 2) + random.vector(1);
      return moving(start, v, random.vector(8));
    }
    case 1: {
      const double yaw = random.uniform(-pi, pi);
      return TurnMotion{pose_from_angles(start.translation, yaw, 0, 0), random.uniform(0, 12),
                        random.uniform(-4, 4), random.uniform(-8, 2)};
    }
    case 2: {
      const double yaw = random.uniform(-pi, pi);
      return ArcMotion{pose_from_angles(start.translation, yaw, 0, 0), random.uniform(0, 12),
                       random.uniform(-0.4, 0.4), random.uniform(-8, 2)};
    }
    default: {
      std::vector<TimedPose> poses;
      double t = random.uniform(0, 0.3);
      for (int i = 0; i < 6; ++i) {
        Pose pose = random.pose(1);
        pose.translation *= distance;
        poses.push_back({t, pose});
        t += random.uniform(0.05, 0.6);
      }
      return *Motion::timed(poses);
    }
  }
}

// Independent of the search: many instants, each answered by the exact collider or the distance.
TEST_F(TimeOfImpactProperty, NoSampledInstantContradictsTheAnswer) {
  constexpr std::uint64_t seed = 77;
  constexpr double until = 2.0;
  Random random(seed);
  std::vector<Pair> pairs;
  CollideWorkspace collide_workspace;
  DistanceWorkspace distance_workspace;
  const TriangleMesh meshes[] = {box_mesh({1.2, 0.5, 0.4}, {0.5, 0, 0.2}, 2), sphere_mesh(0.7, 6),
                                 test::sheet_mesh(0.8, 0.5), box_mesh({1.5, 0.02, 0.02})};
  const BuildOptions builds[] = {
      {}, {SplitRule::sah, BoxFrame::gaussian, 2}, {SplitRule::paper, BoxFrame::world, 1}};
  int seen[6] = {};
  for (int i = 0; i < 1000; ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", case " + std::to_string(i));
    const AabbTree a = tree_of(meshes[random.below(4)], builds[random.below(3)]);
    const AabbTree b = tree_of(meshes[random.below(4)], builds[random.below(3)]);
    const Motion ma = any_motion(random, 4);
    const Motion mb = any_motion(random, 4);
    const Impact impact = find(a, ma, b, mb, 0, until);
    ++seen[static_cast<int>(impact.state)];
    ASSERT_NE(impact.state, ImpactState::undecided);
    const auto touching = [&](double t) {
      return collide(a, b, relative(ma.pose_at(t), mb.pose_at(t)), pairs, collide_workspace)
          .intersecting;
    };
    const bool at_start =
        impact.state == ImpactState::overlapping || impact.state == ImpactState::contained;
    ASSERT_EQ(impact.state == ImpactState::overlapping, touching(0));
    if (at_start) continue;
    constexpr int samples = 400;
    for (int k = 0; k < samples; ++k) {
      const double t = impact.time_s * k / samples;
      ASSERT_FALSE(touching(t)) << "told " << impact.time_s << ", touching at " << t;
    }
    // Nearer to the answer, more finely: nothing is within the tolerance either.
    for (int k = 0; k < 60 && !impact.grazed; ++k) {
      const double t = impact.time_s * (1.0 - std::exp2(-0.5 * k)) - 1e-7;
      if (t < 0) continue;
      const DistanceResult gap =
          distance(a, b, relative(ma.pose_at(t), mb.pose_at(t)), distance_workspace);
      ASSERT_GT(gap.upper_m, tolerance * (1 - 2e-3)) << "told " << impact.time_s << ", at " << t;
    }
    if (impact.state == ImpactState::none) continue;
    const DistanceResult met = distance(
        a, b, relative(ma.pose_at(impact.time_s), mb.pose_at(impact.time_s)), distance_workspace);
    ASSERT_LE(met.distance_m, tolerance);
    ASSERT_NEAR((impact.point_a_m - impact.point_b_m).norm(), impact.gap_m, 1e-9);
  }
  // The property is worth something only where all of it happens.
  EXPECT_GT(seen[static_cast<int>(ImpactState::none)], 100);
  EXPECT_GT(seen[static_cast<int>(ImpactState::contact)], 120);
  EXPECT_GT(seen[static_cast<int>(ImpactState::overlapping)], 10);
}

// What is told to touch does: sampled so finely around the answer that the collider sees it.
TEST_F(TimeOfImpactProperty, AContactIsFollowedByIntersection) {
  constexpr std::uint64_t seed = 78;
  Random random(seed);
  std::vector<Pair> pairs;
  const AabbTree a = tree_of(box_mesh({1.2, 0.5, 0.4}, {0.5, 0, 0.2}, 2));
  const AabbTree b = tree_of(sphere_mesh(0.7, 6));
  int contacts = 0;
  for (int i = 0; i < 300; ++i) {
    const Motion ma = any_motion(random, 4);
    const Motion mb = any_motion(random, 4);
    const Impact impact = find(a, ma, b, mb, 0, 2);
    if (impact.state != ImpactState::contact) continue;
    ++contacts;
    bool met = false;
    for (int k = 0; k < 4000 && !met; ++k) {
      const double t = impact.time_s + 1e-7 * std::exp2(k * 0.006);
      met = collide(a, b, relative(ma.pose_at(t), mb.pose_at(t)), pairs).intersecting;
    }
    EXPECT_TRUE(met) << "seed " << seed << ", case " << i;
  }
  EXPECT_GT(contacts, 60);
}

}  // namespace
}  // namespace crashrank

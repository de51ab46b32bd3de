#include "crashrank/motion/time_of_impact.hpp"

#include "motion/impact_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

namespace crashrank {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;
using test::box_mesh;
using test::moving;
using test::Random;
using test::sphere_mesh;
using test::TimeOfImpact;
using test::tolerance;
using test::tree_of;

Pose at(double x, double y, double z) {
  Pose pose;
  pose.translation = Vector3d(x, y, z);
  return pose;
}

double gap_at(const AabbTree& a, const Motion& ma, const AabbTree& b, const Motion& mb, double t) {
  DistanceWorkspace workspace;
  return distance(a, b, relative(ma.pose_at(t), mb.pose_at(t)), workspace).upper_m;
}

TEST_F(TimeOfImpact, BoxesMeetHeadOnWhenTheirGapIsUsedUp) {
  const AabbTree box = tree_of(box_mesh({2, 1, 0.5}));
  const Motion left = moving(at(-10, 0, 0), {12, 0, 0});
  const Motion right = moving(at(14, 0.3, 0), {-8, 0, 0});
  const Impact impact = find(box, left, box, right, 0, 5);
  EXPECT_EQ(impact.state, ImpactState::contact);
  // 24 m between origins less two half lengths, at 20 m/s, less the tolerance.
  EXPECT_NEAR(impact.time_s, (20.0 - tolerance) / 20.0, 1e-8);
  EXPECT_LE(impact.time_s, 1.0);
  EXPECT_LE(impact.gap_m, tolerance);
  EXPECT_NEAR(impact.normal.x(), 1.0, 1e-9);
  EXPECT_NEAR(impact.point_a_m.x(), 4.0, 1e-3);
  EXPECT_FALSE(impact.grazed);
  EXPECT_TRUE(impact.hit());
}

TEST_F(TimeOfImpact, BallsMeetPoleToPole) {
  const AabbTree ball = tree_of(sphere_mesh(0.5, 24));
  const Motion low = moving(at(3, 2, 0), {0, 0, 5});
  const Motion high = moving(at(3, 2, 6), {0, 0, 0});
  const Impact impact = find(ball, low, ball, high, 0, 5);
  EXPECT_EQ(impact.state, ImpactState::contact);
  EXPECT_NEAR(impact.time_s, (5.0 - tolerance) / 5.0, 1e-7);
}

TEST_F(TimeOfImpact, BrakingStopsShortOrDoesNot) {
  const AabbTree box = tree_of(box_mesh({2, 1, 0.5}));
  const Motion wall = Motion::at_rest(at(24.01, 0, 0));
  // 20 m/s and 10 m/s² stop after 20 m, 1 cm before the wall; from 9 m/s² it is 22.2 m.
  const Motion stops = TurnMotion{at(0, 0, 0), 20, 0, -10};
  EXPECT_EQ(find(box, stops, box, wall, 0, 10).state, ImpactState::none);
  EXPECT_EQ(find(box, stops, box, wall, 0, 10).time_s, 10.0);
  const Motion late = TurnMotion{at(0, 0, 0), 20, 0, -9};
  const Impact impact = find(box, late, box, wall, 0, 10);
  const double s = 20.01 - tolerance;
  EXPECT_EQ(impact.state, ImpactState::contact);
  EXPECT_NEAR(impact.time_s, (20 - std::sqrt(400 - 18 * s)) / 9, 1e-7);
}

TEST_F(TimeOfImpact, ABulletDoesNotPassThroughPaper) {
  const AabbTree sheet = tree_of(test::sheet_mesh(0.1, 0.1));
  const AabbTree bullet = tree_of(sphere_mesh(0.004, 8));
  const Motion rest = Motion::at_rest(at(50, 0, 0));
  for (const double speed : {10.0, 900.0, 30000.0}) {
    const Motion fast = moving(at(0, 0.01, 0.02), {speed, 0, 0});
    const Impact impact = find(sheet, rest, bullet, fast, 0, 10);
    ASSERT_EQ(impact.state, ImpactState::contact) << speed;
    EXPECT_NEAR(impact.time_s * speed, 50 - 0.004 - tolerance, 1e-6) << speed;
    // Two sheets without any thickness, moving along their normal.
    const Impact sheets = find(sheet, rest, sheet, moving(at(0, 0, 0), {speed, 0, 0}), 0, 10);
    ASSERT_EQ(sheets.state, ImpactState::contact) << speed;
    EXPECT_NEAR(sheets.time_s * speed, 50 - tolerance, 1e-6) << speed;
  }
}

TEST_F(TimeOfImpact, ASpinningBarMeetsAPinAtItsAngle) {
  const AabbTree bar = tree_of(box_mesh({2, 0.05, 0.05}));
  const AabbTree pin = tree_of(box_mesh({0.01, 0.01, 1}));
  const double angle = 1.9;
  const Vector3d place = 1.5 * Vector3d(std::cos(angle), std::sin(angle), 0);
  const Pose pin_pose = pose_from_angles(place, angle, 0, 0);
  for (const double rate : {0.5, 8.0, 200.0}) {
    const Motion spin = TurnMotion{at(0, 0, 0), 0, rate, 0};
    const Impact impact = find(bar, spin, pin, Motion::at_rest(pin_pose), 0, 7 / rate);
    ASSERT_EQ(impact.state, ImpactState::contact);
    // The bar's long side, 0.05 m off its axis, comes up against the pin's corner that is nearest
    // to it and furthest in, at radial distance 1.49 and 0.01 m before the pin's axis.
    EXPECT_GT(impact.time_s * rate, angle - 0.045) << rate;
    const double corner = std::atan2(-0.01, 1.49);
    const double expected = angle + corner - std::asin((0.05 + tolerance) / std::hypot(1.49, 0.01));
    EXPECT_NEAR(impact.time_s * rate, expected, 1e-6) << rate;
    // The other way round the other end of the bar meets it.
    const Motion back = TurnMotion{at(0, 0, 0), 0, -rate, 0};
    const Impact other = find(bar, back, pin, Motion::at_rest(pin_pose), 0, 7 / rate);
    EXPECT_NEAR(other.time_s * rate,
                pi - (angle + std::atan2(0.01, 1.49)) -
                    std::asin((0.05 + tolerance) / std::hypot(1.49, 0.01)),
                1e-6);
  }
}

TEST_F(TimeOfImpact, PassesWithinTheToleranceAreGrazing) {
  const AabbTree box = tree_of(box_mesh({1, 1, 1}));
  const Motion rest = Motion::at_rest(at(0, 0, 0));
  const auto pass = [&](double clearance) {
    return find(box, rest, box, moving(at(-20, 2 + clearance, 0.3), {15, 0, 0}), 0, 4);
  };
  const Impact near = pass(0.05e-3);
  EXPECT_EQ(near.state, ImpactState::grazing);
  EXPECT_FALSE(near.hit());
  EXPECT_NEAR(near.gap_m, 0.05e-3, 0.0501e-3);
  EXPECT_NEAR(near.time_s * 15, 18, 1e-3);
  EXPECT_EQ(pass(0.2e-3).state, ImpactState::none);
  EXPECT_EQ(pass(-0.05e-3).state, ImpactState::contact);
  EXPECT_EQ(pass(0.098e-3).state, ImpactState::grazing);
  EXPECT_EQ(pass(0.102e-3).state, ImpactState::none);
}

TEST_F(TimeOfImpact, CurvedSurfacesGrazeToo) {
  const AabbTree ball = tree_of(sphere_mesh(1.0, 32));
  const Motion rest = Motion::at_rest(at(0, 0, 0));
  // Over the pole, where the mesh has its exact radius.
  const auto pass = [&](double clearance) {
    return find(ball, rest, ball, moving(at(-9, 0, 2 + clearance), {3, 0, 0}), 0, 6);
  };
  EXPECT_EQ(pass(0.05e-3).state, ImpactState::grazing);
  EXPECT_EQ(pass(0.2e-3).state, ImpactState::none);
  EXPECT_EQ(pass(-0.05e-3).state, ImpactState::contact);
}

TEST_F(TimeOfImpact, AGrazeBeforeAContactIsTold) {
  const AabbTree box = tree_of(box_mesh({1, 1, 1}));
  TriangleMesh two = box_mesh({1, 1, 1}, {0, 0, 0});
  const TriangleMesh wall = box_mesh({1, 4, 1}, {30, 0, 0});
  const auto first = static_cast<std::uint32_t>(two.vertices.size());
  two.vertices.insert(two.vertices.end(), wall.vertices.begin(), wall.vertices.end());
  for (const auto& t : wall.triangles) {
    two.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  const AabbTree scene = tree_of(two);
  const Motion rest = Motion::at_rest(at(0, 0, 0));
  const Impact impact = find(scene, rest, box, moving(at(-10, 2.00005, 0), {10, 0, 0}), 0, 10);
  EXPECT_EQ(impact.state, ImpactState::contact);
  EXPECT_TRUE(impact.grazed);
  EXPECT_NEAR(impact.graze_time_s, 0.8, 1e-3);
  EXPECT_NEAR(impact.time_s, 3.8, 1e-5);
}

TEST_F(TimeOfImpact, OverlapAndContainmentAtTheStart) {
  const AabbTree big = tree_of(box_mesh({2, 2, 2}));
  const AabbTree small = tree_of(sphere_mesh(0.3, 8));
  const Motion rest = Motion::at_rest(at(5, 5, 5));
  const auto start = [&](const AabbTree& a, const Motion& ma, const AabbTree& b, double x) {
    return find(a, ma, b, moving(at(5 + x, 5, 5), {1, 0, 0}), 0.5, 3);
  };
  const Impact crossing = start(big, rest, small, 1.4);
  EXPECT_EQ(crossing.state, ImpactState::overlapping);
  EXPECT_EQ(crossing.time_s, 0.5);
  EXPECT_GE(crossing.triangle_a, 0);
  EXPECT_NEAR(crossing.point_a_m.x(), 7.0, 1e-6);
  const Impact inside = start(big, rest, small, 0.0);
  EXPECT_EQ(inside.state, ImpactState::contained);
  EXPECT_EQ(inside.time_s, 0.5);
  EXPECT_TRUE(inside.hit());
  EXPECT_EQ(find(small, rest, big, moving(at(5, 5, 5), {1, 0, 0}), 0, 1).state,
            ImpactState::contained);
  EXPECT_EQ(start(big, rest, small, 2.5).state, ImpactState::none);
  EXPECT_EQ(initial_state(big, at(0, 0, 0), small, at(0.1, 0, 0), workspace_).state,
            ImpactState::contained);
  EXPECT_EQ(initial_state(big, at(0, 0, 0), small, at(2.30005, 0, 0), workspace_).state,
            ImpactState::grazing);
  EXPECT_EQ(initial_state(big, at(0, 0, 0), small, at(2.3002, 0, 0), workspace_).state,
            ImpactState::none);
}

TEST_F(TimeOfImpact, StandingNextToEachOtherIsGrazingUntilTheyTouch) {
  const AabbTree box = tree_of(box_mesh({1, 1, 1}));
  const Motion rest = Motion::at_rest(at(0, 0, 0));
  EXPECT_EQ(initial_state(box, at(0, 0, 0), box, at(2.00005, 0, 0), workspace_).state,
            ImpactState::grazing);
  const Impact stays = find(box, rest, box, Motion::at_rest(at(2.00005, 0, 0)), 0, 3);
  EXPECT_EQ(stays.state, ImpactState::grazing);
  EXPECT_EQ(stays.time_s, 0.0);
  EXPECT_EQ(find(box, rest, box, moving(at(2.00005, 0, 0), {1, 0, 0}), 0, 3).state,
            ImpactState::grazing);
  const Impact closes = find(box, rest, box, moving(at(2.00005, 0, 0), {-0.001, 0, 0}), 0, 3);
  EXPECT_EQ(closes.state, ImpactState::contact);
  EXPECT_EQ(closes.time_s, 0.0);
}

TEST_F(TimeOfImpact, TheStepLimitGivesAProvedAnswer) {
  const AabbTree ball = tree_of(sphere_mesh(1, 32));
  const Motion ma = moving(at(-8, 0.2, 0.1), {5, 0, 0}, {0.3, 0.2, 0.1});
  const Motion mb = moving(at(8, 0, 0), {-5, 0, 0});
  const Impact full = find(ball, ma, ball, mb, 0, 4);
  ASSERT_EQ(full.state, ImpactState::contact);
  int undecided = 0;
  for (std::uint64_t steps = 0; steps < 400; steps += 7) {
    ImpactOptions options;
    options.max_steps = steps;
    const Impact impact = find(ball, ma, ball, mb, 0, 4, options);
    if (impact.state == ImpactState::undecided) {
      ++undecided;
      EXPECT_LE(impact.time_s, full.time_s + 1e-9);
      EXPECT_GE(impact.time_s, 0.0);
    } else {
      EXPECT_EQ(impact.time_s, full.time_s);
    }
  }
  EXPECT_GT(undecided, 0);
}

/// The same way in one piece and in timed poses, the last one just before the end.
TEST_F(TimeOfImpact, KinksAnywhereCostNoPairsOfTriangles) {
  const AabbTree ball = tree_of(sphere_mesh(1, 32));
  for (const double aside_m : {2.3, 1.9}) {
    const Motion past = moving(at(-20, aside_m, 0), {10, 0, 0});
    const Motion rest = moving(at(0, 0, 0), {0, 0, 0});
    const Impact plain = find(ball, past, ball, rest, 0, 4);
    for (const std::size_t count : {2U, 3U, 41U, 1000U, 4000U}) {
      SCOPED_TRACE(std::to_string(count) + " poses, " + std::to_string(aside_m) + " m aside");
      std::vector<TimedPose> poses;
      for (std::size_t i = 0; i < count; ++i) {
        const double t = 3.99 * static_cast<double>(i) / static_cast<double>(count - 1);
        poses.push_back({t, at(-20 + 10 * t, aside_m, 0)});
      }
      const Result<Motion> timed = Motion::timed(poses);
      ASSERT_TRUE(timed.ok());
      const Impact impact = find(ball, *timed, ball, rest, 0, 4);
      EXPECT_EQ(impact.state, plain.state);
      EXPECT_NEAR(impact.time_s, plain.time_s, 1e-9);
      EXPECT_LE(impact.work.primitive_tests, 3 * plain.work.primitive_tests + 100 + count);
      EXPECT_LE(impact.work.bv_tests, 3 * plain.work.bv_tests + 16 * count);
    }
  }
}

TEST_F(TimeOfImpact, MirrorImagesMeetAtTheSameTime) {
  constexpr std::uint64_t seed = 31;
  Random random(seed);
  const TriangleMesh car = box_mesh({2.2, 0.9, 0.7}, {1.3, 0.1, 0.7}, 3);
  const TriangleMesh post = sphere_mesh(0.6, 6, {0.1, 0.2, 0.5});
  const AabbTree a = tree_of(car);
  const AabbTree b = tree_of(post);
  const AabbTree a_mirror = tree_of(test::mirrored(car));
  const AabbTree b_mirror = tree_of(test::mirrored(post));
  int hits = 0;
  for (int i = 0; i < 200; ++i) {
    const Vector3d place(random.uniform(-20, 20), random.uniform(-20, 20), 0);
    const double heading = random.uniform(-pi, pi);
    const double speed = random.uniform(5, 20);
    const double curvature = random.uniform(-0.1, 0.1);
    const Motion ma = ArcMotion{pose_from_angles(place, heading, 0, 0), speed, curvature, -1};
    const Motion ma_mirror = ArcMotion{pose_from_angles({place.x(), -place.y(), 0}, -heading, 0, 0),
                                       speed, -curvature, -1};
    const Motion mb = Motion::at_rest(at(0, 0.5, 0));
    const Motion mb_mirror = Motion::at_rest(at(0, -0.5, 0));
    const Impact one = find(a, ma, b, mb, 0, 4);
    const Impact two = find(a_mirror, ma_mirror, b_mirror, mb_mirror, 0, 4);
    ASSERT_EQ(one.state, two.state) << "seed " << seed << ", case " << i;
    ASSERT_NEAR(one.time_s, two.time_s, 1e-6) << i;
    hits += one.state == ImpactState::contact ? 1 : 0;
  }
  EXPECT_GT(hits, 10);
}

TEST_F(TimeOfImpact, FarFromTheWorldsOriginNothingChanges) {
  const AabbTree box = tree_of(box_mesh({2, 1, 0.5}, {0.4, 0, 0}, 4));
  const Vector3d far(4e5, -3e5, 100);
  const auto meet = [&](const Vector3d& offset) {
    const Motion ma = ArcMotion{pose_from_angles(offset, 0.3, 0, 0), 15, 0.05, -2};
    const Motion mb = ArcMotion{pose_from_angles(offset + Vector3d(18, 9, 0), 3.4, 0, 0), 8, 0, 0};
    return find(box, ma, box, mb, 0, 5);
  };
  const Impact near = meet(Vector3d::Zero());
  ASSERT_EQ(near.state, ImpactState::contact);
  EXPECT_NEAR(meet(far).time_s, near.time_s, 1e-7);
}

TEST_F(TimeOfImpact, AWarmQueryKeepsToItsMemory) {
  const AabbTree ball = tree_of(sphere_mesh(1, 40));
  const Motion ma = moving(at(-8, 0.2, 0.1), {5, 0, 0}, {0.3, 0.2, 0.1});
  const Motion mb = moving(at(8, 0, 0), {-5, 0, 0});
  const Impact first = find(ball, ma, ball, mb, 0, 4);
  const Impact second = find(ball, ma, ball, mb, 0, 4);
  EXPECT_EQ(first.time_s, second.time_s);
  EXPECT_EQ(first.work.bv_tests, second.work.bv_tests);
  EXPECT_NEAR(gap_at(ball, ma, ball, mb, first.time_s), tolerance, 1e-6);
}

}  // namespace
}  // namespace crashrank

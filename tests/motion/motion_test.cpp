#include "crashrank/motion/motion.hpp"

#include "base/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace crashrank {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using std::numbers::pi;
using test::Random;
constexpr double infinity = std::numeric_limits<double>::infinity();

double yaw_of(const Pose& pose) { return std::atan2(pose.rotation(1, 0), pose.rotation(0, 0)); }

TEST(Motion, StraightDriveCoversSpeedTimesTime) {
  const Motion motion = TurnMotion{pose_from_angles({1, 2, 3}, pi / 2, 0, 0), 10.0, 0.0, 0.0};
  EXPECT_TRUE(motion.pose_at(2.0).translation.isApprox(Vector3d(1, 22, 3), 1e-14));
  EXPECT_TRUE(motion.velocity_at(2.0).linear_mps.isApprox(Vector3d(0, 10, 0), 1e-14));
  EXPECT_EQ(motion.next_kink(0.0), infinity);
  EXPECT_EQ(motion.rest_time(), infinity);
}

TEST(Motion, OnASlopeABodyMovesAlongItsForwardAxis) {
  // 8 degrees downhill, leaning: 10 m/s for 2 s and a stop within 10 m after 1 s.
  const double pitch = 8.0 * pi / 180.0;
  for (const double yaw : {0.0, 0.5 * pi, -2.5}) {
    const Pose start = pose_from_angles({1, 2, 3}, yaw, pitch, 0.3);
    const Vector3d forward(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw),
                           -std::sin(pitch));
    const Motion drives = TurnMotion{start, 10.0, 0.0, 0.0};
    EXPECT_LT((drives.pose_at(2.0).translation - start.translation - 20.0 * forward).norm(), 1e-13);
    EXPECT_LT((drives.velocity_at(2.0).linear_mps - 10.0 * forward).norm(), 1e-13);
    const Motion brakes = ArcMotion{start, 10.0, 0.0, -5.0};
    EXPECT_LT((brakes.pose_at(9.0).translation - start.translation - 10.0 * forward).norm(), 1e-13);
  }
}

TEST(MotionProperty, TurnsOnASlopeAreThoseOfTheLevelRoadTilted) {
  Random random(14);
  for (int i = 0; i < 500; ++i) {
    const double yaw = random.uniform(-pi, pi);
    const double lean = random.uniform(-0.6, 0.6);
    const Pose road = pose_from_angles(random.vector(50), yaw, random.uniform(-0.4, 0.4), 0);
    const Pose level = pose_from_angles({0, 0, 0}, 0, 0, lean);
    const Pose tilted{road.rotation * level.rotation, road.translation};
    const double speed = random.uniform(-15, 40);
    const double turns = random.uniform(-1.5, 1.5);
    const double acceleration = random.uniform(-12, 6);
    const double t = random.uniform(0, 5);
    const auto expect_tilted = [&](const Motion& on_road, const Motion& on_level) {
      const Pose pose = on_road.pose_at(t);
      const Pose flat = on_level.pose_at(t);
      ASSERT_LT((pose.translation - road.translation - road.rotation * flat.translation).norm(),
                1e-10)
          << i;
      ASSERT_LT((pose.rotation - road.rotation * flat.rotation).norm(), 1e-12) << i;
      const Vector3d angular = road.rotation * on_level.velocity_at(t).angular_radps;
      ASSERT_LT((on_road.velocity_at(t).angular_radps - angular).norm(), 1e-12) << i;
    };
    expect_tilted(TurnMotion{tilted, speed, turns, acceleration},
                  TurnMotion{level, speed, turns, acceleration});
    expect_tilted(ArcMotion{tilted, speed, 0.1 * turns, acceleration},
                  ArcMotion{level, speed, 0.1 * turns, acceleration});
  }
}

TEST(Motion, PositiveYawTurnsLeftOnACircle) {
  const Motion motion = TurnMotion{{}, 10.0, 0.5, 0.0};
  // Radius 20 m, centre at (0, 20): after half a turn the vehicle is at (0, 40), heading back.
  const Pose half = motion.pose_at(pi / 0.5);
  EXPECT_NEAR((half.translation - Vector3d(0, 40, 0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(half.rotation(0, 0), -1.0, 1e-15);
  const Pose quarter = motion.pose_at(pi / 1.0);
  EXPECT_NEAR((quarter.translation - Vector3d(20, 20, 0)).norm(), 0.0, 1e-12);
}

TEST(Motion, BrakingEndsInStandstillAndNeverReverses) {
  const Motion motion = TurnMotion{{}, 10.0, 0.0, -5.0};
  EXPECT_NEAR(motion.pose_at(1.0).translation.x(), 7.5, 1e-14);
  EXPECT_NEAR(motion.pose_at(2.0).translation.x(), 10.0, 1e-14);
  EXPECT_EQ(motion.pose_at(5.0).translation, motion.pose_at(2.0).translation);
  EXPECT_TRUE(motion.velocity_at(3.0).linear_mps.isZero(0.0));
  EXPECT_EQ(motion.rest_time(), 2.0);
}

TEST(Motion, ReverseGearIsBrakedByForwardAcceleration) {
  const Motion motion = ArcMotion{{}, -4.0, 0.0, 2.0};
  EXPECT_NEAR(motion.pose_at(1.0).translation.x(), -3.0, 1e-14);
  EXPECT_NEAR(motion.pose_at(9.0).translation.x(), -4.0, 1e-14);
}

TEST(Motion, AStandingVehicleThatBrakesStays) {
  const Motion motion = TurnMotion{{}, 0.0, 0.7, -3.0};
  EXPECT_TRUE(motion.pose_at(4.0).translation.isZero(0.0));
  EXPECT_EQ(motion.pose_at(4.0).rotation, Eigen::Matrix3d(Eigen::Matrix3d::Identity()));
  EXPECT_EQ(motion.rest_time(), 0.0);
}

TEST(Motion, TheYawOfATurnEndsWithTheMotion) {
  const Motion motion = TurnMotion{{}, 10.0, 0.5, -5.0};
  EXPECT_NEAR(yaw_of(motion.pose_at(9.0)), 1.0, 1e-14);
  EXPECT_EQ(motion.next_kink(0.0), 2.0);
  EXPECT_EQ(motion.next_kink(2.0), infinity);
  EXPECT_TRUE(motion.velocity_at(2.0).angular_radps.isZero(0.0));
}

TEST(Motion, TopSpeedEndsTheRise) {
  const Motion motion = ArcMotion{{}, 10.0, 0.0, 2.0, 14.0};
  EXPECT_NEAR(motion.pose_at(2.0).translation.x(), 24.0, 1e-13);
  EXPECT_NEAR(motion.pose_at(3.0).translation.x(), 38.0, 1e-13);
  EXPECT_EQ(motion.velocity_at(9.0).linear_mps.x(), 14.0);
}

TEST(Motion, ArcKeepsItsRadiusWhileItBrakes) {
  const double curvature = curvature_from_steering(0.2, 2.7);
  EXPECT_NEAR(curvature, std::tan(0.2) / 2.7, 1e-16);
  const Motion motion = ArcMotion{{}, 12.0, curvature, -4.0};
  const Vector3d centre(0, 1.0 / curvature, 0);
  for (const double t : {0.0, 0.5, 1.7, 2.9, 3.5}) {
    EXPECT_NEAR((motion.pose_at(t).translation - centre).norm(), 1.0 / curvature, 1e-12);
  }
  // Length of the arc: v²/2a.
  EXPECT_NEAR(yaw_of(motion.pose_at(10.0)), curvature * 18.0, 1e-13);
}

TEST(Motion, AGentleTurnWithAccelerationMeetsItsSeries) {
  // Both branches of the closed form against fine integration of the velocity.
  for (const double rate : {1e-9, 1e-3, 0.05, 0.4, -2.0}) {
    const Motion motion = TurnMotion{{}, 8.0, rate, 1.5};
    Vector2d sum = Vector2d::Zero();
    constexpr int n = 20000;
    constexpr double h = 3.0 / n;
    for (int i = 0; i < n; ++i) {
      const double t = (i + 0.5) * h;
      sum += h * (8.0 + 1.5 * t) * Vector2d(std::cos(rate * t), std::sin(rate * t));
    }
    EXPECT_NEAR((motion.pose_at(3.0).translation.head<2>() - sum).norm(), 0.0, 1e-6) << rate;
  }
}

TEST(Motion, TimedPosesAreMetAndInterpolated) {
  std::vector<TimedPose> poses{{1.0, pose_from_angles({0, 0, 0}, 0, 0, 0)},
                               {2.0, pose_from_angles({4, 0, 2}, pi / 2, 0, 0)},
                               {4.0, pose_from_angles({4, 6, 2}, pi, 0, 0)}};
  const Result<Motion> motion = Motion::timed(poses);
  ASSERT_TRUE(motion.ok());
  EXPECT_TRUE(motion->pose_at(0.2).translation.isZero(0.0));
  EXPECT_TRUE(motion->velocity_at(0.2).linear_mps.isZero(0.0));
  EXPECT_TRUE(motion->pose_at(1.5).translation.isApprox(Vector3d(2, 0, 1), 1e-14));
  EXPECT_NEAR(yaw_of(motion->pose_at(1.5)), pi / 4, 1e-14);
  EXPECT_TRUE(motion->velocity_at(2.0).linear_mps.isApprox(Vector3d(0, 3, 0), 1e-14));
  EXPECT_NEAR(motion->velocity_at(3.0).angular_radps.z(), pi / 4, 1e-14);
  EXPECT_TRUE(motion->pose_at(9.0).rotation.isApprox(poses[2].pose.rotation, 1e-14));
  EXPECT_EQ(motion->next_kink(1.0), 2.0);
  EXPECT_EQ(motion->rest_time(), 4.0);
}

TEST(Motion, TimedPosesOutOfOrderAreNamed) {
  std::vector<TimedPose> poses{{0.0, {}}, {1.0, {}}, {1.0, {}}};
  Result<Motion> motion = Motion::timed(poses);
  ASSERT_FALSE(motion.ok());
  EXPECT_EQ(motion.error().code, ErrorCode::bad_input);
  EXPECT_EQ(motion.error().place, "pose 2");
  poses[2].time_s = 2.0;
  poses[1].pose.rotation *= 1.1;
  motion = Motion::timed(poses);
  ASSERT_FALSE(motion.ok());
  EXPECT_EQ(motion.error().place, "pose 1");
  EXPECT_FALSE(Motion::timed(View<const TimedPose>()).ok());
}

TEST(Motion, TimedPosesThatNothingCouldFollowAreRefused) {
  for (const double seconds : {1e-310, 1e-160, 1e-12, 9e-4}) {
    const Result<Motion> motion =
        Motion::timed(std::vector<TimedPose>{{0.0, pose_from_angles({22, 0, 0}, 0, 0, 0)},
                                             {seconds, pose_from_angles({12, 0, 0}, 0, 0, 0)}});
    ASSERT_FALSE(motion.ok()) << seconds;
    EXPECT_EQ(motion.error().code, ErrorCode::bad_input);
    EXPECT_EQ(motion.error().place, "pose 1");
    EXPECT_FALSE(Motion::timed(std::vector<TimedPose>{{0.0, {}},
                                                      {1e-5, pose_from_angles({0, 0, 0}, 1, 0, 0)}})
                     .ok());
  }
  EXPECT_TRUE(Motion::timed(std::vector<TimedPose>{{0.0, pose_from_angles({22, 0, 0}, 0, 0, 0)},
                                                   {1e-2, pose_from_angles({12, 0, 0}, 0, 0, 0)}})
                  .ok());
}

TEST(Motion, ATopSpeedThatIsNoNumberIsSeen) {
  for (const double acceleration : {0.0, 2.0, -2.0}) {
    TurnMotion turn;
    turn.speed_mps = 5.0;
    turn.acceleration_mps2 = acceleration;
    EXPECT_TRUE(Motion(turn).is_finite());
    turn.top_speed_mps = NAN;
    EXPECT_FALSE(Motion(turn).is_finite()) << acceleration;
  }
}

TEST(Motion, AStartThatIsNotQuiteARotationIsMadeOne) {
  Pose skewed = pose_from_angles({1, 2, 3}, 0.4, 0.1, 0.2);
  const Pose exact = skewed;
  skewed.rotation(0, 1) += 4e-7;
  for (const Motion& motion :
       {Motion(TurnMotion{skewed, 5, 0.1, 0}), Motion(ArcMotion{skewed, 5, 0.1, 0}),
        Motion(FreeMotion{skewed, {{1, 0, 0}, {0, 0, 1}}}), Motion::at_rest(skewed)}) {
    EXPECT_LT(rigidity_error(motion.pose_at(1.0)), 1e-14);
    EXPECT_LT((motion.pose_at(0.0).rotation - skewed.rotation).norm(), 1e-6);
  }
  EXPECT_EQ(Motion::at_rest(exact).pose_at(2.0).rotation, exact.rotation);
}

// Motions of every kind with parameters of vehicles and of things that tumble.
Motion any_motion(Random& random) {
  const double speed = random.uniform(-15, 40);
  const double acceleration = random.uniform(-12, 6);
  switch (random.below(4)) {
    case 0:
      return TurnMotion{random.pose(50), speed, random.uniform(-1.5, 1.5), acceleration, 42.0};
    case 1:
      return ArcMotion{random.pose(50), speed, random.uniform(-0.2, 0.2), acceleration};
    case 2: {
      const Pose start = random.pose(50);
      const Vector3d v = random.vector(30);
      return FreeMotion{start, {v, random.vector(6)}};
    }
    default: {
      std::vector<TimedPose> poses;
      double t = random.uniform(0, 0.5);
      for (int i = 0; i < 5; ++i) {
        poses.push_back({t, random.pose(10)});
        t += random.uniform(0.05, 1.5);
      }
      return *Motion::timed(poses);
    }
  }
}

TEST(MotionProperty, VelocityIsTheDerivativeOfThePose) {
  constexpr std::uint64_t seed = 11;
  Random random(seed);
  for (int i = 0; i < 2000; ++i) {
    const Motion motion = any_motion(random);
    const double t = random.uniform(0.01, 5);
    constexpr double h = 1e-6;
    if (motion.next_kink(t - 2 * h) < t + 2 * h) continue;
    const Vector3d body = random.vector(3);
    const auto at = [&](double time) {
      const Pose pose = motion.pose_at(time);
      return Vector3d(pose.rotation * body + pose.translation);
    };
    const Vector3d difference = (at(t + h) - at(t - h)) / (2 * h);
    const Vector3d told =
        velocity_of_point(motion.velocity_at(t), motion.pose_at(t).translation, at(t));
    ASSERT_NEAR((difference - told).norm(), 0.0, 1e-4) << "seed " << seed << ", case " << i;
  }
}

TEST(MotionProperty, NothingMovesFurtherOrFasterThanItsBounds) {
  constexpr std::uint64_t seed = 12;
  Random random(seed);
  for (int i = 0; i < 2000; ++i) {
    const Motion motion = any_motion(random);
    const double from = random.uniform(0, 4);
    const double until = from + random.uniform(0, 1.5);
    const Vector3d body = random.vector(3);
    const double radius = body.norm();
    const double reach = motion.reach(radius, from, until);
    const MotionBound bound = motion.bound(from, until);
    Vector3d first;
    for (int k = 0; k <= 20; ++k) {
      const double t = from + (until - from) * k / 20;
      Pose pose;
      Velocity velocity;
      motion.state_at(t, pose, velocity);
      const Vector3d point = pose.rotation * body + pose.translation;
      if (k == 0) first = point;
      ASSERT_LE((point - first).norm(), reach + 1e-10) << "seed " << seed << ", case " << i;
      ASSERT_LE(velocity.linear_mps.norm(), bound.speed_mps + 1e-12) << i;
      ASSERT_LE(velocity.angular_radps.norm(), bound.angular_radps + 1e-12) << i;
      ASSERT_LT(rigidity_error(pose), 1e-12) << i;
    }
  }
}

// What the time of impact rests on: away from kinks a point departs from its tangent by no more
// than half its bounded acceleration times the time squared.
TEST(MotionProperty, AccelerationBoundsTheDepartureFromTheTangent) {
  constexpr std::uint64_t seed = 13;
  Random random(seed);
  for (int i = 0; i < 3000; ++i) {
    const Motion motion = any_motion(random);
    const double from = random.uniform(0, 4);
    const double until = std::min(from + random.uniform(0, 2), motion.next_kink(from));
    const Vector3d body = random.vector(3);
    const MotionBound bound = motion.bound(from, until);
    const double acceleration =
        bound.acceleration_mps2 +
        (bound.angular_radps * bound.angular_radps + bound.angular_radps2) * body.norm();
    const Pose start = motion.pose_at(from);
    const Vector3d p = start.rotation * body + start.translation;
    const Vector3d v = velocity_of_point(motion.velocity_at(from), start.translation, p);
    for (int k = 1; k <= 16; ++k) {
      const double dt = (until - from) * k / 16;
      const Pose pose = motion.pose_at(from + dt);
      const Vector3d point = pose.rotation * body + pose.translation;
      ASSERT_LE((point - p - dt * v).norm(), 0.5 * acceleration * dt * dt + 1e-9)
          << "seed " << seed << ", case " << i;
    }
  }
}

}  // namespace
}  // namespace crashrank

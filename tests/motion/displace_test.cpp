#include "crashrank/motion/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace crashrank {
namespace {

Pose placed(double x, double y, double yaw = 0.0) {
  return pose_from_angles({x, y, 0.5}, yaw, 0, 0);
}

void expect_same(const Motion& a, const Motion& b, double tolerance) {
  for (double t = 0.0; t < 6.0; t += 0.17) {
    EXPECT_TRUE(a.pose_at(t).translation.isApprox(b.pose_at(t).translation, tolerance)) << t;
    EXPECT_TRUE(a.pose_at(t).rotation.isApprox(b.pose_at(t).rotation, tolerance)) << t;
    EXPECT_LE((a.velocity_at(t).linear_mps - b.velocity_at(t).linear_mps).norm(), 1e-9) << t;
  }
}

Motion displaced(Motion motion, const StateError& error) {
  motion.displace(error);
  return motion;
}

TEST(Displace, ArcsAndTurnsBeginAtTheDisplacedState) {
  for (const double acceleration : {-3.0, 0.0, 2.0}) {
    ArcMotion arc{placed(4, -2, 0.3), 9.0, 0.05, acceleration, 14.0};
    TurnMotion turn{placed(4, -2, 0.3), -9.0, 0.2, acceleration, 14.0};
    const Motion arc_moved = displaced(arc, {0.5, -0.25, 0.1, 1.5});
    const Motion turn_moved = displaced(turn, {0.5, -0.25, 0.1, 1.5});
    arc.start = turn.start = placed(4.5, -2.25, 0.4);
    arc.speed_mps = 10.5;
    turn.speed_mps = -7.5;
    expect_same(arc_moved, arc, 1e-12);
    expect_same(turn_moved, turn, 1e-12);
  }
}

TEST(Displace, TimedPosesMoveAsOneBody) {
  const std::vector<TimedPose> poses{
      {0, placed(1, 2, 0.2)}, {1, placed(6, 3, 0.3)}, {3, placed(9, 9, 1.0)}};
  const Motion motion = *Motion::timed(poses);
  const Motion moved = displaced(motion, {0.3, -0.4, 0.25, 0.0});
  // About the first pose.
  std::vector<TimedPose> expected = poses;
  for (TimedPose& each : expected) {
    const Eigen::Vector3d arm = each.pose.translation - poses.front().pose.translation;
    const double c = std::cos(0.25);
    const double s = std::sin(0.25);
    each.pose = placed(1.3 + c * arm.x() - s * arm.y(), 1.6 + s * arm.x() + c * arm.y(),
                       std::atan2(each.pose.rotation(1, 0), each.pose.rotation(0, 0)) + 0.25);
  }
  expect_same(moved, *Motion::timed(expected), 1e-12);
}

TEST(Displace, TimedPosesGainTheSpeedWhileTheyMove) {
  // 4 m/s along y for two seconds, one second of rest, then 1 m/s backwards.
  const double left = 0.5 * std::numbers::pi;
  const std::vector<TimedPose> poses{{0, placed(0, 0, left)},
                                     {2, placed(0, 8, left)},
                                     {3, placed(0, 8, left)},
                                     {5, placed(0, 6, left)}};
  const Motion faster = displaced(*Motion::timed(poses), {0, 0, 0, 1.5});
  EXPECT_NEAR(faster.pose_at(2).translation.y(), 11.0, 1e-12);
  EXPECT_NEAR(faster.pose_at(3).translation.y(), 11.0, 1e-12);
  // Stopped, not reversed.
  EXPECT_NEAR(faster.pose_at(5).translation.y(), 11.0, 1e-12);
  EXPECT_NEAR(faster.velocity_at(1).linear_mps.y(), 5.5, 1e-12);
  EXPECT_NEAR(faster.velocity_at(4).linear_mps.norm(), 0.0, 1e-12);
  const Motion stopped = displaced(*Motion::timed(poses), {0, 0, 0, -9.0});
  EXPECT_NEAR(stopped.pose_at(3).translation.norm(), 0.5, 1e-12);
}

TEST(Displace, TheErrorOfTheSpeedActsAlongTheSlope) {
  // 20 m/s uphill by 10 degrees for 3 s, 1.5 m/s more, turned by 0.2 rad about the vertical.
  const double pitch = -std::numbers::pi / 18.0;
  const Pose start = pose_from_angles({1, 2, 3}, 0.4, pitch, 0);
  const Eigen::Vector3d forward(std::cos(pitch) * std::cos(0.6), std::cos(pitch) * std::sin(0.6),
                                -std::sin(pitch));
  const Motion arc = ArcMotion{start, 20.0, 0.0, 0.0};
  const Motion free = FreeMotion{start, arc.velocity_at(0.0)};
  const Motion timed = *Motion::timed(
      std::vector<TimedPose>{{0, start}, {1, arc.pose_at(1.0)}, {4, arc.pose_at(4.0)}});
  for (const Motion& motion : {arc, free, timed}) {
    const Pose moved = displaced(motion, {0, 0, 0.2, 1.5}).pose_at(3.0);
    EXPECT_LT((moved.translation - Eigen::Vector3d(1, 2, 3) - 64.5 * forward).norm(), 1e-12);
  }
}

TEST(Displace, NothingReversesAndWhatStandsStays) {
  const StateError slower{0.0, 0.0, 0.0, -20.0};
  for (const double acceleration : {-4.0, 0.0}) {
    const Motion braked = displaced(TurnMotion{placed(1, 1), 5.0, 0.3, acceleration}, slower);
    EXPECT_EQ(braked.pose_at(4).translation, placed(1, 1).translation);
    EXPECT_EQ(braked.rest_time(), 0.0);
    const Motion reversing =
        displaced(TurnMotion{placed(1, 1), -5.0, 0.3, -acceleration}, {0.0, 0.0, 0.0, 20.0});
    EXPECT_EQ(reversing.pose_at(4).translation, placed(1, 1).translation);
  }
  const Motion standing = displaced(TurnMotion{placed(1, 1), 0.0, 0.0, 0.0}, {0.5, 0.0, 0.0, 3.0});
  EXPECT_NEAR(standing.pose_at(4).translation.x(), 1.5, 1e-15);
  EXPECT_EQ(standing.velocity_at(1).linear_mps.norm(), 0.0);
  const Motion resting = displaced(Motion::at_rest(placed(1, 1)), {0.0, 0.5, 0.0, 3.0});
  EXPECT_NEAR(resting.pose_at(4).translation.y(), 1.5, 1e-15);
}

TEST(Displace, NoErrorChangesNoBit) {
  for (const Motion& motion :
       {Motion(ArcMotion{placed(4, -2, 0.3), 9.0, 0.05, -3.0}),
        Motion(FreeMotion{placed(1, 1, 2), {{1, 2, 0}, {0, 0, 1}}}),
        *Motion::timed(std::vector<TimedPose>{{0, placed(0, 0)}, {1, placed(1, 2)}})}) {
    const Motion same = displaced(motion, {});
    for (const double t : {0.0, 0.7, 5.0}) {
      EXPECT_EQ(same.pose_at(t).translation, motion.pose_at(t).translation);
      EXPECT_EQ(same.pose_at(t).rotation, motion.pose_at(t).rotation);
    }
  }
  Motion nowhere = ArcMotion{};
  nowhere.displace({std::numeric_limits<double>::quiet_NaN(), 0, 0, 0});
  EXPECT_FALSE(nowhere.is_finite());
}

}  // namespace
}  // namespace crashrank

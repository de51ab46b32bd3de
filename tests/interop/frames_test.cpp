#include "crashrank/interop/frames.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

namespace crashrank {
namespace {

using Eigen::Vector3d;

/// Uniform in [-most, most], the same with every standard library.
double between(std::mt19937_64& random, double most) {
  return most * (2.0 * static_cast<double>(random() >> 11U) * 0x1p-53 - 1.0);
}

bool near(const Pose& a, const Pose& b) {
  return a.rotation.isApprox(b.rotation, 1e-12) && (a.translation - b.translation).norm() < 1e-9;
}

/// The matrix that CARLA's manual gives for a Transform, of its left-handed axes.
Pose carla_matrix(const CarlaTransform& t) {
  const double d = M_PI / 180.0;
  const double cy = std::cos(t.yaw_deg * d);
  const double sy = std::sin(t.yaw_deg * d);
  const double cr = std::cos(t.roll_deg * d);
  const double sr = std::sin(t.roll_deg * d);
  const double cp = std::cos(t.pitch_deg * d);
  const double sp = std::sin(t.pitch_deg * d);
  Pose pose;
  pose.rotation << cp * cy, cy * sp * sr - sy * cr, -cy * sp * cr - sy * sr,  //
      sy * cp, sy * sp * sr + cy * cr, -sy * sp * cr + cy * sr,               //
      sp, -cp * sr, cp * cr;
  pose.translation = {t.x_m, t.y_m, t.z_m};
  return pose;
}

TEST(Frames, CarlaTurnsToTheRightNoseUpAndRightSideDown) {
  const Pose right = pose_from_carla({1, 2, 3, 0, 90, 0});
  EXPECT_TRUE(carry(right, {1, 0, 0}).isApprox(Vector3d(1, -3, 3), 1e-12));
  const Pose up = pose_from_carla({0, 0, 0, 90, 0, 0});
  EXPECT_TRUE(carry(up, {1, 0, 0}).isApprox(Vector3d(0, 0, 1), 1e-12));
  const Pose rolled = pose_from_carla({0, 0, 0, 0, 0, 90});
  EXPECT_TRUE(carry(rolled, {0, -1, 0}).isApprox(Vector3d(0, 0, -1), 1e-12));
  EXPECT_DOUBLE_EQ(yaw_rate_from_carla(180.0), -M_PI);
}

TEST(Frames, CarlaAnglesAndCarlaMatricesAgree) {
  std::mt19937_64 random(2026);
  for (int i = 0; i < 1000; ++i) {
    const CarlaTransform t{between(random, 1e3), between(random, 1e3), between(random, 100),
                           between(random, 89),  between(random, 179), between(random, 179)};
    const Pose pose = pose_from_carla(t);
    EXPECT_TRUE(near(pose, flip_left_handed(carla_matrix(t))));
    EXPECT_LT(rigidity_error(pose), 1e-12);
    const CarlaTransform back = carla_from_pose(pose);
    EXPECT_NEAR(back.x_m, t.x_m, 1e-9);
    EXPECT_NEAR(back.y_m, t.y_m, 1e-9);
    EXPECT_NEAR(back.z_m, t.z_m, 1e-9);
    EXPECT_NEAR(back.pitch_deg, t.pitch_deg, 1e-9);
    EXPECT_NEAR(back.yaw_deg, t.yaw_deg, 1e-9);
    EXPECT_NEAR(back.roll_deg, t.roll_deg, 1e-9);
  }
}

TEST(Frames, AnglesComeBack) {
  std::mt19937_64 random(77);
  for (int i = 0; i < 1000; ++i) {
    const Pose pose = pose_from_angles({0, 0, 0}, between(random, M_PI), between(random, M_PI / 2),
                                       between(random, M_PI));
    const Angles angles = angles_of(pose);
    EXPECT_TRUE(near(pose_from_angles({0, 0, 0}, angles.yaw, angles.pitch, angles.roll), pose));
  }
  for (const double pitch : {M_PI / 2, -M_PI / 2}) {
    const Pose pose = pose_from_angles({0, 0, 0}, 0.3, pitch, -0.4);
    const Angles angles = angles_of(pose);
    EXPECT_EQ(angles.roll, 0.0);
    EXPECT_TRUE(near(pose_from_angles({0, 0, 0}, angles.yaw, angles.pitch, angles.roll), pose));
  }
}

TEST(Frames, FlipsUndoThemselvesAndCarryPointsAlong) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 1000; ++i) {
    const Vector3d at(between(random, 9), between(random, 9), between(random, 9));
    const Pose pose =
        pose_from_angles(at, between(random, M_PI), between(random, 1.5), between(random, M_PI));
    EXPECT_EQ(flip_left_handed(flip_left_handed(at)), at);
    EXPECT_EQ(flip_left_handed(flip_left_handed(pose)).rotation, pose.rotation);
    EXPECT_EQ(flip_z_down(flip_z_down(at)), at);
    EXPECT_EQ(flip_z_down(flip_z_down(pose)).rotation, pose.rotation);
    EXPECT_EQ(to_optical(from_optical(at)), at);
    // A point carried in the other frame and then flipped is the flipped point carried here.
    const Eigen::Vector3f point(1.5F, -0.25F, 0.75F);
    const Eigen::Vector3f mirrored(1.5F, 0.25F, 0.75F);
    const Eigen::Vector3f down(1.5F, 0.25F, -0.75F);
    EXPECT_TRUE(flip_left_handed(carry(pose, point))
                    .isApprox(carry(flip_left_handed(pose), mirrored), 1e-12));
    EXPECT_TRUE(flip_z_down(carry(pose, point)).isApprox(carry(flip_z_down(pose), down), 1e-12));
    EXPECT_LT(rigidity_error(flip_left_handed(pose)), 1e-12);
    EXPECT_LT(rigidity_error(flip_z_down(pose)), 1e-12);
  }
}

TEST(Frames, KnownAxes) {
  EXPECT_EQ(flip_left_handed(Vector3d(1, 2, 3)), Vector3d(1, -2, 3));  // right is minus left
  EXPECT_EQ(flip_z_down(Vector3d(1, 2, 3)), Vector3d(1, -2, -3));
  EXPECT_EQ(from_optical({0, 0, 1}), Vector3d(1, 0, 0));   // into the picture: forward
  EXPECT_EQ(from_optical({1, 0, 0}), Vector3d(0, -1, 0));  // right
  EXPECT_EQ(from_optical({0, 1, 0}), Vector3d(0, 0, -1));  // down
}

}  // namespace
}  // namespace crashrank

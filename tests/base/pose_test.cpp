#include "crashrank/base/pose.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace crashrank {
namespace {

constexpr double quarter = 1.5707963267948966;

TEST(Pose, AnglesTurnTheWayTheConventionSays) {
  const Pose yaw = pose_from_angles({1, 2, 3}, quarter, 0, 0);
  EXPECT_TRUE(carry(yaw, {1, 0, 0}).isApprox(Eigen::Vector3d(1, 3, 3), 1e-12));  // left turn
  const Pose pitch = pose_from_angles({0, 0, 0}, 0, quarter, 0);
  EXPECT_TRUE(carry(pitch, {1, 0, 0}).isApprox(Eigen::Vector3d(0, 0, -1), 1e-12));  // nose down
  const Pose roll = pose_from_angles({0, 0, 0}, 0, 0, quarter);
  EXPECT_TRUE(carry(roll, {0, 1, 0}).isApprox(Eigen::Vector3d(0, 0, 1), 1e-12));
  // Rz·Ry·Rx: roll acts first, yaw last.
  const Pose all = pose_from_angles({0, 0, 0}, quarter, 0, quarter);
  EXPECT_TRUE(carry(all, {0, 0, 1}).isApprox(Eigen::Vector3d(1, 0, 0), 1e-12));
}

TEST(Pose, RelativeUndoesTheFirstBody) {
  const Pose a = pose_from_angles({4, -2, 1}, 0.7, 0.2, -0.4);
  const Pose b = pose_from_angles({-1, 5, 2}, -1.1, 0.1, 0.3);
  const Pose back = compose(a, relative(a, b));
  EXPECT_TRUE(back.rotation.isApprox(b.rotation, 1e-14));
  EXPECT_TRUE(back.translation.isApprox(b.translation, 1e-14));
  EXPECT_TRUE(compose(a, inverse(a)).translation.isZero(1e-14));
}

TEST(Pose, MatrixIsKeptBitForBit) {
  const std::vector<double> m{0, -1, 0, 0.1, 1, 0, 0, 0.2, 0, 0, 1, 0.3, 0, 0, 0, 1};
  const Result<Pose> pose = pose_from_matrix(m);
  ASSERT_TRUE(pose.ok());
  EXPECT_EQ(pose->translation, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(pose->rotation(0, 1), -1.0);
  EXPECT_EQ(pose->rotation(1, 0), 1.0);
}

TEST(Pose, RefusesWhatIsNotARigidMotion) {
  const std::vector<double> good{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  for (const auto& [index, value] : std::vector<std::pair<std::size_t, double>>{
           {0, 1.00001}, {0, -1.0}, {1, 1e-5}, {3, NAN}, {5, INFINITY}, {12, 0.5}, {15, 2.0}}) {
    std::vector<double> bad = good;
    bad[index] = value;
    const Result<Pose> pose = pose_from_matrix(bad);
    ASSERT_FALSE(pose.ok()) << index;
    EXPECT_EQ(pose.error().code, ErrorCode::bad_input);
  }
  EXPECT_FALSE(pose_from_matrix(View<const double>(good.data(), 15)).ok());
  std::vector<double> near = good;
  near[0] = 1.0 + 4e-7;
  EXPECT_TRUE(pose_from_matrix(near).ok());
}

}  // namespace
}  // namespace crashrank

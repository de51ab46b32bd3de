#include "crashrank/mesh/triangle_mesh.hpp"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace crashrank {
namespace {

TEST(Transform, TurnsForwardAndUpWithoutMirroring) {
  int turns = 0;
  for (int up = 0; up < 6; ++up) {
    for (int forward = 0; forward < 6; ++forward) {
      ImportTransform transform;
      transform.up = static_cast<Axis>(up);
      transform.forward = static_cast<Axis>(forward);
      if (up / 2 == forward / 2) {
        EXPECT_FALSE(check(transform).ok());
        continue;
      }
      ASSERT_TRUE(check(transform).ok());
      EXPECT_EQ(apply(transform, direction(transform.forward)), Eigen::Vector3d::UnitX());
      EXPECT_EQ(apply(transform, direction(transform.up)), Eigen::Vector3d::UnitZ());
      Eigen::Matrix3d turn;
      for (int axis = 0; axis < 3; ++axis) {
        turn.col(axis) = apply(transform, Eigen::Vector3d::Unit(axis));
      }
      EXPECT_EQ(turn.determinant(), 1.0);
      ++turns;
    }
  }
  EXPECT_EQ(turns, 24);
}

TEST(Transform, TheDefaultChangesNothing) {
  const Eigen::Vector3d point(0.1, -1e-30, 12345.678);
  EXPECT_EQ(apply(ImportTransform{}, point), point);
}

TEST(Transform, ScalesFirstAndSubtractsTheOriginInBodyAxes) {
  ImportTransform transform;
  transform.scale = 0.5;
  transform.up = Axis::plus_y;
  transform.forward = Axis::plus_z;
  transform.origin_m = {1, 2, 3};
  EXPECT_EQ(apply(transform, {10, 20, 30}), Eigen::Vector3d(15 - 1, 5 - 2, 10 - 3));
}

TEST(Transform, RefusesWhatIsNone) {
  for (const double scale : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    ImportTransform transform;
    transform.scale = scale;
    EXPECT_FALSE(check(transform).ok()) << scale;
  }
  ImportTransform transform;
  transform.origin_m.y() = std::nan("");
  EXPECT_FALSE(check(transform).ok());
}

TEST(Transform, KnowsTheNamesOfAxes) {
  EXPECT_EQ(*axis_from_name("x"), Axis::plus_x);
  EXPECT_EQ(*axis_from_name("-Z"), Axis::minus_z);
  EXPECT_EQ(*axis_from_name("+y"), Axis::plus_y);
  for (const char* name : {"", "w", "--x", "xx", "+", "x "}) {
    EXPECT_FALSE(axis_from_name(name).ok()) << name;
  }
}

TEST(Transform, MeshesThatWouldOverflowStayAsTheyAre) {
  TriangleMesh mesh;
  mesh.vertices = {{1, 2, 3}, {1e38F, 0, 0}};
  ImportTransform transform;
  transform.scale = 10.0;
  EXPECT_FALSE(transform_mesh(mesh, transform).ok());
  EXPECT_EQ(mesh.vertices[0], Eigen::Vector3f(1, 2, 3));
  transform.scale = 2.0;
  ASSERT_TRUE(transform_mesh(mesh, transform).ok());
  EXPECT_EQ(mesh.vertices[0], Eigen::Vector3f(2, 4, 6));
}

}  // namespace
}  // namespace crashrank

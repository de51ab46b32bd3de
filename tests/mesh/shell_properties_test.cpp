#include "crashrank/mesh/properties.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace crashrank {
namespace {

/// A closed box with its corner at `at`.
TriangleMesh box(const Eigen::Vector3f& at, const Eigen::Vector3f& size) {
  TriangleMesh mesh;
  for (unsigned i = 0; i < 8; ++i) {
    mesh.vertices.push_back(at + Eigen::Vector3f((i & 1U) != 0 ? size.x() : 0.0F,
                                                 (i & 2U) != 0 ? size.y() : 0.0F,
                                                 (i & 4U) != 0 ? size.z() : 0.0F));
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TEST(ShellProperties, AreThoseOfAHollowCube) {
  const ShellProperties told = shell_properties(box({1, 2, 3}, {2, 2, 2}));
  EXPECT_NEAR(told.area_m2, 24.0, 1e-12);
  EXPECT_NEAR(told.volume_m3, 8.0, 1e-12);
  EXPECT_NEAR((told.center_m - Eigen::Vector3d(2, 3, 4)).norm(), 0.0, 1e-12);
  // A hollow cube of side s: 5/18·s² about each axis.
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(told.inertia_per_kg_m2[i], 4.0 * 5 / 18, 1e-12);
  for (std::size_t i = 3; i < 6; ++i) EXPECT_NEAR(told.inertia_per_kg_m2[i], 0.0, 1e-12);
}

TEST(ShellProperties, OfOneTriangleMatchTheClosedForm) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}};
  mesh.triangles = {{0, 1, 2}};
  const ShellProperties told = shell_properties(mesh);
  EXPECT_NEAR(told.area_m2, 4.5, 1e-12);
  EXPECT_NEAR((told.center_m - Eigen::Vector3d(1, 1, 0)).norm(), 0.0, 1e-12);
  // A right triangle of legs a about its middle: ∫x² dm / m = a²/18, ∫xy dm / m = −a²/36.
  EXPECT_NEAR(told.inertia_per_kg_m2[0], 0.5, 1e-12);
  EXPECT_NEAR(told.inertia_per_kg_m2[1], 0.5, 1e-12);
  EXPECT_NEAR(told.inertia_per_kg_m2[2], 1.0, 1e-12);
  EXPECT_NEAR(told.inertia_per_kg_m2[3], 0.25, 1e-12);
}

TEST(ShellProperties, OfNothingAreZero) {
  EXPECT_EQ(shell_properties(TriangleMesh{}).area_m2, 0.0);
  TriangleMesh flat;
  flat.vertices = {{1, 1, 1}};
  flat.triangles = {{0, 0, 0}};
  const ShellProperties told = shell_properties(flat);
  EXPECT_EQ(told.area_m2, 0.0);
  EXPECT_EQ(told.inertia_per_kg_m2[0], 0.0);
}

}  // namespace
}  // namespace crashrank

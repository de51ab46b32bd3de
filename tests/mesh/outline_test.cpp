#include "mesh/outline.hpp"

#include "mesh/profile_checks.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <optional>
#include <random>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using Eigen::Vector2d;
using test::add_wall;
using test::perimeter_of;
using test::prism;
using test::rectangle;

/// Outlines of a mesh between 0 and 1 m.
std::vector<detail::OutlineLoop> loops_of(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> all(mesh.size());
  std::iota(all.begin(), all.end(), 0U);
  std::optional<detail::SkyMap> sky;
  return detail::BandOutline({&mesh, &all, mesh.bounds(), 0.0, 0.0, 1.0}, 0.02, 0.25, sky).loops();
}

TEST(Outline, AreaHasTheSignOfItsTurn) {
  EXPECT_EQ((detail::OutlineLoop{{{0, 0}, {1, 1}}, false}.area_m2()), 0.0);
  EXPECT_EQ((detail::OutlineLoop{{{0, 0}, {2, 0}, {0, 1}}, false}.area_m2()), 1.0);
  EXPECT_EQ((detail::OutlineLoop{{{0, 1}, {2, 0}, {0, 0}}, false}.area_m2()), -1.0);
}

TEST(Outline, OfNothingIsNothing) { EXPECT_TRUE(loops_of({}).empty()); }

TEST(Outline, OfAnObliqueSheetIsOneThatEnclosesNothing) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> coordinate(-3.0, 3.0);
  for (int i = 0; i < 100; ++i) {
    const Vector2d from(coordinate(random), coordinate(random));
    const Vector2d to(coordinate(random), coordinate(random));
    TriangleMesh mesh;
    add_wall(mesh, from, to, 0.2, 0.8);
    const std::vector<detail::OutlineLoop> loops = loops_of(mesh);
    ASSERT_EQ(loops.size(), 1U) << from.transpose() << ", " << to.transpose();
    EXPECT_NEAR(perimeter_of(loops[0].points), 2.0 * (to - from).norm(), 0.02);
    EXPECT_NEAR(loops[0].area_m2(), 0.0, 1e-6);
  }
}

TEST(Outline, GoesRoundWithTheBodyToItsLeft) {
  TriangleMesh mesh = prism(rectangle(0, 0, 3, 1), 0.0, 1.0);
  // Neither the order nor the direction of the triangles matters for outer outlines.
  std::swap(mesh.triangles[0], mesh.triangles[5]);
  std::swap(mesh.triangles[1][0], mesh.triangles[1][1]);
  const std::vector<detail::OutlineLoop> loops = loops_of(mesh);
  ASSERT_GE(loops.size(), 1U);
  EXPECT_FALSE(loops[0].inner);
  EXPECT_NEAR(loops[0].area_m2(), 3.0, 1e-3);
  EXPECT_LE(loops[0].points.size(), 8U);
}

}  // namespace
}  // namespace crashrank

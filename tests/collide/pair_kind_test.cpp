#include "crashrank/collide/collide.hpp"

#include "collide/triangles.hpp"
#include "crashrank/internal/collide/triangle_test.hpp"
#include "crashrank/tree/build.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace crashrank {
namespace {

using test::triangle;
using Point = Eigen::Vector3d;

// The same kind whichever comes first and however the corners are numbered.
void expect_kind(PairKind kind, const TriangleD& a, const TriangleD& b, const char* what) {
  const std::size_t orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                    {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (const auto& p : orders) {
    for (const auto& q : orders) {
      const TriangleD ta = triangle(a.corner[p[0]], a.corner[p[1]], a.corner[p[2]]);
      const TriangleD tb = triangle(b.corner[q[0]], b.corner[q[1]], b.corner[q[2]]);
      ASSERT_TRUE(triangles_intersect(ta, tb)) << what;
      ASSERT_EQ(pair_kind(ta, tb), kind) << what;
      ASSERT_EQ(pair_kind(tb, ta), kind) << what << ", swapped";
    }
  }
}

const TriangleD floor_triangle = triangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0});

TEST(PairKind, Crossing) {
  expect_kind(PairKind::crossing, floor_triangle, triangle({1, 1, -1}, {1, 1, 1}, {2, 1, 1}),
              "an edge through the inside");
  expect_kind(PairKind::crossing, floor_triangle, triangle({-1, 1, -1}, {-1, 1, 1}, {9, 1, 0.5}),
              "across");
  expect_kind(PairKind::crossing, floor_triangle, triangle({1, 1, 0}, {1, 2, 1}, {2, 1, -1}),
              "a corner in the plane, the others on both sides");
}

TEST(PairKind, Touching) {
  expect_kind(PairKind::touching, floor_triangle, triangle({1, 1, 0}, {1, 1, 1}, {2, 1, 1}),
              "a corner on the inside");
  expect_kind(PairKind::touching, floor_triangle, triangle({1, 1, 0}, {2, 1, 0}, {1, 1, 1}),
              "an edge on the inside");
  expect_kind(PairKind::touching, floor_triangle, triangle({0, 0, 0}, {0, -1, 1}, {0, -1, -1}),
              "corner to corner, going through the plane beside it");
  expect_kind(PairKind::touching, floor_triangle, triangle({1, 0, -1}, {1, 0, 1}, {1, -2, 0}),
              "an edge across an edge");
  expect_kind(PairKind::touching, floor_triangle, triangle({0, 0, 0}, {4, 0, 0}, {0, 0, 3}),
              "a shared edge at a right angle");
  expect_kind(PairKind::touching, floor_triangle, triangle({1, 1, -1}, {1, 1, 1}, {1, 1, 2}),
              "a segment through the inside");
}

TEST(PairKind, Coplanar) {
  expect_kind(PairKind::coplanar, floor_triangle, triangle({1, 1, 0}, {9, 1, 0}, {1, 9, 0}),
              "overlapping");
  expect_kind(PairKind::coplanar, floor_triangle, floor_triangle, "itself");
  expect_kind(PairKind::coplanar, floor_triangle, triangle({4, 0, 0}, {9, 0, 0}, {9, 1, 0}),
              "a corner of each");
  expect_kind(PairKind::coplanar, floor_triangle, triangle({1, 1, 0}, {1, 1, 0}, {1, 1, 0}),
              "a point");
}

// One unit in the last place decides: above, on and below the plane.
TEST(PairKind, OneUnitInTheLastPlace) {
  const double h = 0x1p-1074;
  expect_kind(PairKind::crossing, floor_triangle, triangle({1, 1, -h}, {1, 1, 1}, {2, 1, 1}),
              "just through");
  expect_kind(PairKind::touching, floor_triangle, triangle({1, 1, 0.0}, {1, 1, 1}, {2, 1, 1}),
              "just touching");
}

// Pairs on a small grid of integers, where all three kinds are frequent; whether six points lie in
// one plane is computed in doubles, which hold every integer that comes up.
TEST(PairKind, LabelsEveryPairOfAQuery) {
  constexpr std::uint64_t seed = 20260117;
  std::mt19937_64 random(seed);
  TriangleMesh mesh;
  const auto grid = [&random] { return static_cast<float>(random() % 5); };
  for (std::uint32_t i = 0; i < 120; ++i) {
    for (int k = 0; k < 3; ++k) {
      const float x = grid();
      const float y = grid();
      const float z = grid();
      mesh.vertices.emplace_back(x, y, z);
    }
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const AabbTree tree = *build_tree(mesh);
  std::vector<Pair> pairs;
  collide(tree, tree, Pose{}, pairs);
  const std::vector<PairKind> kinds = pair_kinds(mesh, mesh, Pose{}, pairs);
  ASSERT_EQ(kinds.size(), pairs.size());
  std::size_t counts[3] = {};
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    ++counts[static_cast<std::size_t>(kinds[i])];
    // All six corners in one plane: the rank of the differences, in integers.
    const Triangle ta = mesh.triangle(static_cast<std::size_t>(pairs[i].a));
    const Triangle tb = mesh.triangle(static_cast<std::size_t>(pairs[i].b));
    std::vector<Point> d;
    for (const Triangle* t : {&ta, &tb}) {
      for (const Eigen::Vector3f& c : t->corner) {
        d.emplace_back((c - ta.corner[0]).cast<double>());
      }
    }
    bool one_plane = true;
    for (const Point& p : d) {
      for (const Point& q : d) {
        for (const Point& r : d) one_plane = one_plane && p.cross(q).dot(r) == 0.0;
      }
    }
    EXPECT_EQ(kinds[i] == PairKind::coplanar, one_plane) << "seed " << seed << " pair " << i;
  }
  EXPECT_GT(counts[0], 50U);
  EXPECT_GT(counts[1], 50U);
  EXPECT_GT(counts[2], 50U);
}

}  // namespace
}  // namespace crashrank

#include "crashrank/internal/collide/triangle_test.hpp"
#include "collide/triangles.hpp"

#include <gtest/gtest.h>

#include <random>

namespace crashrank {
namespace {

using Point = Eigen::Vector3d;
using test::triangle;

// Every order of corners and of triangles has to give the same answer.
void expect_meets(const TriangleD& a, const TriangleD& b, bool expected) {
  constexpr int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  const auto permuted = [](const TriangleD& t, const int* order) {
    return triangle(t.corner[static_cast<std::size_t>(order[0])],
                    t.corner[static_cast<std::size_t>(order[1])],
                    t.corner[static_cast<std::size_t>(order[2])]);
  };
  for (const auto& p : orders) {
    for (const auto& q : orders) {
      EXPECT_EQ(triangles_intersect(permuted(a, p), permuted(b, q)), expected);
      EXPECT_EQ(triangles_intersect(permuted(b, q), permuted(a, p)), expected);
    }
  }
}

const TriangleD ground = triangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0});

TEST(TriangleTest, Crossing) {
  expect_meets(ground, triangle({1, 1, -1}, {1, 1, 1}, {5, 5, 1}), true);
  expect_meets(ground, triangle({3, 3, -1}, {3, 3, 1}, {5, 5, 1}), false);
  expect_meets(ground, triangle({1, 1, 1}, {1, 2, 1}, {2, 1, 3}), false);
  // Planes cross, intervals on the common line do not.
  expect_meets(ground, triangle({5, -1, -1}, {5, -1, 1}, {6, 8, 0}), false);
}

TEST(TriangleTest, TouchingInOnePoint) {
  expect_meets(ground, triangle({1, 1, 0}, {1, 2, 1}, {2, 1, 3}), true);           // on the face
  expect_meets(ground, triangle({0, 0, 0}, {-1, -2, 1}, {-2, -1, 3}), true);       // corners
  expect_meets(ground, triangle({2, 0, 0}, {2, -2, 1}, {3, -1, -1}), true);        // on an edge
  expect_meets(ground, triangle({2, -1, -1}, {2, 1, 1}, {2, -9, 9}), true);        // edge on edge
  expect_meets(ground, triangle({1, 1, 0x1p-1074}, {1, 2, 1}, {2, 1, 3}), false);  // not quite
}

TEST(TriangleTest, Coplanar) {
  expect_meets(ground, ground, true);
  expect_meets(ground, triangle({1, 1, 0}, {1.5, 1, 0}, {1, 1.5, 0}), true);  // inside
  expect_meets(ground, triangle({4, 0, 0}, {0, 4, 0}, {4, 4, 0}), true);      // shared edge
  expect_meets(ground, triangle({4, 0, 0}, {5, 0, 0}, {5, 1, 0}), true);      // shared corner
  expect_meets(ground, triangle({-1, 1, 0}, {9, 1, 0}, {9, 0.5, 0}),
               true);  // through, no corner in
  expect_meets(ground, triangle({3, 3, 0}, {5, 3, 0}, {3, 5, 0}), false);
  expect_meets(ground, triangle({1, 1, 1}, {2, 1, 1}, {1, 2, 1}), false);  // parallel
}

TEST(TriangleTest, SegmentsAndPoints) {
  const auto segment = [](Point p, Point q) { return triangle(p, q, Point(0.5 * p + 0.5 * q)); };
  const auto point = [](Point p) { return triangle(p, p, p); };
  expect_meets(ground, segment({1, 1, -1}, {1, 1, 1}), true);
  expect_meets(ground, segment({1, 1, 0}, {1, 1, 2}), true);
  expect_meets(ground, segment({1, 1, 0.5}, {1, 1, 2}), false);
  expect_meets(ground, segment({-1, 1, 0}, {8, 1, 0}), true);
  expect_meets(ground, segment({3, 3, 0}, {8, 3, 0}), false);
  expect_meets(ground, point({1, 1, 0}), true);
  expect_meets(ground, point({4, 0, 0}), true);
  expect_meets(ground, point({1, 1, 1}), false);
  expect_meets(ground, point({3, 3, 0}), false);
  expect_meets(segment({0, 0, 0}, {2, 2, 2}), segment({0, 2, 0}, {2, 0, 2}), true);
  expect_meets(segment({0, 0, 0}, {2, 2, 2}), segment({4, 4, 4}, {2, 2, 2}), true);
  expect_meets(segment({0, 0, 0}, {2, 2, 2}), segment({4, 4, 4}, {3, 3, 3}), false);
  expect_meets(segment({0, 0, 0}, {2, 2, 2}), segment({0, 2, 0}, {2, 0, 3}), false);
  expect_meets(segment({0, 0, 0}, {2, 2, 2}), point({1, 1, 1}), true);
  expect_meets(segment({0, 0, 0}, {2, 2, 2}), point({3, 3, 3}), false);
  expect_meets(segment({0, 0, 1}, {0, 0, 3}), segment({0, 0, 4}, {0, 0, 5}), false);
  expect_meets(point({1, 2, 3}), point({1, 2, 3}), true);
  expect_meets(point({1, 2, 3}), point({1, 2, 4}), false);
}

// Small integer corners hit every degenerate relation; all 72 orders have to agree.
TEST(TriangleTest, OrderOfCornersDoesNotMatter) {
  constexpr std::uint64_t seed = 20260104;
  std::mt19937_64 engine(seed);
  const auto corner = [&] {
    return Point(static_cast<double>(engine() % 4), static_cast<double>(engine() % 4),
                 static_cast<double>(engine() % 3));
  };
  int meeting = 0;
  for (int n = 0; n < 3'000; ++n) {
    const TriangleD a = triangle(corner(), corner(), corner());
    const TriangleD b = triangle(corner(), corner(), corner());
    const bool meets = triangles_intersect(a, b);
    meeting += static_cast<int>(meets);
    expect_meets(a, b, meets);
    ASSERT_FALSE(HasFailure()) << "seed " << seed << " case " << n;
  }
  EXPECT_GT(meeting, 500);
  EXPECT_LT(meeting, 2'500);
}

}  // namespace
}  // namespace crashrank

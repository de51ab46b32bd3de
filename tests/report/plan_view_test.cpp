#include "report/plan_view.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace crashrank::detail {
namespace {

double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

TEST(ConvexHull, IsConvexAndHoldsEveryPoint) {
  std::mt19937_64 random(7);
  for (int round = 0; round < 200; ++round) {
    std::vector<Eigen::Vector2d> points;
    const std::size_t n = 1 + random() % 40;
    // Small integers: many points coincide or stand in line, and every turn is exact.
    for (std::size_t i = 0; i < n; ++i) {
      points.emplace_back(static_cast<double>(random() % 9), static_cast<double>(random() % 9));
    }
    const Outline hull = convex_hull(points);
    ASSERT_FALSE(hull.empty());
    if (hull.size() < 3) continue;
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Eigen::Vector2d& a = hull[i];
      const Eigen::Vector2d& b = hull[(i + 1) % hull.size()];
      EXPECT_GT(turn(a, b, hull[(i + 2) % hull.size()]), 0.0) << "round " << round;
      for (const Eigen::Vector2d& point : points) {
        EXPECT_GE(turn(a, b, point), 0.0) << "round " << round;
      }
    }
  }
}

TEST(ConvexHull, OfPointsInLineIsTheirEnds) {
  const Outline hull = convex_hull({{1, 1}, {3, 3}, {2, 2}, {0, 0}, {3, 3}});
  ASSERT_EQ(hull.size(), 2U);
  EXPECT_EQ(hull[0], Eigen::Vector2d(0, 0));
  EXPECT_EQ(hull[1], Eigen::Vector2d(3, 3));
}

}  // namespace
}  // namespace crashrank::detail

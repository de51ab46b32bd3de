#include "mesh/outline.hpp"

#include "mesh/profile_checks.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <random>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using Eigen::Vector2d;
using test::area_of;
using test::perimeter_of;
using test::Polygon;
using test::rectangle;

TEST(Outline, OfNothingIsNothing) {
  EXPECT_TRUE(detail::trace_outlines({}, 0.02, 0.005).empty());
  EXPECT_EQ(detail::loop_area_m2({{0, 0}, {1, 1}}), 0.0);
  EXPECT_EQ(detail::loop_area_m2({{0, 0}, {2, 0}, {0, 1}}), 1.0);
  EXPECT_EQ(detail::loop_area_m2({{0, 1}, {2, 0}, {0, 0}}), -1.0);
}

TEST(Outline, OfAPointOrALineEnclosesNothing) {
  const detail::SectionSegment point{Vector2d(1.0, 2.0), Vector2d(1.0, 2.0)};
  EXPECT_TRUE(detail::trace_outlines({point}, 0.02, 0.005).empty());
  const detail::SectionSegment line{Vector2d(1.0, 2.0), Vector2d(4.0, -2.0)};
  const std::vector<detail::OutlineLoop> loops = detail::trace_outlines({line}, 0.02, 0.005);
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_NEAR(perimeter_of(loops[0]), 10.0, 0.01);
  EXPECT_NEAR(detail::loop_area_m2(loops[0]), 0.0, 1e-12);
}

TEST(Outline, OfAnObliqueSheetIsOne) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> coordinate(-3.0, 3.0);
  for (int i = 0; i < 100; ++i) {
    const detail::SectionSegment line{Vector2d(coordinate(random), coordinate(random)),
                                      Vector2d(coordinate(random), coordinate(random))};
    const std::vector<detail::OutlineLoop> loops = detail::trace_outlines({line}, 0.02, 0.005);
    ASSERT_EQ(loops.size(), 1U) << line[0].transpose() << ", " << line[1].transpose();
    EXPECT_NEAR(perimeter_of(loops[0]), 2.0 * (line[1] - line[0]).norm(), 0.02);
  }
}

TEST(Outline, GoesRoundWithTheBodyToItsLeft) {
  const Polygon base = rectangle(0, 0, 3, 1);
  std::vector<detail::SectionSegment> segments;
  for (std::size_t i = 0; i < base.size(); ++i) segments.push_back({base[i], base[(i + 1) % 4]});
  // Neither the order nor the direction of the segments matters.
  std::swap(segments[0], segments[2]);
  std::swap(segments[1][0], segments[1][1]);
  const std::vector<detail::OutlineLoop> loops = detail::trace_outlines(segments, 0.02, 0.005);
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_NEAR(area_of(loops[0]), 3.0, 1e-3);
  EXPECT_NEAR(detail::loop_area_m2(loops[0]), 3.0, 1e-3);
  EXPECT_LE(loops[0].size(), 8U);
}

}  // namespace
}  // namespace crashrank

#include "crashrank/base/area.hpp"

#include "oracle/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

namespace {

using namespace crashrank;
using Eigen::Vector2d;
using Ring = std::vector<Vector2d>;

/// A ring that winds once around the origin, its corners at rising angles; with six and more no
/// edge comes nearer than half of the least radius.
Ring star(oracle::Random& random, double least_m, double most_m) {
  const auto corners = static_cast<std::size_t>(random.integer(6, 20));
  Ring ring;
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * (static_cast<double>(i) + random.real(0.1, 0.9)) /
                         static_cast<double>(corners);
    ring.push_back(random.real(least_m, most_m) * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return ring;
}

/// The angle that a ring turns around a point, in turns.
double winding(const Ring& ring, const Vector2d& point) {
  double sum = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector2d a = ring[i] - point;
    const Vector2d b = ring[(i + 1) % ring.size()] - point;
    sum += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  }
  return sum / (2.0 * std::numbers::pi);
}

TEST(Area, HoldsWhatItsBorderWindsAround) {
  int inside = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    oracle::Random random(seed);
    const Area area{star(random, 5.0, 10.0), {star(random, 1.0, 2.0)}};
    ASSERT_TRUE(check_area(area, "area").ok());
    const std::vector<Area> areas{area};
    for (int i = 0; i < 50; ++i) {
      const Vector2d point(random.real(-10.0, 10.0), random.real(-10.0, 10.0));
      const bool expected = std::abs(winding(area.outer, point)) > 0.5 &&
                            std::abs(winding(area.holes[0], point)) < 0.5;
      ASSERT_EQ(holds(areas, point), expected) << point.transpose();
      inside += expected ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 1000);
}

TEST(Area, PointsOfACommonEdgeBelongToOneArea) {
  oracle::Random random(7);
  const std::vector<Area> left{{{{0, 0}, {3, 1}, {2, 4}, {-1, 5}}, {}}};
  const std::vector<Area> right{{{{3, 1}, {8, 0}, {9, 6}, {2, 4}}, {}}};
  for (int i = 0; i < 1000; ++i) {
    const double share = random.real(0.001, 0.999);
    const Vector2d point = (1.0 - share) * Vector2d(3, 1) + share * Vector2d(2, 4);
    EXPECT_NE(holds(left, point), holds(right, point)) << share;
  }
}

TEST(Area, TellsTheDistanceToItsBorder) {
  oracle::Random random(3);
  const Area area{star(random, 5.0, 10.0), {star(random, 1.0, 2.0)}};
  const std::vector<Area> areas{area};
  for (int i = 0; i < 100; ++i) {
    const Vector2d point(random.real(-12.0, 12.0), random.real(-12.0, 12.0));
    double least = 1e9;
    for (const Ring& ring : {area.outer, area.holes[0]}) {
      for (std::size_t k = 0; k < ring.size(); ++k) {
        for (int part = 0; part <= 2000; ++part) {
          const double share = part / 2000.0;
          const Vector2d at = (1.0 - share) * ring[k] + share * ring[(k + 1) % ring.size()];
          least = std::min(least, (at - point).norm());
        }
      }
    }
    EXPECT_NEAR(distance_to_border_m(areas, point), least, 0.01);
  }
  EXPECT_TRUE(std::isinf(distance_to_border_m({}, {0.0, 0.0})));
}

struct Unsound {
  const char* why;
  Area area;
  const char* place;
};

TEST(Area, RefusesWhatIsNoArea) {
  const Ring square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  const std::vector<Unsound> all{
      {"two corners", {{{0, 0}, {1, 0}}, {}}, "road.outer"},
      {"an hourglass", {{{0, 0}, {4, 4}, {4, 0}, {0, 4}}, {}}, "road.outer"},
      {"a spike", {{{0, 0}, {4, 0}, {6, 0}, {4, 0.0}, {4, 4}, {0, 4}}, {}}, "road.outer"},
      {"a corner twice", {{{0, 0}, {4, 0}, {4, 0}, {4, 4}}, {}}, "road.outer[1]"},
      {"a corner on an edge", {{{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}}, {}}, "road.outer"},
      {"all on a line", {{{0, 0}, {2, 0}, {4, 0}}, {}}, "road.outer"},
      {"a hole across the border", {square, {{{3, 3}, {5, 3}, {5, 5}}}}, "road.outer"},
      {"a hole that crosses itself", {square, {{{1, 1}, {3, 3}, {3, 1}, {1, 3}}}}, "road.holes[0]"},
      {"holes in each other",
       {square, {{{1, 1}, {3, 1}, {3, 3}}, {{2, 1}, {3.5, 2}, {2, 3}}}},
       "road.holes[0]"},
      {"a hole outside",
       {square, {{{1, 1}, {3, 1}, {3, 3}}, {{5, 1}, {6, 1}, {6, 2}}}},
       "road.holes[1]"},
      {"a hole around all", {square, {{{-1, -1}, {5, -1}, {5, 5}, {-1, 5}}}}, "road.holes[0]"},
      {"no number", {{{0, 0}, {4, NAN}, {4, 4}}, {}}, "road.outer"},
  };
  for (const Unsound& each : all) {
    const Status status = check_area(each.area, "road");
    ASSERT_FALSE(status.ok()) << each.why;
    EXPECT_EQ(status.error().code, ErrorCode::bad_input) << each.why;
    EXPECT_EQ(status.error().place, each.place) << each.why << ": " << status.error().message();
  }
  EXPECT_TRUE(check_area({square, {{{1, 1}, {3, 1}, {3, 3}}}}, "road").ok());
}

}  // namespace

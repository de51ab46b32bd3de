#include "mesh/importer/polygon.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace crashrank::importer {
namespace {

// Corners of integers below 2^24, so that areas are exact in 64-bit integers.
using Point = std::pair<std::int64_t, std::int64_t>;
using Polygon = std::vector<Point>;

std::int64_t doubled_area(const Point& a, const Point& b, const Point& c) {
  return (b.first - a.first) * (c.second - a.second) - (b.second - a.second) * (c.first - a.first);
}

std::int64_t doubled_area(const Polygon& polygon) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& a = polygon[i];
    const Point& b = polygon[(i + 1) % polygon.size()];
    sum += a.first * b.second - a.second * b.first;
  }
  return sum;
}

// Planes into which a polygon is put: the three of the axes and an inclined one.
Eigen::Vector3d placed(const Point& point, int plane) {
  const auto x = static_cast<double>(point.first);
  const auto y = static_cast<double>(point.second);
  switch (plane) {
    case 0:
      return {x, y, 7.0};
    case 1:
      return {-3.0, x, y};
    case 2:
      return {y, 1.0, x};
    default:
      return {x, y, x + 2.0 * y};
  }
}

/// Whether the triangles have the polygon's orientation and its whole area, in every plane, both
/// orientations and from several first corners.
void expect_covered(const Polygon& polygon) {
  PolygonTriangulator triangulator;
  for (int variant = 0; variant < 24; ++variant) {
    Polygon turned;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const std::size_t from = polygon.size() * static_cast<std::size_t>(variant / 8) / 3;
      turned.push_back(polygon[(i + from) % polygon.size()]);
    }
    if (variant % 2 == 1) std::reverse(turned.begin(), turned.end());
    std::vector<Eigen::Vector3d> corners;
    for (const Point& point : turned) corners.push_back(placed(point, variant / 2 % 4));
    ASSERT_TRUE(triangulator.triangulate(corners)) << "variant " << variant;
    ASSERT_EQ(triangulator.triangles().size(), polygon.size() - 2);
    const std::int64_t whole = doubled_area(turned);
    std::int64_t sum = 0;
    for (const auto& t : triangulator.triangles()) {
      const std::int64_t area = doubled_area(turned[t[0]], turned[t[1]], turned[t[2]]);
      ASSERT_GE(whole > 0 ? area : -area, 0) << "variant " << variant;
      sum += area;
    }
    ASSERT_EQ(sum, whole) << "variant " << variant;
  }
}

std::vector<PolygonTriangulator::Corners> triangles_of(const Polygon& polygon, bool simple = true) {
  std::vector<Eigen::Vector3d> corners;
  for (const Point& point : polygon) corners.push_back(placed(point, 0));
  PolygonTriangulator triangulator;
  EXPECT_EQ(triangulator.triangulate(corners), simple);
  return triangulator.triangles();
}

// In how many of the triangles a point lies that is on none of their lines.
std::size_t times_covered(const Polygon& polygon,
                          const std::vector<PolygonTriangulator::Corners>& triangles,
                          const Point& point) {
  std::size_t count = 0;
  for (const auto& t : triangles) {
    const bool a = doubled_area(polygon[t[0]], polygon[t[1]], point) > 0;
    const bool b = doubled_area(polygon[t[1]], polygon[t[2]], point) > 0;
    const bool c = doubled_area(polygon[t[2]], polygon[t[0]], point) > 0;
    count += a == b && b == c ? 1 : 0;
  }
  return count;
}

using Cells = std::set<Point>;

// The outline of unit cells, counter-clockwise; empty unless it is one loop that visits every
// corner once.
Polygon outline(const Cells& cells) {
  std::map<Point, Point> next;
  const auto add = [&](const Point& from, const Point& to) {
    return next.emplace(from, to).second;
  };
  for (const auto& [x, y] : cells) {
    const auto free = [&](std::int64_t dx, std::int64_t dy) {
      return cells.count({x + dx, y + dy}) == 0;
    };
    if (free(0, -1) && !add({x, y}, {x + 1, y})) return {};
    if (free(1, 0) && !add({x + 1, y}, {x + 1, y + 1})) return {};
    if (free(0, 1) && !add({x + 1, y + 1}, {x, y + 1})) return {};
    if (free(-1, 0) && !add({x, y + 1}, {x, y})) return {};
  }
  Polygon loop{next.begin()->first};
  while (next.at(loop.back()) != loop.front()) loop.push_back(next.at(loop.back()));
  return loop.size() == next.size() ? loop : Polygon{};
}

Cells random_cells(std::mt19937_64& random, std::size_t count) {
  Cells cells{{0, 0}};
  while (cells.size() < count) {
    auto cell = cells.begin();
    std::advance(cell, static_cast<long>(random() % cells.size()));
    const std::uint64_t way = random() % 4;
    const std::int64_t step = way % 2 == 0 ? 1 : -1;
    cells.insert(way < 2 ? Point{cell->first + step, cell->second}
                         : Point{cell->first, cell->second + step});
  }
  return cells;
}

TEST(Polygon, RandomRightAngledOnesAreCoveredExactly) {
  constexpr unsigned seed = 20261128;
  std::cout << "seed " << seed << '\n';
  std::mt19937_64 random(seed);
  int polygons = 0;
  std::size_t corners = 0;
  while (polygons < 300) {
    const Cells cells = random_cells(random, 3 + random() % 40);
    const Polygon unit = outline(cells);
    if (unit.empty()) continue;
    // Corners on straight edges stay in half of the polygons. Cells are 4 wide.
    Polygon polygon;
    for (std::size_t i = 0; i < unit.size(); ++i) {
      const Point& before = unit[(i + unit.size() - 1) % unit.size()];
      const bool straight =
          doubled_area(before, unit[i], unit[(i + 1) % unit.size()]) == 0 && polygons % 2 == 0;
      if (!straight) polygon.emplace_back(4 * unit[i].first, 4 * unit[i].second);
    }
    SCOPED_TRACE(polygons);
    ASSERT_EQ(doubled_area(polygon), 32 * static_cast<std::int64_t>(cells.size()));
    expect_covered(polygon);
    const auto triangles = triangles_of(polygon);
    for (std::int64_t x = -45; x < 45; ++x) {
      for (std::int64_t y = -45; y < 45; ++y) {
        // 1000 times finer, off every line through corners.
        Polygon fine;
        for (const Point& p : polygon) fine.emplace_back(1000 * p.first, 1000 * p.second);
        const Point point{4000 * x + 1237, 4000 * y + 1789};
        if (cells.count({x, y}) == 0 && (x + y) % 7 != 0) continue;
        ASSERT_EQ(times_covered(fine, triangles, point), cells.count({x, y}));
      }
    }
    corners += polygon.size();
    ++polygons;
  }
  std::cout << polygons << " polygons of " << corners << " corners\n";
}

TEST(Polygon, RandomStarsAreCoveredExactly) {
  std::mt19937_64 random(7);
  for (int round = 0; round < 100; ++round) {
    SCOPED_TRACE(round);
    const std::size_t corners = 4 + random() % 200;
    Polygon star;
    for (std::size_t i = 0; i < corners; ++i) {
      const double angle =
          6.283185307179586 * static_cast<double>(i) / static_cast<double>(corners);
      const double radius = 1e4 + static_cast<double>(random() % 1'000'000);
      star.emplace_back(std::llround(radius * std::cos(angle)),
                        std::llround(radius * std::sin(angle)));
    }
    expect_covered(star);
    const auto triangles = triangles_of(star);
    for (int sample = 0; sample < 50; ++sample) {
      const Point point{static_cast<std::int64_t>(random() % 2'000'000) - 1'000'000,
                        static_cast<std::int64_t>(random() % 2'000'000) - 1'000'000};
      bool inside = false;
      for (std::size_t i = 0; i < corners; ++i) {
        const Point& a = star[i];
        const Point& b = star[(i + 1) % corners];
        if ((a.second > point.second) == (b.second > point.second)) continue;
        inside ^= (doubled_area(a, b, point) > 0) == (b.second > a.second);
      }
      EXPECT_EQ(times_covered(star, triangles, point), inside ? 1U : 0U);
    }
  }
}

// A corridor of width 1 that winds inwards in right angles, walls 2 apart.
Polygon spiral(std::int64_t turns) {
  Polygon outer{{0, 0}};
  Polygon inner;
  std::int64_t x = 0;
  std::int64_t y = 0;
  const std::int64_t longest = 4 * turns;
  for (std::int64_t i = 0; i < 2 * turns; ++i) {
    const std::int64_t length = longest - 2 * (i / 2);
    const std::int64_t dx = i % 4 == 0 ? 1 : i % 4 == 2 ? -1 : 0;
    const std::int64_t dy = i % 4 == 1 ? 1 : i % 4 == 3 ? -1 : 0;
    x += dx * length;
    y += dy * length;
    outer.emplace_back(x, y);
    // The inner corner lies left of this edge and of the next one.
    const bool last = i + 1 == 2 * turns;
    inner.emplace_back(x - dy - (last ? 0 : dx), y + dx - (last ? 0 : dy));
  }
  outer.insert(outer.end(), inner.rbegin(), inner.rend());
  outer.emplace_back(0, 1);
  return outer;
}

TEST(Polygon, SpiralsAreCoveredExactly) {
  for (const std::int64_t turns : {2, 3, 10, 101}) {
    SCOPED_TRACE(turns);
    expect_covered(spiral(turns));
  }
}

TEST(Polygon, HolesJoinedByEdgesThereAndBackStayOpen) {
  // One hole, entered from a corner; two from one corner; one that touches the outline.
  const Polygon one{{0, 0}, {9, 0}, {9, 9}, {0, 9}, {0, 0}, {3, 3}, {3, 6}, {6, 6}, {6, 3}, {3, 3}};
  ASSERT_EQ(doubled_area(one), 2 * (81 - 9));
  expect_covered(one);
  const Polygon two{{0, 0}, {20, 0}, {20, 9}, {0, 9},  {0, 0},  {3, 3},  {3, 6},  {6, 6},
                    {6, 3}, {3, 3},  {0, 0},  {12, 2}, {12, 4}, {15, 4}, {15, 2}, {12, 2}};
  expect_covered(two);
  const Polygon touching{{0, 0}, {8, 0}, {8, 8}, {4, 8}, {6, 4}, {4, 2}, {2, 4}, {4, 8}, {0, 8}};
  ASSERT_EQ(doubled_area(touching), 2 * (64 - 12));
  expect_covered(touching);
  // A grid of holes, each joined to the one before.
  Polygon grid{{0, 0}, {100, 0}, {100, 10}, {0, 10}};
  std::vector<Point> back;
  for (std::int64_t hole = 0; hole < 9; ++hole) {
    const std::int64_t x = 5 + 10 * hole;
    grid.insert(grid.end(), {{x, 3}, {x, 6}, {x + 4, 6}});
    back.insert(back.begin(), {{x + 4, 6}, {x + 4, 3}, {x, 3}});
  }
  grid.insert(grid.begin() + 4, Point{0, 3});
  grid.insert(grid.end(), back.begin(), back.end());
  grid.emplace_back(0, 3);
  ASSERT_EQ(doubled_area(grid), 2 * (1000 - 9 * 12));
  expect_covered(grid);
}

TEST(Polygon, ConvexOnesAreFansInTheStatedOrder) {
  using T = std::vector<PolygonTriangulator::Corners>;
  EXPECT_EQ(triangles_of({{0, 0}, {4, 0}, {4, 4}, {0, 4}}), (T{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(triangles_of({{0, 0}, {4, 0}, {1, 1}, {0, 4}}), (T{{2, 3, 0}, {2, 0, 1}}));
  EXPECT_EQ(triangles_of({{0, 0}, {4, 0}, {5, 3}, {2, 5}, {-1, 3}}),
            (T{{4, 0, 1}, {4, 1, 2}, {2, 3, 4}}));
  EXPECT_EQ(triangles_of({{-1, 3}, {2, 5}, {5, 3}, {4, 0}, {0, 0}}),
            (T{{4, 0, 1}, {4, 1, 2}, {2, 3, 4}}));
}

TEST(Polygon, CrossingOnesAreDetected) {
  triangles_of({{0, 0}, {4, 4}, {4, 0}, {0, 4}}, false);
  triangles_of({{0, 0}, {6, 9}, {12, 0}, {-1, 6}, {13, 6}}, false);        // pentagram
  triangles_of({{0, 0}, {8, 0}, {8, 8}, {4, -2}, {0, 8}}, false);          // a corner sticks out
  triangles_of({{0, 0}, {8, 0}, {8, 8}, {4, 0}, {4, -4}, {2, 8}}, false);  // through a side's edge
  triangles_of({{0, 0}, {4, 4}, {8, 8}, {8, 0}, {4, 4}, {0, 8}}, false);   // through a corner
}

TEST(Polygon, DegenerateOnesKeepTheirNumberOfTriangles) {
  triangles_of({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}});
  triangles_of({{0, 0}, {0, 0}, {0, 0}, {0, 0}});
  expect_covered({{0, 0}, {4, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}});
  expect_covered({{0, 0}, {4, 0}, {9, 0}, {4, 0}, {4, 4}});  // a spike
  expect_covered({{0, 0}, {2, 0}, {4, 0}, {4, 2}, {4, 4}, {2, 4}, {0, 4}, {0, 2}});
}

TEST(Polygon, TenThousandCornersTakeASecond) {
  std::mt19937_64 random(3);
  std::vector<Eigen::Vector3d> comb;
  std::vector<Eigen::Vector3d> crossing;
  std::vector<Eigen::Vector3d> star;
  for (int i = 0; i < 9'998; ++i) {
    comb.emplace_back(i, i % 2 == 0 ? 0.0 : 1e5 + i, 0.0);
    crossing.emplace_back(random() % 1000, random() % 1000, 0.0);
    const double radius = 1.0 + static_cast<double>(random() % 1000);
    star.emplace_back(radius * std::cos(6.283185307179586e-4 * i),
                      radius * std::sin(6.283185307179586e-4 * i), 0.0);
  }
  comb.emplace_back(9'998.0, -9.0, 0.0);
  comb.emplace_back(-1.0, -9.0, 0.0);
  std::vector<Eigen::Vector3d> wound;
  for (const Point& point : spiral(2'499)) wound.push_back(placed(point, 0));
  PolygonTriangulator triangulator;
  const auto seconds = [&](const std::vector<Eigen::Vector3d>& corners, bool simple) {
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(triangulator.triangulate(corners), simple);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    std::cout << corners.size() << " corners: " << took.count() << " s\n";
    EXPECT_LT(took.count(), 10.0);  // about 0.1 s; n³ would be minutes
  };
  seconds(comb, true);
  seconds(star, true);
  seconds(wound, true);
  seconds(crossing, false);
}

}  // namespace
}  // namespace crashrank::importer

#include "car.hpp"
#include "curve.hpp"
#include "mesh.hpp"
#include "solids.hpp"
#include "surface.hpp"
#include "tidy.hpp"
#include "wheel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace {

using generate::Mesh;
using generate::Vec2;
using generate::Vec3;

// How many times each edge is walked, one way less the other: nothing is left over on a closed
// surface whose triangles all wind the same way. Corners are welded by place.
bool closed_and_oriented(const Mesh& mesh) {
  using Place = std::array<long, 3>;
  const auto place = [&](int index) {
    const Vec3& p = mesh.vertices[static_cast<std::size_t>(index)];
    return Place{std::lround(p.x() * 1e6), std::lround(p.y() * 1e6), std::lround(p.z() * 1e6)};
  };
  std::map<std::pair<Place, Place>, int> balance;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Place a = place(t[k]);
      const Place b = place(t[(k + 1) % 3]);
      if (a == b) continue;
      if (a < b) {
        ++balance[{a, b}];
      } else {
        --balance[{b, a}];
      }
    }
  }
  for (const auto& [edge, count] : balance) {
    if (count != 0) return false;
  }
  return true;
}

double volume(const Mesh& mesh) {
  double six_times = 0.0;
  for (const auto& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[static_cast<std::size_t>(t[0])];
    const Vec3& b = mesh.vertices[static_cast<std::size_t>(t[1])];
    const Vec3& c = mesh.vertices[static_cast<std::size_t>(t[2])];
    six_times += a.dot(b.cross(c));
  }
  return six_times / 6.0;
}

TEST(UnitCircle, AgreesWithTheLibrary) {
  for (int i = -400; i <= 400; ++i) {
    const double turns = i / 173.0;
    const Vec2 p = generate::unit_circle(turns);
    EXPECT_NEAR(p.x(), std::cos(2.0 * M_PI * turns), 1e-14);
    EXPECT_NEAR(p.y(), std::sin(2.0 * M_PI * turns), 1e-14);
  }
}

TEST(Outline, DistanceIsThatOfItsNearestSegment) {
  const generate::Outline outline({{0, 0}, {2, 0.2}, {2.4, 1}, {1, 0.7}, {0.2, 1.5}});
  const std::vector<Vec2>& points = outline.points();
  for (int i = 0; i < 60; ++i) {
    for (int j = 0; j < 60; ++j) {
      const Vec2 p(-1.0 + 0.075 * i, -1.0 + 0.061 * j);
      double nearest = std::numeric_limits<double>::infinity();
      double winding = 0.0;
      for (std::size_t s = 0; s < points.size(); ++s) {
        const Vec2 a = points[s] - p;
        const Vec2 b = points[(s + 1) % points.size()] - p;
        const Vec2 d = b - a;
        const double t = std::clamp(-a.dot(d) / d.squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (a + t * d).norm());
        winding += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
      }
      const double expected = std::abs(winding) > 3.0 ? -nearest : nearest;
      EXPECT_NEAR(outline.distance(p), expected, 1e-12) << p.transpose();
    }
  }
}

TEST(Ramp, StaysBetweenItsKnots) {
  const generate::Ramp ramp = {{0.0, 1.0}, {1.0, 2.0}, {1.5, 2.0}, {3.0, 0.5}};
  EXPECT_EQ(ramp(-1.0), 1.0);
  EXPECT_EQ(ramp(5.0), 0.5);
  EXPECT_DOUBLE_EQ(ramp(1.0), 2.0);
  for (double x = 0.0; x <= 3.0; x += 0.01) {
    EXPECT_GE(ramp(x), 0.5);
    EXPECT_LE(ramp(x), 2.0 + 1e-12);
  }
}

TEST(Solids, AreClosedAndOfTheRightVolume) {
  const Mesh sharp = generate::box({1, 2, 3}, {0.5, 0.4, 0.3}, 0.0, 0.11);
  EXPECT_TRUE(closed_and_oriented(sharp));
  EXPECT_NEAR(volume(sharp), 8 * 0.5 * 0.4 * 0.3, 1e-12);
  const Mesh round = generate::box({0, 0, 0}, {0.5, 0.4, 0.3}, 0.1, 0.01);
  EXPECT_TRUE(closed_and_oriented(round));
  // Minkowski sum of a box and a ball.
  const double flat = 8 * 0.4 * 0.3 * 0.2 + 8 * 0.1 * (0.4 * 0.3 + 0.3 * 0.2 + 0.4 * 0.2);
  const double bent = M_PI * 0.01 * 2 * (0.4 + 0.3 + 0.2) + 4.0 / 3.0 * M_PI * 0.001;
  EXPECT_NEAR(volume(round), flat + bent, 1e-3 * (flat + bent));
  const Mesh bar = generate::bar({0, 0, 0}, {1, 2, 2}, 0.2, 0.1, 0.01);
  EXPECT_TRUE(closed_and_oriented(bar));
  EXPECT_NEAR(volume(bar), M_PI * 3.0 / 3.0 * (0.04 + 0.02 + 0.01), 1e-3);
  const Mesh prism = generate::prism({{0, 0}, {2, 0}, {2, 1}, {0, 1}}, -1.0, 3.0, 0.3);
  EXPECT_TRUE(closed_and_oriented(prism));
  EXPECT_NEAR(volume(prism), 8.0, 1e-9);
  const generate::Wheel wheel = generate::wheel({0, 0, 0.3}, 0.3, 0.2, 0.2, 5, 0.05);
  EXPECT_TRUE(closed_and_oriented(wheel.tyre));
  EXPECT_TRUE(closed_and_oriented(wheel.rim));
  EXPECT_GT(volume(wheel.tyre), 0.0);
  EXPECT_GT(volume(wheel.rim), 0.0);
}

TEST(Surface, OfABallIsClosedAndConverges) {
  const generate::Field ball = [](const Vec3& p) { return (p - Vec3(0.1, 0, 0.2)).norm() - 1.0; };
  double last_error = 1.0;
  for (const double edge : {0.2, 0.1, 0.05}) {
    const Mesh mesh =
        generate::extract_surface(ball, Vec3::Constant(-1.5), Vec3::Constant(1.5), edge);
    EXPECT_TRUE(closed_and_oriented(mesh));
    const double error = std::abs(volume(mesh) / (4.0 / 3.0 * M_PI) - 1.0);
    EXPECT_LT(error, 0.35 * last_error) << edge;
    last_error = error;
  }
}

TEST(Car, BodyIsOneClosedSurfaceThatConverges) {
  for (const generate::CarDesign& design : {generate::hatch_design(), generate::sedan_design()}) {
    const generate::Field body = generate::car_body(design);
    const Vec3 low(-1.3, -1.05, 0.05);
    const Vec3 high(design.wheelbase + 1.2, 1.05, 1.65);
    const Mesh coarse = generate::extract_surface(body, low, high, 0.10);
    const Mesh fine = generate::extract_surface(body, low, high, 0.06);
    EXPECT_TRUE(closed_and_oriented(coarse));
    EXPECT_TRUE(closed_and_oriented(fine));
    EXPECT_GT(volume(fine), 6.0);
    EXPECT_NEAR(volume(coarse), volume(fine), 0.02 * volume(fine));
  }
}

TEST(Tidy, TakesNeedlesOutAndKeepsShapeAndSeams) {
  // A unit square in two labelled halves, each a fan with a needle and a short edge in it.
  Mesh mesh;
  mesh.vertices = {{0, 0, 0},   {1, 0, 0},      {1, 1, 0},      {0, 1, 0},       {0.5, 0, 0},
                   {0.5, 1, 0}, {0.25, 0.5, 0}, {0.26, 0.5, 0}, {0.75, 0.001, 0}};
  mesh.triangles = {{0, 4, 6}, {4, 7, 6}, {4, 5, 7}, {5, 6, 7}, {5, 3, 6},
                    {3, 0, 6}, {4, 1, 8}, {1, 2, 8}, {2, 5, 8}, {5, 4, 8}};
  std::vector<int> label = {0, 0, 0, 0, 0, 0, 1, 1, 1, 1};
  generate::tidy(&mesh, &label, 0.05);
  ASSERT_EQ(mesh.triangles.size(), label.size());
  EXPECT_LT(mesh.triangles.size(), 10U);
  double area[2] = {0.0, 0.0};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto corner = [&](std::size_t k) {
      return mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k])];
    };
    const double twice = (corner(1) - corner(0)).cross(corner(2) - corner(0)).z();
    EXPECT_GT(twice, 0.0);
    area[label[t]] += 0.5 * twice;
  }
  EXPECT_NEAR(area[0], 0.5, 1e-12);
  EXPECT_NEAR(area[1], 0.5, 1e-12);
}

}  // namespace

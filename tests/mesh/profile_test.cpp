#include "crashrank/mesh/profile.hpp"

#include "mesh/profile_checks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>

namespace crashrank {
namespace {

using Eigen::Vector2d;
using test::add_prism;
using test::add_wall;
using test::area_of;
using test::Band;
using test::band_of;
using test::circle;
using test::expect_sound;
using test::perimeter_of;
using test::pi;
using test::Polygon;
using test::prism;
using test::profile_of;
using test::rectangle;

TEST(Profile, OfABoxHasItsAreaAndPerimeterInTheBandsThatItSpans) {
  const Profile profile = profile_of(prism(rectangle(-1.0, -0.9, 3.5, 0.9), 0.2, 1.5));
  expect_sound(profile);
  EXPECT_EQ(profile.ground_m, 0.0);
  double volume = 0.0;
  for (std::size_t i = 0; i < profile_bands; ++i) {
    const Band band = band_of(profile, i);
    const double low = std::max(0.2, profile_edges_m[i]);
    const double high = std::min(1.5, profile_edges_m[i + 1]);
    if (!(low < high)) {
      EXPECT_TRUE(band.pieces.empty()) << "band " << i;
      EXPECT_EQ(band.area_m2, 0.0);
      continue;
    }
    EXPECT_EQ(band.outlines(), 1);
    const double taken = (high - low) / band_height_m(i);
    EXPECT_NEAR(band.area_m2, taken * 4.5 * 1.8, 1e-3 * 4.5 * 1.8) << "band " << i;
    EXPECT_NEAR(band.area_of_pieces(), 4.5 * 1.8, 1e-3 * 4.5 * 1.8) << "band " << i;
    EXPECT_NEAR(static_cast<double>(band.heights().low_m), low, 1e-6);
    EXPECT_NEAR(static_cast<double>(band.heights().high_m), high, 1e-6);
    EXPECT_NEAR(band.length(), 2.0 * (4.5 + 1.8), 1e-3 * 12.6) << "band " << i;
    EXPECT_GE(band.pieces.size(), static_cast<std::size_t>(12.6 / longest_piece_m));
    for (const OutlinePiece& piece : band.pieces) {
      EXPECT_LE(static_cast<double>(piece.length_m), longest_piece_m * 1.00001);
    }
    volume += 4.5 * 1.8 * (high - low);
  }
  EXPECT_NEAR(profile.volume_m3(), volume, 1e-3 * volume);
}

TEST(Profile, OfACylinderIsRoundAndItsNormalsPointAwayFromItsAxis) {
  const Vector2d axis(12.0, -3.0);
  for (const double radius : {0.05, 0.127, 0.5, 2.0, 6.0}) {
    const Profile profile = profile_of(prism(circle(axis, radius, 96), 0.0, 5.0));
    expect_sound(profile);
    for (std::size_t i = 0; i < profile_bands; ++i) {
      const Band band = band_of(profile, i);
      EXPECT_EQ(band.outlines(), 1);
      EXPECT_NEAR(band.area_m2, pi * radius * radius, 0.02 * pi * radius * radius) << radius;
      EXPECT_NEAR(band.length(), 2.0 * pi * radius, 0.02 * 2.0 * pi * radius) << radius;
      for (const OutlinePiece& piece : band.pieces) {
        const Vector2d outward =
            (Eigen::Vector2f(piece.x, piece.y).cast<double>() - axis).normalized();
        const Vector2d normal = Eigen::Vector2f(piece.normal_x, piece.normal_y).cast<double>();
        EXPECT_GT(normal.dot(outward), 0.9) << radius;
      }
    }
  }
}

TEST(Profile, KeepsTheConcavityOfAnLShape) {
  const Polygon corner{{0, 0}, {4, 0}, {4, 0.5}, {0.5, 0.5}, {0.5, 3}, {0, 3}};
  const Profile profile = profile_of(prism(corner, 0.0, 0.8));
  expect_sound(profile);
  const Band band = band_of(profile, 1);
  EXPECT_EQ(band.outlines(), 1);
  EXPECT_NEAR(band.area_m2, area_of(corner), 0.005 * area_of(corner));
  EXPECT_NEAR(band.length(), perimeter_of(corner), 0.005 * perimeter_of(corner));
  EXPECT_NEAR(band.winding({2.0, 2.0}), 0.0, 1e-6);
  EXPECT_NEAR(band.winding({0.25, 2.0}), 1.0, 1e-6);
}

TEST(Profile, KeepsTheConcavityOfACurvedBarrier) {
  constexpr double inner = 9.7;
  constexpr double outer = 10.0;
  Polygon arc;
  for (int i = 0; i <= 60; ++i) {
    const double angle = pi * i / 60.0;
    arc.emplace_back(outer * std::cos(angle), outer * std::sin(angle));
  }
  for (int i = 60; i >= 0; --i) {
    const double angle = pi * i / 60.0;
    arc.emplace_back(inner * std::cos(angle), inner * std::sin(angle));
  }
  const Profile profile = profile_of(prism(arc, 0.0, 1.0));
  expect_sound(profile);
  for (std::size_t i = 0; i < 6; ++i) {
    const Band band = band_of(profile, i);
    EXPECT_EQ(band.outlines(), 1);
    EXPECT_NEAR(band.area_m2, area_of(arc), 0.02 * area_of(arc));
    EXPECT_NEAR(band.winding({0.0, 5.0}), 0.0, 1e-6);
  }
}

TEST(Profile, OfTwoBoxesIsTwoOutlinesUnlessTheyNearlyTouch) {
  for (const double gap : {0.01, 0.03, 0.1, 2.0}) {
    TriangleMesh mesh = prism(rectangle(-3, -1, 0, 1), 0.0, 1.0);
    add_prism(mesh, rectangle(gap, -1, gap + 3, 1), 0.0, 1.0);
    const Profile profile = profile_of(mesh);
    expect_sound(profile);
    const Band band = band_of(profile, 0);
    const bool apart = gap > 0.09;
    EXPECT_EQ(band.outlines(), apart ? 2 : 1) << gap;
    EXPECT_NEAR(band.area_m2, 12.0, 0.1) << gap;
    EXPECT_NEAR(band.length(), apart ? 20.0 : 16.0, 0.2) << gap;
  }
}

TEST(Profile, LeavesOutWhatLiesInside) {
  TriangleMesh mesh = prism(rectangle(-2, -1, 2, 1), 0.0, 1.0);
  add_prism(mesh, rectangle(-1, -0.5, 1, 0.5), 0.0, 1.0);
  add_wall(mesh, {-2, -1}, {2, 1}, 0.0, 1.0);
  const Band band = band_of(profile_of(mesh), 2);
  EXPECT_EQ(band.outlines(), 1);
  EXPECT_NEAR(band.area_m2, 8.0, 0.01);
  EXPECT_NEAR(band.length(), 12.0, 0.02);
}

// Slits are closed; through a door the outline follows the wall on the inside.
TEST(Profile, OfAnOpenShellClosesSmallHoles) {
  for (const double hole : {0.0, 0.02, 0.6}) {
    TriangleMesh mesh;
    const Polygon walls = rectangle(0, 0, 6, 2);
    for (std::size_t i = 0; i < 3; ++i) add_wall(mesh, walls[i], walls[i + 1], 0.0, 1.0);
    add_wall(mesh, {0, 2}, {0, 1 + 0.5 * hole}, 0.0, 1.0);
    add_wall(mesh, {0, 1 - 0.5 * hole}, {0, 0}, 0.0, 1.0);
    // Beside it, so that there is a profile in any case.
    add_prism(mesh, rectangle(8, 0, 9, 1), 0.0, 1.0);
    const Profile profile = profile_of(mesh);
    for (std::size_t i = 0; i < 6; ++i) {
      const Band band = band_of(profile, i);
      EXPECT_EQ(band.outlines(), 2) << hole;
      EXPECT_NEAR(band.area_m2, hole < 0.1 ? 13.0 : 1.0, 0.05) << hole;
      EXPECT_NEAR(band.length(), 4.0 + (hole < 0.1 ? 16.0 : 2.0 * (16.0 - hole)), 0.2) << hole;
      EXPECT_LE(band.opening().norm(), 1e-4);
    }
    EXPECT_TRUE(band_of(profile, 6).pieces.empty());
  }
}

TEST(Profile, StandsOnTheLowestPointOfABodyBelowTheGround) {
  const Profile sunk = profile_of(prism(rectangle(0, 0, 2, 2), -0.75, 0.5));
  EXPECT_EQ(sunk.ground_m, -0.75);
  EXPECT_FALSE(band_of(sunk, 7).pieces.empty()) << "0.25 to 0.45 m over the origin";
  EXPECT_NEAR(static_cast<double>(band_of(sunk, 7).heights().high_m), 1.25, 1e-6);
  EXPECT_TRUE(band_of(sunk, 8).pieces.empty()) << "from 0.85 m over the origin on";
  const Profile standing = profile_of(prism(rectangle(0, 0, 2, 2), -0.25, 0.5));
  EXPECT_EQ(standing.ground_m, 0.0);
  EXPECT_FALSE(band_of(standing, 3).pieces.empty());
  EXPECT_TRUE(band_of(standing, 4).pieces.empty());
}

/// A star-shaped polygon with corners at even angles.
Polygon random_star(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const int corners = 3 + static_cast<int>(random() % 10);
  const double size = std::exp(std::log(0.3) + unit(random) * std::log(30.0));
  const double turn = 2.0 * pi * unit(random);
  const Vector2d at(20.0 * unit(random) - 10.0, 20.0 * unit(random) - 10.0);
  Polygon polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = turn + 2.0 * pi * i / corners;
    polygon.push_back(at + size * (0.5 + 0.5 * unit(random)) *
                               Vector2d(std::cos(angle), std::sin(angle)));
  }
  return polygon;
}

TEST(Profile, OfRandomPrismsHasTheAreaOfTheirBaseWhicheverWayTheyStand) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    const Polygon base = random_star(random);
    const double height = 0.15 + 4.0 * static_cast<double>(random() % 1000) / 1000.0;
    Polygon turned;
    for (const Vector2d& p : base) turned.emplace_back(-p.y(), p.x());
    const Profile profile = profile_of(prism(base, 0.0, height));
    const Profile other = profile_of(prism(turned, 0.0, height));
    expect_sound(profile);
    expect_sound(other);
    Vector2d low = base[0];
    Vector2d high = base[0];
    for (const Vector2d& p : base) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const double cell = std::clamp((high - low).maxCoeff() / 250.0, 0.002, 0.02);
    const double tolerance = 0.25 * cell * perimeter_of(base);
    for (std::size_t i = 0; i < profile_bands; ++i) {
      if (profile_edges_m[i] >= height) {
        EXPECT_TRUE(band_of(profile, i).pieces.empty());
        continue;
      }
      const Band band = band_of(profile, i);
      EXPECT_EQ(band.outlines(), 1);
      EXPECT_NEAR(band.area_of_pieces(), area_of(base), tolerance);
      EXPECT_NEAR(band_of(other, i).area_of_pieces(), band.area_of_pieces(), tolerance);
      EXPECT_NEAR(band.length(), perimeter_of(base), 0.03 * perimeter_of(base));
      for (const Vector2d& p : base) EXPECT_LE(band.distance(p), 2.0 * cell);
    }
  }
}

}  // namespace
}  // namespace crashrank

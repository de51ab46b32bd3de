// Free space inside bodies, heights, and outlines against a projection sampled point by point.
#include "crashrank/mesh/profile.hpp"

#include "mesh/profile_checks.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <random>
#include <vector>

namespace crashrank {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using test::add_prism;
using test::Band;
using test::band_of;
using test::expect_sound;
using test::prism;
using test::profile_of;
using test::rectangle;

void append(TriangleMesh& mesh, const TriangleMesh& part) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Eigen::Vector3f& vertex : part.vertices) mesh.vertices.push_back(vertex);
  for (const auto& [a, b, c] : part.triangles) {
    mesh.triangles.push_back({first + a, first + b, first + c});
  }
}

/// A closed box with outward triangles.
TriangleMesh box(double x0, double y0, double z0, double x1, double y1, double z1) {
  TriangleMesh mesh = prism(rectangle(x0, y0, x1, y1), z0, z1);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const double z : {z0, z1}) {
    for (const Vector2d& p : rectangle(x0, y0, x1, y1)) {
      mesh.vertices.push_back(Vector3d(p.x(), p.y(), z).cast<float>());
    }
  }
  mesh.triangles.push_back({first, first + 2, first + 1});
  mesh.triangles.push_back({first, first + 3, first + 2});
  mesh.triangles.push_back({first + 4, first + 5, first + 6});
  mesh.triangles.push_back({first + 4, first + 6, first + 7});
  return mesh;
}

/// Four walls of solid boxes around a yard of 6 x 4 m.
TriangleMesh yard() {
  TriangleMesh mesh = box(-3.5, -2.5, 0, 3.5, -2, 1);
  append(mesh, box(-3.5, 2, 0, 3.5, 2.5, 1));
  append(mesh, box(-3.5, -2, 0, -3, 2, 1));
  append(mesh, box(3, -2, 0, 3.5, 2, 1));
  return mesh;
}

TEST(ProfileSpace, AYardIsFreeWithSolidWallsOrSheetsAndUnderARoof) {
  TriangleMesh roofed = yard();
  append(roofed, box(-3.5, -2.5, 2.5, 3.5, 2.5, 2.7));
  const TriangleMesh sheets = prism(rectangle(-3, -2, 3, 2), 0.0, 1.0);
  for (const TriangleMesh& mesh : {yard(), roofed, sheets}) {
    const Profile profile = profile_of(mesh);
    expect_sound(profile);
    EXPECT_TRUE(profile.has_inner());
    const Band band = band_of(profile, 3);
    EXPECT_EQ(Band::outlines_of(band.inner), 1);
    EXPECT_NEAR(Band::area_within(band.inner), -24.0, 0.05);
    for (const OutlinePiece& piece : band.inner) {
      EXPECT_LT(piece.x * piece.normal_x + piece.y * piece.normal_y, 0.0F) << "into the yard";
    }
    const Profile filled = profile.filled();
    expect_sound(filled);
    EXPECT_FALSE(filled.has_inner());
    EXPECT_EQ(band_of(filled, 3).pieces.size(), band.pieces.size());
    EXPECT_EQ(filled.volume_m3(), profile.volume_m3());
  }
}

TEST(ProfileSpace, ABodyInAYardHasItsOwnOuterOutline) {
  TriangleMesh mesh = yard();
  append(mesh, box(-1, -0.5, 0, 1, 0.5, 1));
  const Band band = band_of(profile_of(mesh), 3);
  EXPECT_EQ(band.outlines(), 2);
  EXPECT_EQ(Band::outlines_of(band.inner), 1);
  EXPECT_NEAR(band.area_of_pieces() + Band::area_within(band.inner), 35.0 - 24.0 + 2.0, 0.05);
  EXPECT_NEAR(band.winding({0.0, 0.0}), 2.0, 1e-6) << "in the block, within the outer outline";
}

TEST(ProfileSpace, AFoundationIsBelowTheGround) {
  const Profile wall = profile_of(box(0, -2, -5, 0.3, 2, 2.5));
  EXPECT_EQ(wall.ground_m, -1.0);
  EXPECT_NEAR(static_cast<double>(band_of(wall, 10).heights().high_m), 3.5, 1e-6);
  EXPECT_EQ(profile_of(box(0, -2, -1, 0.3, 2, 1)).ground_m, -1.0);
  EXPECT_EQ(profile_of(box(0, -2, -5, 0.3, 2, 0)).ground_m, -5.0);
}

TEST(ProfileSpace, ASolidBlockAClosedShellAndANarrowGapAreNotFree) {
  TriangleMesh gap = box(-3, -2, 0, 3, -0.12, 1);
  append(gap, box(-3, 0.12, 0, 3, 2, 1));
  append(gap, box(-3, -0.12, 0, -2.5, 0.12, 1));
  append(gap, box(2.5, -0.12, 0, 3, 0.12, 1));
  for (const TriangleMesh& mesh : {box(-3, -2, 0, 3, 2, 1), gap}) {
    const Profile profile = profile_of(mesh);
    EXPECT_FALSE(profile.has_inner());
    EXPECT_NEAR(band_of(profile, 3).area_m2, 24.0, 0.05);
  }
}

TEST(ProfileSpace, BeamsAndPlatesAreSeenAtTheirHeights) {
  TriangleMesh mesh = box(-2, -1, 1.15, 2, 1, 1.35);  // a flatbed
  append(mesh, box(-2, -0.1, 0, -1.8, 0.1, 1.15));    // on a post
  const Profile profile = profile_of(mesh);
  expect_sound(profile);
  for (std::size_t i = 0; i < profile_bands; ++i) {
    const Band band = band_of(profile, i);
    if (profile_edges_m[i] >= 1.35) {
      EXPECT_TRUE(band.pieces.empty()) << "band " << i;
      continue;
    }
    EXPECT_NEAR(band.area_of_pieces(), profile_edges_m[i + 1] > 1.15 ? 8.0 : 0.04, 0.02)
        << "band " << i;
  }
  const HeightRange bed = band_of(profile, 7).heights();  // 1.2 to 1.6 m
  EXPECT_NEAR(static_cast<double>(bed.low_m), 1.2, 1e-6);
  EXPECT_NEAR(static_cast<double>(bed.high_m), 1.35, 1e-6);
  // At the free end the band below holds the bed alone.
  for (const OutlinePiece& piece : band_of(profile, 6).pieces) {
    if (piece.x < 1.9F) continue;
    EXPECT_NEAR(static_cast<double>(piece.at_edge.low_m), 1.15, 1e-6);
  }
}

TEST(ProfileSpace, ASlopingSurfaceIsLowAtItsEdgeAndHigherBehind) {
  // A wedge that rises from 0.6 m at x = 2 to 0.8 m at x = 0.
  TriangleMesh mesh;
  mesh.vertices = {{2, -1, 0.6F}, {2, 1, 0.6F}, {0, 1, 0.8F},
                   {0, -1, 0.8F}, {0, 1, 0.6F}, {0, -1, 0.6F}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 2}, {0, 3, 5},
                    {3, 2, 4}, {3, 4, 5}, {0, 5, 4}, {0, 4, 1}};
  const Band band = band_of(profile_of(mesh), 4);
  for (const OutlinePiece& piece : band.pieces) {
    if (piece.normal_x < 0.9F) continue;
    EXPECT_LT(piece.at_edge.high_m, 0.61F);
    EXPECT_NEAR(piece.behind.high_m, 0.63F, 0.005F);
  }
}

/// A box that is turned about the vertical, for point queries.
struct TurnedBox {
  Vector2d middle;
  Vector2d half;
  double cosine = 1.0;
  double sine = 0.0;
  double low = 0.0;
  double high = 0.0;

  bool holds(const Vector2d& p) const {
    const Vector2d d = p - middle;
    return std::abs(cosine * d.x() + sine * d.y()) <= half.x() &&
           std::abs(cosine * d.y() - sine * d.x()) <= half.y();
  }
};

TEST(ProfileSpace, OutlinesOfRandomBodiesOfBoxesHoldTheirSampledProjection) {
  constexpr std::uint64_t seed = 71;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  std::mt19937_64 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int bands = 0;
  int close = 0;
  for (int body = 0; body < 30; ++body) {
    std::vector<TurnedBox> boxes;
    TriangleMesh mesh;
    for (int k = 0; k < 5; ++k) {
      const double turn = uniform(-3.1, 3.1);
      TurnedBox b;
      b.middle = {uniform(-2, 2), uniform(-2, 2)};
      b.half = {uniform(0.2, 2.0), uniform(0.1, 0.6)};
      b.cosine = std::cos(turn);
      b.sine = std::sin(turn);
      b.low = uniform(0.0, 2.0);
      b.high = b.low + uniform(0.05, 1.5);
      boxes.push_back(b);
      TriangleMesh part = box(-b.half.x(), -b.half.y(), b.low, b.half.x(), b.half.y(), b.high);
      const Eigen::AngleAxisd about(turn, Vector3d::UnitZ());
      const Vector3d at(b.middle.x(), b.middle.y(), 0.0);
      for (Eigen::Vector3f& v : part.vertices) {
        v = (about * v.cast<double>() + at).cast<float>();
      }
      append(mesh, part);
    }
    const Profile profile = profile_of(mesh);
    for (std::size_t i = 0; i < profile_bands; ++i) {
      const auto in_band = [&](const TurnedBox& b) {
        return b.low < profile_edges_m[i + 1] && b.high > profile_edges_m[i];
      };
      // Middles of cells of 8 mm over all boxes.
      constexpr double step = 0.008;
      constexpr double reach = 4.2;
      double covered = 0.0;
      for (double x = -reach; x < reach; x += step) {
        for (double y = -reach; y < reach; y += step) {
          const Vector2d p(x, y);
          covered += std::any_of(boxes.begin(), boxes.end(),
                                 [&](const TurnedBox& b) { return in_band(b) && b.holds(p); });
        }
      }
      covered *= step * step;
      const Band band = band_of(profile, i);
      EXPECT_EQ(band.pieces.empty(), covered == 0.0) << "body " << body << ", band " << i;
      if (covered == 0.0) continue;
      ++bands;
      // Free space too narrow to be kept counts as body: between five boxes at most 0.3 m².
      const double area = band.area_of_pieces() + Band::area_within(band.inner);
      EXPECT_GE(area, 0.99 * covered) << "body " << body << ", band " << i;
      EXPECT_LE(area, 1.01 * covered + 0.3) << "body " << body << ", band " << i;
      close += area <= 1.01 * covered ? 1 : 0;
    }
  }
  EXPECT_GT(bands, 100);
  EXPECT_GE(close, bands * 95 / 100);
}

}  // namespace
}  // namespace crashrank

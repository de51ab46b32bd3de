#include "mesh/profile_checks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using Eigen::Vector2d;
using test::area_of;
using test::Band;
using test::band_of;
using test::circle;
using test::ends_of;
using test::expect_sound;
using test::Polygon;
using test::profile_of;

/// Reads the shipped models: vertices, triangles, nothing else.
TriangleMesh shipped(const std::string& name) {
  std::ifstream in(std::string(CRASHRANK_MODELS) + "/" + name + ".obj");
  EXPECT_TRUE(in.good()) << name;
  TriangleMesh mesh;
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      Eigen::Vector3f v;
      words >> v.x() >> v.y() >> v.z();
      mesh.vertices.push_back(v);
    } else if (kind == "f") {
      std::array<std::uint32_t, 3> t{};
      words >> t[0] >> t[1] >> t[2];
      mesh.triangles.push_back({t[0] - 1, t[1] - 1, t[2] - 1});
    }
  }
  return mesh;
}

/// Points of a mesh's edges between two heights: their ends, and where they pass the heights.
Polygon points_within(const TriangleMesh& mesh, double low, double high) {
  Polygon points;
  for (const std::array<std::uint32_t, 3>& triangle : mesh.triangles) {
    for (std::size_t e = 0; e < 3; ++e) {
      const Eigen::Vector3d p = mesh.vertices[triangle[e]].cast<double>();
      const Eigen::Vector3d q = mesh.vertices[triangle[(e + 1) % 3]].cast<double>();
      if (p.z() > low && p.z() < high) points.emplace_back(p.head<2>());
      for (const double height : {low, high}) {
        if (p.z() >= height || q.z() < height) continue;
        const double t = (height - p.z()) / (q.z() - p.z());
        points.emplace_back(((1.0 - t) * p + t * q).head<2>());
      }
    }
  }
  return points;
}

/// True for a point of a part of a section that is smaller than 1 mm and stands alone: such parts,
/// the lowest point of a nut for example, have no outline.
bool is_speck(const Polygon& points, const Vector2d& p) {
  return std::none_of(points.begin(), points.end(), [&](const Vector2d& q) {
    const double distance = (p - q).norm();
    return distance > 0.001 && distance < 0.05;
  });
}

TEST(Profile, OfEveryShippedModelHoldsItsSectionsAndReachesAsFar) {
  const std::vector<std::pair<std::string, double>> models{
      {"hatch", 1.49},       {"sedan", 1.466},         {"truck", 3.75}, {"motorcycle", 1.688},
      {"pedestrian", 1.747}, {"jersey_barrier", 0.81}, {"pole", 6.0},   {"wall", 2.5},
      {"van", 2.6},          {"semitrailer", 4.0},     {"tram", 3.59},  {"wheelchair", 1.394}};
  for (const auto& [name, height] : models) {
    SCOPED_TRACE(name);
    const TriangleMesh mesh = shipped(name);
    ASSERT_GT(mesh.size(), 1000U);
    const Profile profile = profile_of(mesh);
    expect_sound(profile);
    EXPECT_EQ(profile.ground_m, 0.0);
    for (std::size_t i = 0; i < profile_bands; ++i) {
      const Band band = band_of(profile, i);
      const Polygon points = points_within(mesh, profile_edges_m[i], profile_edges_m[i + 1]);
      ASSERT_EQ(band.pieces.empty(), profile_edges_m[i] >= height) << "band " << i;
      ASSERT_EQ(band.pieces.empty(), points.empty()) << "band " << i;
      if (points.empty()) continue;
      EXPECT_GT(band.area_m2, 0.0);
      constexpr double cell = 0.02;
      Vector2d low = Vector2d::Constant(1e9);
      Vector2d high = -low;
      for (std::size_t k = 0; k < points.size(); k += 1 + points.size() / 1000) {
        const Vector2d& p = points[k];
        const double outside =
            band.winding(p) > 0.5 || is_speck(points, p) ? 0.0 : band.distance(p);
        EXPECT_LE(outside, 2.0 * cell) << "band " << i << ", " << p.transpose();
      }
      for (const Vector2d& p : points) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
      Vector2d reached_low = Vector2d::Constant(1e9);
      Vector2d reached_high = -reached_low;
      for (const OutlinePiece& piece : band.pieces) {
        const auto [from, to] = ends_of(piece);
        reached_low = reached_low.cwiseMin(from).cwiseMin(to);
        reached_high = reached_high.cwiseMax(from).cwiseMax(to);
      }
      EXPECT_LE((reached_low - low).cwiseAbs().maxCoeff(), cell) << "band " << i;
      EXPECT_LE((reached_high - high).cwiseAbs().maxCoeff(), cell) << "band " << i;
    }
  }
}

/// Pieces of a band, sorted.
std::vector<std::array<float, 9>> sorted_pieces(const Profile& profile, std::size_t band,
                                                bool mirrored) {
  std::vector<std::array<float, 9>> rows;
  const float side = mirrored ? -1.0F : 1.0F;
  for (std::uint32_t i = profile.first[band]; i < profile.first[band + 1]; ++i) {
    const OutlinePiece& p = profile.pieces[i];
    rows.push_back({p.x, side * p.y, p.normal_x, side * p.normal_y, p.length_m, p.at_edge.low_m,
                    p.at_edge.high_m, p.behind.low_m, p.behind.high_m});
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

TEST(Profile, OfAMirrorImageIsTheMirrorImage) {
  std::size_t pieces = 0;
  for (const char* name : {"hatch", "sedan", "truck", "motorcycle", "pedestrian", "jersey_barrier",
                           "pole", "wall", "van", "semitrailer", "tram", "wheelchair"}) {
    SCOPED_TRACE(name);
    TriangleMesh mesh = shipped(name);
    const Profile profile = profile_of(mesh);
    for (Eigen::Vector3f& v : mesh.vertices) v.y() = -v.y();
    for (std::array<std::uint32_t, 3>& t : mesh.triangles) std::swap(t[0], t[1]);
    const Profile mirrored = profile_of(mesh);
    for (std::size_t band = 0; band < profile_bands; ++band) {
      const auto before = sorted_pieces(profile, band, false);
      const auto after = sorted_pieces(mirrored, band, true);
      std::vector<std::array<float, 9>> alone;
      std::set_symmetric_difference(before.begin(), before.end(), after.begin(), after.end(),
                                    std::back_inserter(alone));
      EXPECT_TRUE(alone.empty()) << "band " << band << ", of " << before.size() << " pieces "
                                 << testing::PrintToString(alone);
    }
    pieces += profile.pieces.size();
  }
  EXPECT_GT(pieces, 4000U);
}

TEST(Profile, OfTheShippedBodiesOfKnownShapeHasTheirArea) {
  const Band wall = band_of(profile_of(shipped("wall")), 4);
  EXPECT_NEAR(wall.area_m2, 0.25 * 10.0, 0.01 * 2.5);
  EXPECT_EQ(wall.outlines(), 1);
  const Band pole = band_of(profile_of(shipped("pole")), 4);
  const double hexadecagon = area_of(circle({0, 0}, 0.127, 16));
  EXPECT_NEAR(pole.area_m2, hexadecagon, 0.005 * hexadecagon);
  EXPECT_EQ(pole.outlines(), 1);
  // A walking pedestrian's legs are apart, a chest is one with its arms or beside them.
  EXPECT_EQ(band_of(profile_of(shipped("pedestrian")), 2).outlines(), 2);
}

}  // namespace
}  // namespace crashrank

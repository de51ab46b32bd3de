#include "crashrank/mesh/profile.hpp"

#include "mesh/outline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using Eigen::Vector2d;
using Polygon = std::vector<Vector2d>;

constexpr double pi = 3.14159265358979323846;

double cross(const Vector2d& p, const Vector2d& q) { return p.x() * q.y() - p.y() * q.x(); }

double area_of(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  }
  return 0.5 * twice;
}

double perimeter_of(const Polygon& polygon) {
  double length = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    length += (polygon[(i + 1) % polygon.size()] - polygon[i]).norm();
  }
  return length;
}

void add_wall(TriangleMesh& mesh, const Vector2d& from, const Vector2d& to, double low,
              double high) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const double z : {low, high}) {
    for (const Vector2d& p : {from, to}) {
      mesh.vertices.push_back(Eigen::Vector3d(p.x(), p.y(), z).cast<float>());
    }
  }
  mesh.triangles.push_back({first, first + 1, first + 3});
  mesh.triangles.push_back({first, first + 3, first + 2});
}

/// The walls of a prism. Without its caps: no horizontal section passes through them.
void add_prism(TriangleMesh& mesh, const Polygon& polygon, double low, double high) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    add_wall(mesh, polygon[i], polygon[(i + 1) % polygon.size()], low, high);
  }
}

TriangleMesh prism(const Polygon& polygon, double low, double high) {
  TriangleMesh mesh;
  add_prism(mesh, polygon, low, high);
  return mesh;
}

Polygon rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

Polygon circle(const Vector2d& center, double radius, int corners) {
  Polygon polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * pi * i / corners;
    polygon.push_back(center + radius * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return polygon;
}

Profile profile_of(const TriangleMesh& mesh) {
  const Result<Profile> profile = make_profile(mesh);
  EXPECT_TRUE(profile.ok()) << (profile.ok() ? "" : profile.error().message());
  return profile.ok() ? *profile : Profile{};
}

std::string reason_of(const TriangleMesh& mesh, ErrorCode code = ErrorCode::bad_input) {
  const Result<Profile> profile = make_profile(mesh);
  EXPECT_FALSE(profile.ok());
  if (profile.ok()) return "";
  EXPECT_EQ(profile.error().code, code);
  EXPECT_FALSE(profile.error().remedy.empty());
  return profile.error().reason;
}

/// The ends of a piece, in the direction that has the body to its left.
std::pair<Vector2d, Vector2d> ends_of(const OutlinePiece& piece) {
  const Vector2d middle = Eigen::Vector2f(piece.x, piece.y).cast<double>();
  const Vector2d normal = Eigen::Vector2f(piece.normal_x, piece.normal_y).cast<double>();
  const Vector2d half =
      0.5 * static_cast<double>(piece.length_m) * Vector2d(-normal.y(), normal.x());
  return {middle - half, middle + half};
}

struct Band {
  std::vector<OutlinePiece> pieces;
  double area_m2 = 0.0;

  double length() const {
    double sum = 0.0;
    for (const OutlinePiece& piece : pieces) sum += static_cast<double>(piece.length_m);
    return sum;
  }

  /// Outlines: where a piece does not begin at the end of the one before, another begins.
  int outlines() const {
    int count = pieces.empty() ? 0 : 1;
    for (std::size_t i = 1; i < pieces.size(); ++i) {
      if ((ends_of(pieces[i]).first - ends_of(pieces[i - 1]).second).norm() > 1e-4) ++count;
    }
    return count;
  }

  /// Area by the divergence theorem, m².
  double area_of_pieces() const {
    double twice = 0.0;
    for (const OutlinePiece& piece : pieces) {
      const auto [from, to] = ends_of(piece);
      twice += cross(from, to);
    }
    return 0.5 * twice;
  }

  /// Sum of length times normal, m: zero for closed outlines.
  Vector2d opening() const {
    Vector2d sum = Vector2d::Zero();
    for (const OutlinePiece& piece : pieces) {
      sum += static_cast<double>(piece.length_m) *
             Eigen::Vector2f(piece.normal_x, piece.normal_y).cast<double>();
    }
    return sum;
  }

  double distance(const Vector2d& p) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const OutlinePiece& piece : pieces) {
      const auto [from, to] = ends_of(piece);
      const Vector2d along = to - from;
      const double t = std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (from + t * along - p).norm());
    }
    return nearest;
  }

  /// How often the outlines go round a point.
  double winding(const Vector2d& p) const {
    double angle = 0.0;
    for (const OutlinePiece& piece : pieces) {
      const auto [from, to] = ends_of(piece);
      angle += std::atan2(cross(from - p, to - p), (from - p).dot(to - p));
    }
    return angle / (2.0 * pi);
  }
};

Band band_of(const Profile& profile, std::size_t band) {
  const auto begin = profile.pieces.begin();
  return {{begin + profile.first[band], begin + profile.first[band + 1]},
          static_cast<double>(profile.area_m2[band])};
}

double middle_m(std::size_t band) {
  return 0.5 * (profile_edges_m[band] + profile_edges_m[band + 1]);
}

/// What holds of every profile.
void expect_sound(const Profile& profile) {
  EXPECT_EQ(profile.first.front(), 0U);
  EXPECT_EQ(profile.first.back(), profile.pieces.size());
  EXPECT_TRUE(std::is_sorted(profile.first.begin(), profile.first.end()));
  EXPECT_GT(profile.volume_m3(), 0.0);
  for (const OutlinePiece& piece : profile.pieces) {
    EXPECT_NEAR(std::hypot(piece.normal_x, piece.normal_y), 1.0F, 1e-6F);
    EXPECT_GT(piece.length_m, 0.0F);
  }
  for (std::size_t i = 0; i < profile_bands; ++i) {
    const Band band = band_of(profile, i);
    EXPECT_LE(band.opening().norm(), 1e-5 * band.length() + 1e-5) << "band " << i;
    EXPECT_NEAR(band.area_m2, band.area_of_pieces(), 1e-5 * (1.0 + band.area_m2)) << "band " << i;
  }
}

TEST(Profile, OfABoxHasItsAreaAndPerimeterInTheBandsThatItSpans) {
  const Profile profile = profile_of(prism(rectangle(-1.0, -0.9, 3.5, 0.9), 0.2, 1.5));
  expect_sound(profile);
  EXPECT_EQ(profile.ground_m, 0.0);
  double volume = 0.0;
  for (std::size_t i = 0; i < profile_bands; ++i) {
    const Band band = band_of(profile, i);
    if (middle_m(i) < 0.2 || middle_m(i) > 1.5) {
      EXPECT_TRUE(band.pieces.empty()) << "band " << i;
      EXPECT_EQ(band.area_m2, 0.0);
      continue;
    }
    EXPECT_EQ(band.outlines(), 1);
    EXPECT_NEAR(band.area_m2, 4.5 * 1.8, 1e-3 * 4.5 * 1.8) << "band " << i;
    EXPECT_NEAR(band.length(), 2.0 * (4.5 + 1.8), 1e-3 * 12.6) << "band " << i;
    EXPECT_GE(band.pieces.size(), static_cast<std::size_t>(12.6 / longest_piece_m));
    for (const OutlinePiece& piece : band.pieces) {
      EXPECT_LE(static_cast<double>(piece.length_m), longest_piece_m * 1.00001);
    }
    volume += 4.5 * 1.8 * (profile_edges_m[i + 1] - profile_edges_m[i]);
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
  for (std::size_t i = 0; i < 5; ++i) {
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
    for (std::size_t i = 0; i < 5; ++i) {
      const Band band = band_of(profile, i);
      EXPECT_EQ(band.outlines(), 2) << hole;
      EXPECT_NEAR(band.area_m2, hole < 0.1 ? 13.0 : 1.0, 0.05) << hole;
      EXPECT_NEAR(band.length(), 4.0 + (hole < 0.1 ? 16.0 : 2.0 * (16.0 - hole)), 0.2) << hole;
      EXPECT_LE(band.opening().norm(), 1e-4);
    }
    EXPECT_TRUE(band_of(profile, 5).pieces.empty());
  }
}

TEST(Profile, StandsOnTheLowestPointOfABodyBelowTheGround) {
  const Profile sunk = profile_of(prism(rectangle(0, 0, 2, 2), -0.75, 0.5));
  EXPECT_EQ(sunk.ground_m, -0.75);
  EXPECT_FALSE(band_of(sunk, 5).pieces.empty()) << "0.35 m over the origin";
  EXPECT_TRUE(band_of(sunk, 6).pieces.empty()) << "0.65 m over the origin";
  const Profile standing = profile_of(prism(rectangle(0, 0, 2, 2), -0.25, 0.5));
  EXPECT_EQ(standing.ground_m, 0.0);
  EXPECT_FALSE(band_of(standing, 1).pieces.empty());
  EXPECT_TRUE(band_of(standing, 2).pieces.empty());
}

TEST(Profile, IsRefusedForMeshesWithoutOne) {
  EXPECT_EQ(reason_of({}), "has no triangle to take an outline from");
  TriangleMesh loose;
  loose.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}};
  EXPECT_EQ(reason_of(loose), "has no triangle to take an outline from");

  constexpr const char* nothing =
      "has no outline between 0 and 4 m over the ground that encloses anything";
  TriangleMesh one = loose;
  one.triangles = {{0, 1, 2}};
  EXPECT_EQ(reason_of(one), nothing);
  one.vertices = {{0.3F, 0.1F, 0.0F}, {4.7F, 1.3F, 0.2F}, {1.1F, -0.4F, 2.9F}};
  EXPECT_EQ(reason_of(one), nothing);
  one.triangles = {{0, 0, 0}};
  EXPECT_EQ(reason_of(one), nothing);

  TriangleMesh plate;
  plate.vertices = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  plate.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(reason_of(plate), nothing);
  EXPECT_EQ(reason_of(prism(rectangle(0, 0, 2, 2), 4.0, 6.0)), nothing);
  EXPECT_EQ(reason_of(prism(rectangle(0, 0, 0, 7), 0.0, 2.0)), nothing) << "a sheet";
}

TEST(Profile, IsRefusedForVerticesThatAreNotThereOrFarOut) {
  const TriangleMesh box = prism(rectangle(0, 0, 2, 2), 0.0, 1.0);
  const Profile expected = profile_of(box);
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float wrong : {std::nanf(""), infinity, -infinity, 1.001e6F, -3e38F}) {
    for (int axis = 0; axis < 3; ++axis) {
      TriangleMesh mesh = box;
      mesh.vertices[3][axis] = wrong;
      EXPECT_EQ(reason_of(mesh), "has a vertex more than 1e6 m from its origin, or not finite");
      // Without a triangle it does not count.
      mesh = box;
      mesh.vertices.push_back({0, 0, 0});
      mesh.vertices[mesh.vertices.size() - 1][axis] = wrong;
      const Profile profile = profile_of(mesh);
      EXPECT_EQ(profile.first, expected.first);
      EXPECT_EQ(profile.area_m2, expected.area_m2);
      EXPECT_EQ(profile.ground_m, 0.0);
    }
  }
  TriangleMesh mesh = box;
  mesh.triangles[0][1] = static_cast<std::uint32_t>(mesh.vertices.size());
  EXPECT_EQ(reason_of(mesh), "has a triangle with a vertex that is not there");
}

TEST(Profile, OfTheLargestBodiesIsWithinTheLimits) {
  const Profile profile = profile_of(prism(rectangle(-1e6, -2e5, 1e6, 2e5), 0.0, 3.0));
  expect_sound(profile);
  EXPECT_NEAR(band_of(profile, 0).area_m2, 8e11, 0.01 * 8e11);
  for (const OutlinePiece& piece : profile.pieces) EXPECT_LE(piece.length_m, 100.01F);
  EXPECT_LT(profile.pieces.size(), 600'000U);
}

TEST(Profile, OfTooManySmallBodiesIsRefused) {
  TriangleMesh mesh;
  for (int i = 0; i < 240; ++i) {
    for (int j = 0; j < 240; ++j) {
      const Vector2d at(0.15 * i, 0.15 * j);
      add_prism(mesh, rectangle(at.x(), at.y(), at.x() + 0.06, at.y() + 0.05), 0.0, 4.0);
    }
  }
  EXPECT_EQ(reason_of(mesh, ErrorCode::limit_exceeded),
            "has outlines of more than 2 million pieces between 0 and 4 m");
}

// As many cells as they pass through would take gigabytes.
TEST(Profile, OfManyLargeTrianglesHasACoarserRaster) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> coordinate(-90.0, 90.0);
  TriangleMesh mesh = prism(rectangle(-100, -100, 100, 100), 0.05, 0.15);
  for (int i = 0; i < 100'000; ++i) {
    add_wall(mesh, {coordinate(random), coordinate(random)},
             {coordinate(random), coordinate(random)}, 0.05, 0.15);
  }
  const Profile profile = profile_of(mesh);
  EXPECT_NEAR(band_of(profile, 0).area_m2, 4e4, 40.0);
  EXPECT_EQ(band_of(profile, 0).outlines(), 1);
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
      if (middle_m(i) > height) {
        EXPECT_TRUE(band_of(profile, i).pieces.empty());
        continue;
      }
      const Band band = band_of(profile, i);
      EXPECT_EQ(band.outlines(), 1);
      EXPECT_NEAR(band.area_m2, area_of(base), tolerance);
      EXPECT_NEAR(band_of(other, i).area_m2, band.area_m2, tolerance);
      EXPECT_NEAR(band.length(), perimeter_of(base), 0.03 * perimeter_of(base));
      for (const Vector2d& p : base) EXPECT_LE(band.distance(p), 2.0 * cell);
    }
  }
}

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

/// Where a mesh's edges pass a height.
Polygon crossings(const TriangleMesh& mesh, double height) {
  Polygon points;
  for (const std::array<std::uint32_t, 3>& triangle : mesh.triangles) {
    for (std::size_t e = 0; e < 3; ++e) {
      const Eigen::Vector3d p = mesh.vertices[triangle[e]].cast<double>();
      const Eigen::Vector3d q = mesh.vertices[triangle[(e + 1) % 3]].cast<double>();
      if (p.z() >= height || q.z() < height) continue;
      const double t = (height - p.z()) / (q.z() - p.z());
      points.push_back(((1.0 - t) * p + t * q).head<2>());
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
      {"pedestrian", 1.747}, {"jersey_barrier", 0.81}, {"pole", 6.0},   {"wall", 2.5}};
  for (const auto& [name, height] : models) {
    SCOPED_TRACE(name);
    const TriangleMesh mesh = shipped(name);
    ASSERT_GT(mesh.size(), 1000U);
    const Profile profile = profile_of(mesh);
    expect_sound(profile);
    EXPECT_EQ(profile.ground_m, 0.0);
    for (std::size_t i = 0; i < profile_bands; ++i) {
      const Band band = band_of(profile, i);
      const Polygon points = crossings(mesh, middle_m(i) + 1e-6);
      ASSERT_EQ(band.pieces.empty(), middle_m(i) > height) << "band " << i;
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

TEST(Profile, OfTheShippedBodiesOfKnownShapeHasTheirArea) {
  const Band wall = band_of(profile_of(shipped("wall")), 3);
  EXPECT_NEAR(wall.area_m2, 0.25 * 10.0, 0.01 * 2.5);
  EXPECT_EQ(wall.outlines(), 1);
  const Band pole = band_of(profile_of(shipped("pole")), 3);
  const double hexadecagon = area_of(circle({0, 0}, 0.127, 16));
  EXPECT_NEAR(pole.area_m2, hexadecagon, 0.005 * hexadecagon);
  EXPECT_EQ(pole.outlines(), 1);
  // A walking pedestrian's legs are apart, a chest is one with its arms or beside them.
  EXPECT_EQ(band_of(profile_of(shipped("pedestrian")), 1).outlines(), 2);
}

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

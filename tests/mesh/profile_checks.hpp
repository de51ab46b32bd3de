#pragma once

#include "crashrank/mesh/profile.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace crashrank::test {

using Eigen::Vector2d;
using Polygon = std::vector<Vector2d>;

inline constexpr double pi = 3.14159265358979323846;

inline double cross(const Vector2d& p, const Vector2d& q) { return p.x() * q.y() - p.y() * q.x(); }

inline double area_of(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  }
  return 0.5 * twice;
}

inline double perimeter_of(const Polygon& polygon) {
  double length = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    length += (polygon[(i + 1) % polygon.size()] - polygon[i]).norm();
  }
  return length;
}

inline void add_wall(TriangleMesh& mesh, const Vector2d& from, const Vector2d& to, double low,
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

/// The walls of a prism, without its caps.
inline void add_prism(TriangleMesh& mesh, const Polygon& polygon, double low, double high) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    add_wall(mesh, polygon[i], polygon[(i + 1) % polygon.size()], low, high);
  }
}

inline TriangleMesh prism(const Polygon& polygon, double low, double high) {
  TriangleMesh mesh;
  add_prism(mesh, polygon, low, high);
  return mesh;
}

inline Polygon rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

inline Polygon circle(const Vector2d& center, double radius, int corners) {
  Polygon polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * pi * i / corners;
    polygon.push_back(center + radius * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return polygon;
}

inline Profile profile_of(const TriangleMesh& mesh) {
  const Result<Profile> profile = make_profile(mesh);
  EXPECT_TRUE(profile.ok()) << (profile.ok() ? "" : profile.error().message());
  return profile.ok() ? *profile : Profile{};
}

inline std::string reason_of(const TriangleMesh& mesh, ErrorCode code = ErrorCode::bad_input) {
  const Result<Profile> profile = make_profile(mesh);
  EXPECT_FALSE(profile.ok());
  if (profile.ok()) return "";
  EXPECT_EQ(profile.error().code, code);
  EXPECT_FALSE(profile.error().remedy.empty());
  return profile.error().reason;
}

/// The ends of a piece, in the direction that has the body to its left.
inline std::pair<Vector2d, Vector2d> ends_of(const OutlinePiece& piece) {
  const Vector2d middle = Eigen::Vector2f(piece.x, piece.y).cast<double>();
  const Vector2d normal = Eigen::Vector2f(piece.normal_x, piece.normal_y).cast<double>();
  const Vector2d half =
      0.5 * static_cast<double>(piece.length_m) * Vector2d(-normal.y(), normal.x());
  return {middle - half, middle + half};
}

struct Band {
  std::vector<OutlinePiece> pieces;  ///< of outer outlines
  std::vector<OutlinePiece> inner;   ///< of inner ones
  double area_m2 = 0.0;

  double length() const {
    double sum = 0.0;
    for (const OutlinePiece& piece : pieces) sum += static_cast<double>(piece.length_m);
    return sum;
  }

  /// Outlines: where a piece does not begin at the end of the one before, another begins.
  static int outlines_of(const std::vector<OutlinePiece>& pieces) {
    int count = pieces.empty() ? 0 : 1;
    for (std::size_t i = 1; i < pieces.size(); ++i) {
      if ((ends_of(pieces[i]).first - ends_of(pieces[i - 1]).second).norm() > 1e-4) ++count;
    }
    return count;
  }
  int outlines() const { return outlines_of(pieces); }

  /// Area by the divergence theorem, m²; negative for outlines of free space.
  static double area_within(const std::vector<OutlinePiece>& pieces) {
    double twice = 0.0;
    for (const OutlinePiece& piece : pieces) {
      const auto [from, to] = ends_of(piece);
      twice += cross(from, to);
    }
    return 0.5 * twice;
  }
  double area_of_pieces() const { return area_within(pieces); }

  /// Heights behind all outer pieces, m over the ground.
  HeightRange heights() const {
    HeightRange all;
    for (const OutlinePiece& piece : pieces) all.grow(piece.behind);
    return all;
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

inline Band band_of(const Profile& profile, std::size_t band) {
  const auto begin = profile.pieces.begin();
  return {{begin + profile.first[band], begin + profile.first_inner[band]},
          {begin + profile.first_inner[band], begin + profile.first[band + 1]},
          static_cast<double>(profile.area_m2[band])};
}

inline double middle_m(std::size_t band) {
  return 0.5 * (profile_edges_m[band] + profile_edges_m[band + 1]);
}

/// What holds of every profile.
inline void expect_sound(const Profile& profile) {
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
    EXPECT_LE(band.area_m2, band.area_of_pieces() + 1e-5 * (1.0 + band.area_m2)) << "band " << i;
    for (const OutlinePiece& piece : band.pieces) {
      if (piece.behind.empty()) continue;
      EXPECT_GE(static_cast<double>(piece.behind.low_m), profile_edges_m[i] - 1e-6);
      EXPECT_LE(static_cast<double>(piece.behind.high_m), profile_edges_m[i + 1] + 1e-6);
      EXPECT_LE(piece.behind.low_m, piece.at_edge.low_m);
      EXPECT_GE(piece.behind.high_m, piece.at_edge.high_m);
    }
  }
}

}  // namespace crashrank::test

#pragma once

#include "crashrank/base/box.hpp"
#include "crashrank/base/column.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace crashrank {

/// Three corners in body coordinates, m. A triangle is the convex hull of its corners: a segment or
/// a point when they are collinear or equal.
struct Triangle {
  std::array<Eigen::Vector3f, 3> corner;  ///< m
};

/// Names of parts that come from files are UTF-8 and at most this long; importing cuts longer ones.
inline constexpr std::size_t max_part_name_bytes = 256;

/// A named run of consecutive triangles: a bumper, a door. The parts of a mesh cover its triangles
/// in order, without gap or overlap; their names are unique within the mesh.
struct Part {
  std::string name;                  ///< unique within the mesh
  std::uint32_t first_triangle = 0;  ///< index of its first one
  std::uint32_t triangle_count = 0;  ///< how many follow
};

/// A body's surface: float32 vertices in body coordinates (m; x forward, y left, z up), triangles
/// by vertex index in the order of the file they came from, parts over them. Degenerate and
/// duplicate triangles keep their places, so that a triangle's index means the same everywhere.
struct TriangleMesh {
  Column<Eigen::Vector3f> vertices;                ///< body coordinates, m
  Column<std::array<std::uint32_t, 3>> triangles;  ///< three vertices each
  std::vector<Part> parts;                         ///< in the order of their triangles

  /// Number of triangles.
  std::size_t size() const noexcept { return triangles.size(); }

  /// A triangle by its index, below `size`.
  Triangle triangle(std::size_t index) const {
    const std::array<std::uint32_t, 3>& v = triangles[index];
    return {{vertices[v[0]], vertices[v[1]], vertices[v[2]]}};
  }

  /// The smallest box around all vertices. O(vertices).
  Box bounds() const {
    Box box;
    for (const Eigen::Vector3f& vertex : vertices) box.grow(vertex);
    return box;
  }
};

/// Triangle indices are 32-bit and signed in the published pair lists.
inline constexpr std::size_t max_triangles = 0x7fffffff;

}  // namespace crashrank

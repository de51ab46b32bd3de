#pragma once

#include "crashrank/base/box.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/internal/base/export.hpp"

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

/// Which way a file's axis points, for files that do not follow x forward, z up.
enum class Axis : std::uint8_t { plus_x, minus_x, plus_y, minus_y, plus_z, minus_z };

/// How file coordinates become body coordinates: rotate so that `forward` is +x and `up` is +z,
/// scale, then subtract `origin_m` (in body axes, after scaling).
struct ImportTransform {
  double scale = 1.0;                                  ///< metres per file unit
  Axis up = Axis::plus_z;                              ///< the file's axis that points up
  Axis forward = Axis::plus_x;                         ///< the file's axis that points forward
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();  ///< what becomes 0, m
};

/// Unit vector of an axis, in file coordinates.
inline Eigen::Vector3d direction(Axis axis) {
  Eigen::Vector3d unit = Eigen::Vector3d::Zero();
  const int index = static_cast<int>(axis);
  unit[index / 2] = index % 2 == 0 ? 1.0 : -1.0;
  return unit;
}

/// "+x", "-x" and so on.
constexpr const char* axis_name(Axis axis) noexcept {
  constexpr const char* names[] = {"+x", "-x", "+y", "-y", "+z", "-z"};
  return names[static_cast<int>(axis)];
}

/// "+x", "x", "-y" and so on, upper case too. Errors: usage.
CRASHRANK_API Result<Axis> axis_from_name(const std::string& name);

/// Checks a transform. Errors: usage for a scale that is not positive and finite, up and forward on
/// one line, an origin that is not finite.
CRASHRANK_API Status check(const ImportTransform& transform);

/// One point from file to body coordinates, m, in double. The default transform changes no bit
/// (but the sign of a zero).
inline Eigen::Vector3d apply(const ImportTransform& transform, const Eigen::Vector3d& point) {
  const Eigen::Vector3d forward = direction(transform.forward);
  const Eigen::Vector3d up = direction(transform.up);
  const Eigen::Vector3d left(up.y() * forward.z() - up.z() * forward.y(),
                             up.z() * forward.x() - up.x() * forward.z(),
                             up.x() * forward.y() - up.y() * forward.x());
  // Each row holds one ±1, so the dot products are exact.
  return Eigen::Vector3d(forward.dot(point), left.dot(point), up.dot(point)) * transform.scale -
         transform.origin_m;
}

/// Transforms every vertex of a mesh that was loaded without a transform. Errors: as `check`, and
/// bad_input when a vertex leaves the range of float32; the mesh is then unchanged.
CRASHRANK_API Status transform_mesh(TriangleMesh& mesh, const ImportTransform& transform);

}  // namespace crashrank

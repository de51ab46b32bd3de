#pragma once

#include "crashrank/internal/base/export.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace crashrank {

/// Defects and size of a mesh. Counts and metres.
struct MeshQuality {
  std::size_t degenerate_triangles = 0;  ///< exactly collinear or coinciding corners
  std::size_t duplicate_triangles = 0;   ///< same three corners as an earlier one, any order
  std::size_t non_finite_vertices = 0;   ///< with a NaN or an infinity
  std::size_t open_edges = 0;      ///< edges (vertices welded by position) of one triangle only
  std::size_t crowded_edges = 0;   ///< of three or more
  std::size_t reversed_edges = 0;  ///< of two that disagree about which side is out
  Eigen::Vector3d extent_m = Eigen::Vector3d::Zero();  ///< of the finite vertices triangles use
  bool watertight = false;  ///< every edge has exactly two triangles; winding is not asked
  double area_m2 = 0.0;     ///< of all triangles
  std::vector<std::string> warnings;  ///< one sentence each, for a person
};

/// Counts the defects of a mesh. O(n log n); never fails, whatever the vertices hold (indices have
/// to be within range). Triangles with two equal corners have no edges; triangles with a vertex
/// that is not finite are left out of every count but that of the vertices.
CRASHRANK_API MeshQuality assess(const TriangleMesh& mesh);

/// Meshes with a largest extent outside these are refused on import, m.
inline constexpr double min_extent_m = 1e-6;
inline constexpr double max_extent_m = 1e6;  ///< A mesh larger than this is refused, m.

/// A largest extent outside these is no road user's and warned about, m: a pedestrian's hand to a
/// road train.
inline constexpr double min_plausible_extent_m = 0.3;
/// A mesh larger than this is warned about, m.
inline constexpr double max_plausible_extent_m = 30.0;

/// Area, volume, centroid and inertia of a body's surface.
struct ShellProperties {
  double area_m2 = 0.0;    ///< of the surface, every triangle counted
  double volume_m3 = 0.0;  ///< enclosed; means something for closed, evenly turned meshes only
  /// Middle of the surface, body coordinates, m.
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();
  /// Moments and products of inertia of the surface as a shell of even thickness about its middle,
  /// by body axes, for each kilogram, m²: xx, yy, zz, xy, xz, yz; products are −∫xy dm.
  std::array<double, 6> inertia_per_kg_m2{};
};

/// Area, volume, middle and inertia of a mesh. The same bits everywhere. O(n); vertex indices have
/// to be in range. Not finite for coordinates whose fourth powers are none in double.
CRASHRANK_API ShellProperties shell_properties(const TriangleMesh& mesh);

}  // namespace crashrank

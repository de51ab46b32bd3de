#pragma once

#include "crashrank/internal/base/export.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <Eigen/Core>

#include <array>

namespace crashrank {

/// How the surface of a body is spread.
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

#pragma once

#include "crashrank/mesh/triangle_mesh.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace crashrank {

/// What a mesh is worth before anything is computed from it. Counts and metres.
struct MeshQuality {
  std::size_t degenerate_triangles = 0;  ///< exactly collinear or coinciding corners
  std::size_t duplicate_triangles = 0;   ///< same three corners as an earlier one, any order
  std::size_t non_finite_vertices = 0;
  Eigen::Vector3d extent_m = Eigen::Vector3d::Zero();  ///< of the vertices that triangles use
  bool watertight = false;  ///< every edge (vertices welded by position) has exactly two triangles
  double area_m2 = 0.0;
  std::vector<std::string> warnings;  ///< one sentence each, for a person
};

/// Looks the mesh over. O(n log n); never fails, whatever the vertices hold.
MeshQuality assess(const TriangleMesh& mesh);

}  // namespace crashrank

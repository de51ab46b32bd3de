#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "report/palette.hpp"

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>

namespace crashrank::detail {

// Numbers of the glTF 2.0 specification.
constexpr int gltf_float = 5126;
constexpr int gltf_uint32 = 5125;
constexpr int gltf_vertices = 34962;
constexpr int gltf_indices = 34963;

/// Forward x, left y, up z become glTF's z, x, y: a turn by -120 degrees about (1, 1, 1).
inline nlohmann::ordered_json gltf_axes() { return {-0.5, -0.5, -0.5, 0.5}; }

/// Collects a document's arrays while the binary chunk grows.
struct GlbArrays {
  std::string binary;
  nlohmann::ordered_json views = nlohmann::ordered_json::array();
  nlohmann::ordered_json accessors = nlohmann::ordered_json::array();

  /// Index of the accessor of these bytes, a multiple of 4. `target`: 0 for neither vertices nor
  /// indices.
  std::size_t add(const std::string& bytes, int target, nlohmann::ordered_json accessor);
  /// The same of vertices.
  std::size_t add_positions(View<const Eigen::Vector3f> points);
  /// The same of corners of triangles, four bytes each.
  std::size_t add_indices(const std::string& bytes);
};

/// A material of this name, seen from both sides.
nlohmann::ordered_json gltf_material(const std::string& name, const Colour& colour);

/// Triangles of a mesh: indices of accessors and of a material.
nlohmann::ordered_json gltf_triangles(std::size_t positions, std::size_t indices,
                                      std::size_t material);

/// A GLB file; `document` without its arrays, asset and scene, which is its last node. Fails above
/// 4 GiB.
Result<std::string> glb_file(nlohmann::ordered_json document, GlbArrays arrays);

}  // namespace crashrank::detail

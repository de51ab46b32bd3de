#pragma once

#include "crashrank/base/result.hpp"

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
};

/// A GLB file; `document` without its arrays. Fails above 4 GiB.
Result<std::string> glb_file(nlohmann::ordered_json document, GlbArrays arrays);

}  // namespace crashrank::detail

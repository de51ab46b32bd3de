#pragma once

#include "crashrank/base/result.hpp"
#include "mesh/importer/request.hpp"

#include <cstdint>
#include <string>

struct aiScene;

namespace crashrank::importer {

/// Removes faces that name a vertex that is not there, and refuses polygons with too many corners.
/// To be called before `triangulate_faces`, which trusts both. The number removed.
Result<std::uint64_t> clear_bad_faces(aiScene& scene, const Request& request);

/// Polygons that cross themselves.
struct CrossingPolygons {
  std::uint64_t count = 0;
  std::string first;  ///< mesh and number of the first one
};

/// Replaces every polygon of more than three corners by its triangles, in place and in the order of
/// `PolygonTriangulator`.
CrossingPolygons triangulate_faces(aiScene& scene);

}  // namespace crashrank::importer

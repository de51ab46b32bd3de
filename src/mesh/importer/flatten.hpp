#pragma once

#include "crashrank/mesh/triangle_mesh.hpp"
#include "mesh/importer/request.hpp"

#include <cstdint>
#include <string>

struct aiScene;

namespace crashrank::importer {

/// Every triangle of every mesh of every node, depth first, in body coordinates. Recursion-free:
/// the depth of the node tree is the file's to choose. `metres_per_unit` is the file's own unit;
/// parts without a name are called after `file_name`, less its extension.
Result<TriangleMesh> flatten(const aiScene& scene, const Request& request, double metres_per_unit,
                             const std::string& file_name);

}  // namespace crashrank::importer

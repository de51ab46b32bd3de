#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace crashrank::importer {

/// Both write the one reply to standard output; false if no process reads it.
bool send(const TriangleMesh& mesh, std::uint64_t dropped_triangles,
          const std::vector<std::string>& warnings);
bool send(const Error& error);

}  // namespace crashrank::importer

#pragma once

#include "crashrank/mesh/triangle_mesh.hpp"
#include "mesh/importer/request.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace crashrank::importer {

struct Parsed {
  TriangleMesh mesh;
  std::uint64_t dropped_triangles = 0;
  std::vector<std::string> warnings;
};

/// Parses the mesh on standard input. Errors: bad_input, limit_exceeded.
Result<Parsed> parse(const Request& request);

}  // namespace crashrank::importer

#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <cstdint>
#include <string>

namespace crashrank {

// A body with its damaged triangles highlighted, as in figure 1 of Wiseman & Grinberg 2016, in
// formats that every mesh viewer reads. Both answer the file's bytes; `damaged` holds indices of
// triangles, each at most once, in any order, all within the mesh. Linear in the mesh; safe from
// any thread.

/// glTF 2.0 binary. Each part is a node of its name; its intact and its damaged triangles have a
/// material each, named "intact" and "damaged". Coordinates stay in body axes under one root node
/// that turns them into glTF's (y up, z forward). Errors: limit_exceeded above 4 GiB.
CRASHRANK_API Result<std::string> damage_glb(const TriangleMesh& mesh,
                                             View<const std::uint32_t> damaged);

/// Binary PLY with coloured vertices, in body coordinates, triangles in the mesh's order. Vertices
/// that both intact and damaged triangles use stand in it twice, once in each colour.
CRASHRANK_API std::string damage_ply(const TriangleMesh& mesh, View<const std::uint32_t> damaged);

}  // namespace crashrank

#pragma once

#include <cstddef>
#include <cstdint>

namespace crashrank::importer {

/// Triangles that a glTF 2 file, JSON or binary, announces in its accessors: lists, strips and
/// fans, each mesh once. 0 where its JSON cannot be made out.
std::uint64_t gltf_triangles(int descriptor, std::size_t max_bytes);

}  // namespace crashrank::importer

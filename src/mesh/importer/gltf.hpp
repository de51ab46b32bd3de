#pragma once

#include "mesh/importer/folder_io.hpp"
#include "mesh/importer/parse.hpp"

#include <cstddef>
#include <optional>

namespace crashrank::importer {

/// Reads the glTF 2 file on standard input, without `skip` bytes at its start, as the format says:
/// the default scene, transforms in double, sparse and normalised accessors, strips and fans,
/// default morph weights, skins at rest, instances, hidden nodes, Draco and meshopt compression.
/// Each primitive of each visible node is a part. Extensions that the file requires and that are
/// not supported are an error, unless they concern materials, textures or lights alone. Nothing for
/// files of version 1. Errors: bad_input, limit_exceeded.
Result<std::optional<Parsed>> parse_gltf(const Request& request, std::size_t skip, FolderIo& files);

}  // namespace crashrank::importer

#pragma once

#include "crashrank/base/result.hpp"
#include "mesh/importer/folder_io.hpp"
#include "mesh/importer/request.hpp"

#include <tiny_gltf.h>

#include <cstddef>
#include <string>
#include <vector>

namespace crashrank::importer {

/// Bytes that something else owns.
struct GltfBytes {
  const unsigned char* begin = nullptr;
  std::size_t size = 0;
};

/// The structure of a glTF file and its buffers. Images and animations are left out, as are buffers
/// that only programs without EXT_meshopt_compression need, and the indices of Draco primitives,
/// which are in the compressed data.
struct GltfFile {
  std::string bytes;       ///< of the file; buffers may lie in it
  bool version_1 = false;  ///< a file of glTF 1: nothing else was read
  tinygltf::Model model;   ///< without buffers; indices in it may point anywhere
  std::vector<GltfBytes> buffers;
  std::vector<std::vector<unsigned char>> owned;  ///< buffers that do not lie in the file
};

/// An error of a glTF file: `place` names an element, as "accessor 3".
Error gltf_error(std::string place, std::string reason);

/// Reads the glTF file on standard input, without `skip` bytes at its start.
/// Errors: bad_input, limit_exceeded.
Result<GltfFile> read_gltf_file(const Request& request, std::size_t skip, FolderIo& files);

}  // namespace crashrank::importer

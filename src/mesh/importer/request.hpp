#pragma once

#include "crashrank/mesh/triangle_mesh.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace crashrank::importer {

/// What the library asks of this program, from its command line: KEY=VALUE words.
struct Request {
  std::string path;
  std::string extension;  ///< lower case, without the dot
  double seconds = 0.0;
  std::size_t memory_bytes = 0;
  std::size_t file_bytes = 0;
  std::size_t triangles = 0;
  std::size_t vertices = 0;
  std::size_t parts = 0;
  std::size_t polygon_corners = 0;
  std::size_t name_bytes = 0;
  ImportTransform transform;
};

/// The error of a file that needs more memory than there is. The process may have been started
/// under a tighter limit than the one it was asked to keep.
Error out_of_memory(const Request& request);

/// Errors: usage, naming the word that is missing or wrong.
Result<Request> parse_request(const std::vector<std::string>& words);

}  // namespace crashrank::importer

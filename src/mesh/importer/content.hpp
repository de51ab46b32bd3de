#pragma once

#include "crashrank/base/result.hpp"

#include <cstddef>
#include <string>

namespace crashrank::importer {

/// What the first bytes of a file show.
struct Content {
  std::size_t skip = 0;  ///< bytes of a byte order mark, which some parsers stumble over
};

/// Refuses files whose bytes contradict their extension, archives (a small one can unpack to
/// gigabytes), XML entities, units that are no length and Collada's skew, which the parser does not
/// know. Reads the descriptor by position.
Result<Content> look_at(int descriptor, const std::string& extension);

/// Up to `size` bytes from `offset` on; fewer at the end of the file.
std::string read_at(int descriptor, std::size_t offset, std::size_t size);

}  // namespace crashrank::importer

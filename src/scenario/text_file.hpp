#pragma once

#include "crashrank/base/result.hpp"

#include <cstddef>
#include <string>

namespace crashrank::detail {

/// The text of a regular file, or one byte more than `most_bytes` of a larger one, which its parser
/// then refuses. `wanted` is the remedy where the name is that of a folder or a device. Errors:
/// not_found.
Result<std::string> read_text_file(const std::string& file, std::size_t most_bytes,
                                   const std::string& wanted);

}  // namespace crashrank::detail

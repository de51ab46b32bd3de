#pragma once

#include "crashrank/base/result.hpp"

#include <optional>

namespace crashrank::importer {

/// The first line of an OBJ file whose face names a corner that the file does not have, or else
/// whose corner has fewer than three numbers: its place and what is wrong there. For files that the
/// parser refused, which names no line. Nothing where no such line is found, or where lines go on
/// in others or are very long. Reads the descriptor by position, twice, a window at a time.
std::optional<Error> find_obj_fault(int descriptor);

}  // namespace crashrank::importer

#pragma once

#include "crashrank/base/result.hpp"

#include <optional>

namespace crashrank::importer {

/// The first line of an OBJ file whose corner has fewer than three numbers, or else whose face names
/// a corner that the file does not have: its place and what is wrong there. For files that the
/// parser refused, which names no line. Nothing where no such line is found. Reads the descriptor
/// by position, twice at most, a window at a time.
std::optional<Error> find_obj_fault(int descriptor);

}  // namespace crashrank::importer

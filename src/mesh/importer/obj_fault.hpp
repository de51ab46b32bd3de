#pragma once

#include "crashrank/base/result.hpp"

#include <cstdint>
#include <optional>

namespace crashrank::importer {

/// Looks for vertices of an OBJ file that the parser would pass over without a word, so that each
/// one after them took the number of another: lines that do not begin with "v ", that are joined to
/// the line before by its backslash, or whose numbers are too few, too many or written as the
/// parser reads none. Returns how many lines mean a face, whether the parser reads them or not: it
/// passes over those that are indented, written F, or have fewer than three corners.
/// Errors: bad_input, naming the line; also for a face that is joined to the line before.
/// Reads the descriptor by position, once, a window at a time.
Result<std::uint64_t> check_obj_lines(int descriptor);

/// The first line of an OBJ file whose face names a vertex that the file does not have. For files
/// that the parser refused, which names no line. Nothing where no such line is found, or where one
/// is very long. Reads the descriptor by position, twice, a window at a time.
std::optional<Error> find_obj_fault(int descriptor);

}  // namespace crashrank::importer

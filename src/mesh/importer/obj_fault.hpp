#pragma once

#include "crashrank/base/result.hpp"

#include <cstdint>
#include <optional>

namespace crashrank::importer {

/// The first line of an OBJ file whose face names a corner that the file does not have, or else
/// whose corner has fewer than three numbers: its place and what is wrong there. For files that the
/// parser refused, which names no line. Nothing where no such line is found, or where lines go on
/// in others or are very long. Reads the descriptor by position, twice, a window at a time.
std::optional<Error> find_obj_fault(int descriptor);

/// Lines of an OBJ file that mean a face, whether the parser reads them or not: it passes over
/// those that are indented, written F, or have fewer than three corners. 0 where lines go on in
/// others.
std::uint64_t obj_face_lines(int descriptor);

}  // namespace crashrank::importer

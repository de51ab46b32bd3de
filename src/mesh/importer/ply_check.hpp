#pragma once

#include "crashrank/base/result.hpp"

namespace crashrank::importer {

/// Looks for what the parser would not say of a PLY file: where the file ends before the vertices
/// and faces that its header promises, it repeats the last face or ends the process. Headers that
/// cannot be read and elements that are no numbers are for the parser to refuse. Errors: bad_input,
/// with what is missing. Reads the descriptor by position, once, a window at a time.
Status check_ply_end(int descriptor);

}  // namespace crashrank::importer

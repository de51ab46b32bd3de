#pragma once

#include "crashrank/base/result.hpp"

namespace crashrank::importer {

/// Looks for what the parser would not say of a PLY file. Where the file ends before the vertices
/// and faces that its header promises, it repeats the last face or ends the process; elements that
/// stand before the vertices, and lists between these and the faces, it takes for other ones;
/// elements without properties it counts for seconds. Headers that cannot be read are for the
/// parser to refuse. Errors: bad_input, with what is wrong. Reads the descriptor by position, once,
/// a window at a time.
Status check_ply(int descriptor);

}  // namespace crashrank::importer

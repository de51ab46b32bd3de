#pragma once

#include "crashrank/base/result.hpp"

#include <cstdint>
#include <string>

namespace crashrank::importer {

/// Looks for what the parser would not say of an OFF file: it ends the process where the file ends
/// before the vertices and faces which its header promises, and puts the last vertex in place of
/// one that is not there. Returns the number of faces with three corners or more; the parser passes
/// over those of more than nine corners and, where comments stand among the faces, over as many at
/// the end. 0 where there is no header that can be read, which is for the parser to refuse.
/// Errors: bad_input, naming the line. Reads the descriptor by position, once.
Result<std::uint64_t> check_off_lines(int descriptor);

/// Refuses AC3D objects that the parser misplaces: it turns an object's vertices after moving them,
/// and does not move the objects below one that has vertices; and surfaces that it leaves out,
/// those whose material the file does not have. Errors: bad_input, naming the line. Reads the
/// descriptor by position, once.
Status check_ac3d_places(int descriptor);

/// A warning where the text of an STL file ends within a facet or without "endsolid"; empty
/// otherwise, and for binary files. Reads the descriptor by position, once.
std::string describe_stl_cut(int descriptor);

/// The number of bytes against the one that the header of a binary STL file promises, for a file
/// that the parser takes for neither text nor binary. Reads the descriptor by position.
std::string describe_binary_stl(int descriptor);

}  // namespace crashrank::importer

#pragma once

#include <crashrank/mesh/triangle_mesh.hpp>

#include <string>
#include <vector>

/// A few collision queries on surfaces made without libm; the answer as text.
std::string ask_everything();
/// Sizes, alignments and member offsets of public types as this translation unit sees them.
std::vector<std::size_t> layout();

/// The same from a translation unit compiled with other flags.
std::string ask_everything_v3();
std::vector<std::size_t> layout_v3();

/// An uneven surface of 2·n·n triangles about the z plane.
crashrank::TriangleMesh bumpy_sheet(int n);

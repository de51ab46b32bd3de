#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <cstddef>
#include <string>

namespace oracle {

/// Reads the triangles of a Wavefront OBJ as the project's own generator writes it: `v` and
/// triangular `f` lines, plain positive indices. Made for the shipped models, so that these checks
/// need no importer.
crashrank::Result<crashrank::TriangleMesh> read_obj(const std::string& path);

/// The mesh with all vertices in one cell of a grid of `cell_m` made one of them. Faces that lose
/// all area by it go, but for the first ten: degenerate and duplicate triangles belong to the
/// check.
crashrank::TriangleMesh reduced(const crashrank::TriangleMesh& mesh, float cell_m);

/// Reduced with the finest of a row of grids that leaves at most `triangles`.
crashrank::TriangleMesh reduced_to(const crashrank::TriangleMesh& mesh, std::size_t triangles);

}  // namespace oracle

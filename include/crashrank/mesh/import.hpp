#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/mesh/properties.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace crashrank {

/// Limits on the size and cost of a file that is not trusted.
struct ImportLimits {
  std::size_t file_bytes = std::size_t{512} << 20;    ///< of the mesh, and of each file it names
  std::size_t memory_bytes = std::size_t{900} << 20;  ///< address space of the importing process
  double seconds = 4.0;                  ///< processor time; wall time may be 15 times as long
  double seconds_per_mebibyte = 0.5;     ///< added to `seconds` for the size of the file
  std::size_t triangles = 20'000'000;    ///< of the whole file
  std::size_t vertices = 60'000'000;     ///< of the whole file
  std::size_t parts = 100'000;           ///< of the whole file
  std::size_t polygon_corners = 10'000;  ///< of one polygon: cutting it up is quadratic
};

/// How a file is read.
struct ImportOptions {
  ImportTransform transform;  ///< from file to body coordinates
  ImportLimits limits;        ///< limits above which a file is refused
  std::string importer;  ///< path of the crashrank-import program; empty: searched as stated below
  /// Path of a header of the installation that the caller was compiled against. A static library
  /// has no place of its own from which it could find the importer, but its headers have: this
  /// follows a moved prefix without a compile definition. Ignored unless absolute.
  std::string header = __FILE__;
};

/// A mesh and the warnings about its file.
struct ImportedMesh {
  TriangleMesh mesh;                  ///< the surface
  MeshQuality quality;                ///< what is wrong with it
  std::size_t dropped_triangles = 0;  ///< faces with a vertex index out of range
  std::vector<std::string> warnings;  ///< the file's and the mesh's, one sentence each
};

/// Reads OBJ, STL, PLY, OFF, glTF/GLB, Collada (.dae), FBX, 3DS or AC3D (.ac), selected by the file
/// name's extension.
///
/// Axes stay as the file has them (Collada's up_axis is not applied: say `up`). Lengths are metres
/// where the format knows its unit (Collada's unit, FBX's UnitScaleFactor, glTF), file units
/// otherwise; then `transform` is applied. Node transforms are applied in double and rounded to
/// float32 once; a mirroring node has its triangles turned over, so that outside stays outside.
/// Triangles come in the order nodes depth first, the node's meshes, their faces; polygons are cut
/// into triangles in place by exact ear clipping (convex ones of four corners from the first, of
/// more from the last); points and lines are left out; degenerate and duplicate triangles keep
/// their places. Vertices are those that triangles use, equal positions merged. Each mesh of a node
/// is a part, named by node, else mesh, else material, else file; a repeated name is extended by
/// material or mesh where they differ ("body/glass") and by a number otherwise ("wheel.2").
/// Animation and textures are ignored. glTF's morph weights, instances, hidden nodes and skins at
/// rest count; other formats' skins do not.
///
/// The parser runs in a process of its own, with the limits above, and opens no file outside the
/// mesh's folder; its reply is checked before use. That program, crashrank-import,
/// is `options.importer`, else the environment's CRASHRANK_IMPORTER, else the first that exists of:
/// beside the running executable, in the installation of that executable, of the shared library,
/// of `options.header`, and at the prefix that crashrank was configured for.
///
/// Blocks until that process has ended. Safe from any thread.
/// Errors: usage (transform), not_found, bad_input, limit_exceeded, out_of_memory; internal when
/// the importer cannot be started.
CRASHRANK_API Result<ImportedMesh> import_mesh(const std::string& path,
                                               const ImportOptions& options = {});

}  // namespace crashrank

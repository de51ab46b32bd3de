#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace crashrank {

/// Which way a file's axis points, for files that do not follow x forward, z up.
enum class Axis { plus_x, minus_x, plus_y, minus_y, plus_z, minus_z };

/// How file coordinates become body coordinates: rotate so that `forward` is +x and `up` is +z,
/// scale, then subtract `origin_m` (in body axes, after scaling).
struct ImportTransform {
  double scale = 1.0;  ///< metres per file unit
  Axis up = Axis::plus_z;
  Axis forward = Axis::plus_x;
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
};

/// Bounds on what a stranger's file may cost.
struct ImportLimits {
  std::size_t file_bytes = std::size_t{512} << 20;
  std::size_t memory_bytes = std::size_t{900} << 20;  ///< address space of the importing process
  double seconds = 4.0;                               ///< processor and wall time alike
  std::size_t triangles = 20'000'000;
  std::size_t vertices = 60'000'000;
};

struct ImportOptions {
  ImportTransform transform;
  ImportLimits limits;
  std::string importer;  ///< path of the crashrank-import program; empty: found as documented
};

/// A mesh with what had to be said about its file.
struct ImportedMesh {
  TriangleMesh mesh;
  std::size_t dropped_triangles = 0;  ///< faces that named a vertex that is not there
  std::vector<std::string> warnings;
};

/// Reads OBJ, STL, PLY, OFF, glTF/GLB, Collada, FBX, 3DS or AC3D. The parser runs in a process of
/// its own with the limits above and cannot reach files outside the mesh's folder; what comes back
/// is checked before it is believed. Blocks until that process has ended. Safe from any thread.
/// Errors: not_found, bad_input, limit_exceeded; internal when the importer cannot be started.
Result<ImportedMesh> import_mesh(const std::string& path, const ImportOptions& options = {});

}  // namespace crashrank

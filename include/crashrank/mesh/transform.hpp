#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <string>

namespace crashrank {

/// Which way a file's axis points, for files that do not follow x forward, z up.
enum class Axis : std::uint8_t { plus_x, minus_x, plus_y, minus_y, plus_z, minus_z };

/// How file coordinates become body coordinates: rotate so that `forward` is +x and `up` is +z,
/// scale, then subtract `origin_m` (in body axes, after scaling).
struct ImportTransform {
  double scale = 1.0;                                  ///< metres per file unit
  Axis up = Axis::plus_z;                              ///< the file's axis that points up
  Axis forward = Axis::plus_x;                         ///< the file's axis that points forward
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();  ///< what becomes 0, m
};

/// Unit vector of an axis, in file coordinates.
inline Eigen::Vector3d direction(Axis axis) {
  Eigen::Vector3d unit = Eigen::Vector3d::Zero();
  const int index = static_cast<int>(axis);
  unit[index / 2] = index % 2 == 0 ? 1.0 : -1.0;
  return unit;
}

/// "+x", "x", "-y" and so on, upper case too. Errors: usage.
CRASHRANK_API Result<Axis> axis_from_name(const std::string& name);

/// Refuses a transform that is none: scale not positive and finite, up and forward on one line, an
/// origin that is not finite. Errors: usage.
CRASHRANK_API Status check(const ImportTransform& transform);

/// One point from file to body coordinates, m, in double. The default transform changes no bit
/// (but the sign of a zero).
inline Eigen::Vector3d apply(const ImportTransform& transform, const Eigen::Vector3d& point) {
  const Eigen::Vector3d forward = direction(transform.forward);
  const Eigen::Vector3d up = direction(transform.up);
  const Eigen::Vector3d left(up.y() * forward.z() - up.z() * forward.y(),
                             up.z() * forward.x() - up.x() * forward.z(),
                             up.x() * forward.y() - up.y() * forward.x());
  // Each row holds one ±1, so the dot products are exact.
  return Eigen::Vector3d(forward.dot(point), left.dot(point), up.dot(point)) * transform.scale -
         transform.origin_m;
}

/// Carries every vertex of a mesh that was loaded without a transform. Errors: as `check`, and
/// bad_input when a vertex leaves the range of float32; the mesh is then unchanged.
CRASHRANK_API Status transform_mesh(TriangleMesh& mesh, const ImportTransform& transform);

}  // namespace crashrank

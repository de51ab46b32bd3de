#pragma once

#include "crashrank/mesh/triangle_mesh.hpp"

#include <Eigen/Core>

namespace crashrank::detail {

/// Which end of a vehicle's body is its front, by three signs: mirrors stand out beside the
/// windscreen; the cabin stands nearer to the rear, behind an inclined windscreen; the nose is
/// lower than the tail. Returns 1 for the end towards `forward`, -1 for the opposite end, and 0
/// where the signs are too few or contradict each other. `forward` and `up` are axes of the mesh.
/// O(triangles).
int front_by_shape(const TriangleMesh& mesh, const Eigen::Vector3d& forward,
                   const Eigen::Vector3d& up);

}  // namespace crashrank::detail

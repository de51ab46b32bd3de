#pragma once

#include "crashrank/mesh/triangle_mesh.hpp"

#include <Eigen/Core>

#include <vector>

namespace crashrank::cli {

/// Corners of an outline seen from above, counter-clockwise, m.
using Outline = std::vector<Eigen::Vector2d>;

/// Upright prism from `low` to `high`, m, over an outline that is star-shaped about the mean of its
/// corners.
TriangleMesh prism(const Outline& outline, double low, double high);

/// Prism over the rectangle of two opposite corners.
TriangleMesh box_prism(const Eigen::Vector3d& least, const Eigen::Vector3d& greatest);

}  // namespace crashrank::cli

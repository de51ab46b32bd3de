#pragma once

#include <Eigen/Core>

#include <vector>

namespace crashrank::detail {

/// Convex hull of points, counter-clockwise from the leftmost; points on its edges are left out.
/// O(n log n).
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points);

}  // namespace crashrank::detail

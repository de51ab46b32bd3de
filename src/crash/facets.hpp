#pragma once

#include "crashrank/crash/depth_map.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace crashrank::detail {

/// A piece of a body's surface in view coordinates (u, w).
struct Facet {
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();  ///< unit, out of the body
  double area_m2 = 0.0;
  std::size_t row = 0;
};

/// The side of a body that looks against the view, row by row: a line through the cells' middles,
/// cut into pieces no longer than a cell, closed by the flanks where the body ends. Only what lies
/// before `deepest_m` and behind `nearest_m` counts, and no more than `most_facets`, which is
/// several times what cars and lorries have. `facets` is emptied first.
void facets_of(const DepthMap& map, double nearest_m, double deepest_m, std::vector<Facet>& facets);

inline constexpr std::size_t most_facets = std::size_t{1} << 20U;

}  // namespace crashrank::detail

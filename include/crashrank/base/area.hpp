#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/internal/base/export.hpp"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace crashrank {

/// A region of the horizontal plane: a polygon with holes, world x and y, m. Rings are open (the
/// last corner is joined with the first) and turn either way.
struct Area {
  std::vector<Eigen::Vector2d> outer;               ///< its border, at least three corners
  std::vector<std::vector<Eigen::Vector2d>> holes;  ///< regions that are excluded
};

/// Checks that an area is valid: rings of at least three finite corners, of which no two edges of
/// the area cross or touch except neighbours in their common corner, and holes inside the outer
/// one. `place` names it in errors.
/// Errors: bad_input naming the ring and its edges. O(corners²).
CRASHRANK_API Status check_area(const Area& area, const std::string& place);

/// Returns true if a point lies in at least one of the areas. Points of an edge that two areas
/// share belong to exactly one of them. Points on a border count as inside or outside by rounding.
/// O(corners).
CRASHRANK_API bool holds(View<const Area> areas, const Eigen::Vector2d& point_m) noexcept;

/// Distance of a point to the nearest border of any of the areas, m; infinity without areas.
/// O(corners).
CRASHRANK_API double distance_to_border_m(View<const Area> areas,
                                          const Eigen::Vector2d& point_m) noexcept;

}  // namespace crashrank

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
  std::vector<std::vector<Eigen::Vector2d>> holes;  ///< what is cut out of it
};

/// Whether the area is sound: rings of at least three corners, finite, of which no two edges of the
/// area cross or touch but neighbours in their common corner. `place` names it in errors. Errors:
/// bad_input naming the ring and its edges. O(corners²).
CRASHRANK_API Status check_area(const Area& area, const std::string& place);

/// Whether a point lies in at least one of the areas. Of areas with a common edge each of its
/// points belongs to exactly one. Points on a border count as in or out by rounding alone.
/// O(corners).
CRASHRANK_API bool holds(View<const Area> areas, const Eigen::Vector2d& point_m) noexcept;

/// Distance of a point to the nearest border of any of the areas, m; infinity without areas.
/// O(corners).
CRASHRANK_API double distance_to_border_m(View<const Area> areas,
                                          const Eigen::Vector2d& point_m) noexcept;

}  // namespace crashrank

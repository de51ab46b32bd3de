#pragma once

#include <Eigen/Core>

#include <array>
#include <vector>

namespace crashrank::detail {

/// A straight piece of a mesh's section by a horizontal plane, m.
using SectionSegment = std::array<Eigen::Vector2d, 2>;

/// A closed line, first point not repeated; what it encloses lies to its left.
using OutlineLoop = std::vector<Eigen::Vector2d>;

/// Lines around what a section encloses, seen from outside: gaps of up to two cells are closed and
/// what lies inside is left out. `cell_m` grows where the raster would exceed 4 million cells, or
/// the segments together would be longer than 10 million cells. Points lie on the segments where
/// those are near, and within `tolerance_m` of the rastered line.
std::vector<OutlineLoop> trace_outlines(const std::vector<SectionSegment>& segments, double cell_m,
                                        double tolerance_m);

/// Area that a loop encloses, m²; negative where it runs clockwise.
double loop_area_m2(const OutlineLoop& loop);

}  // namespace crashrank::detail

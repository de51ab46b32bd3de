#pragma once

#include "rank/scene.hpp"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace crashrank::detail {

/// A fixed body's box seen from above, world axes.
struct Rectangle {
  Eigen::Vector2d center;
  std::array<Eigen::Vector2d, 2> axis;  ///< unit
  std::array<double, 2> half;           ///< m
};

Rectangle rectangle_of(const Body& fixed);

/// From a point to the rectangle, 0 inside it, m.
double distance_m(const Rectangle& rectangle, const Eigen::Vector2d& point);

/// Whether the outlines of two fixed bodies come within 50 mm of each other or overlap, seen from
/// above. The rectangles are theirs. O(1) where these are further apart, else O(n·log n) in the
/// pieces of the outlines near each other, and O(n) a loop of them where they do not adjoin.
/// Allocates.
bool adjoin(const Body& p, const Rectangle& box_p, const Body& q, const Rectangle& box_q);

}  // namespace crashrank::detail

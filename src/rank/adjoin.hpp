#pragma once

#include "rank/scene.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// Bounding rectangle of a fixed body in plan view, world axes.
struct Rectangle {
  Eigen::Vector2d center;
  std::array<Eigen::Vector2d, 2> axis;  ///< unit vectors of the sides
  std::array<double, 2> half;           ///< half the side along each axis, m
  double low_m = 0.0;                   ///< world z of its lower end, m
  double high_m = 0.0;                  ///< and of its upper end, m
};

Rectangle rectangle_of(const Body& fixed);

/// Distance from a point to the rectangle, m; 0 inside it.
double distance_m(const Rectangle& rectangle, const Eigen::Vector2d& point);

/// Returns true if two fixed bodies are parts of one structure: in plan view their outlines overlap
/// or are at most 50 mm apart. The gap may be up to `widest_joint_m` where the bodies stand end to
/// end, provided that the wider end is at most twice as wide as the other. `box_p` and `box_q` are
/// the rectangles of p and q. Complexity: O(1) if the rectangles are further apart than that;
/// otherwise O(n·log n) in the outline pieces near the other body, plus O(n) for each of their
/// loops if the bodies do not adjoin. Allocates.
bool adjoin(const Body& p, const Rectangle& box_p, const Body& q, const Rectangle& box_q);

/// Widest gap between two parts of one structure, m.
inline constexpr double widest_joint_m = 0.3;

/// For each piece of the common profile of several bodies: 1 if another piece faces it within
/// `widest_joint_m`, that is, if it lies in a joint; otherwise 0. O(n·log n) for pieces that are
/// spread evenly. Allocates.
std::vector<std::uint8_t> pieces_in_joints(const Profile& profile);

}  // namespace crashrank::detail

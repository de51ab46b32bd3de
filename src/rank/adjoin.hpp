#pragma once

#include "rank/scene.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
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

/// Whether two fixed bodies are parts of one: their outlines, seen from above, overlap or come
/// within 50 mm of each other, or within `widest_joint_m` where they stand end to end, of which one
/// is at most twice as wide as the other. The rectangles are theirs. O(1) where these are further
/// apart, else O(n·log n) in the pieces of the outlines near each other, and O(n) a loop of them
/// where they do not adjoin. Allocates.
bool adjoin(const Body& p, const Rectangle& box_p, const Body& q, const Rectangle& box_q);

/// Joints between parts of one body are no wider, m.
inline constexpr double widest_joint_m = 0.3;

/// Of the pieces of a profile that is that of several bodies, those before which another faces them
/// within `widest_joint_m`: 1, else 0. O(n·log n) where pieces are spread evenly. Allocates.
std::vector<std::uint8_t> pieces_in_joints(const Profile& profile);

}  // namespace crashrank::detail

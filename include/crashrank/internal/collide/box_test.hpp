#pragma once

#include "crashrank/base/box.hpp"
#include "crashrank/base/pose.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace crashrank {

/// Where B's boxes stand in the frame of A's boxes, with the margins that make the box test err on
/// the side of "overlap" only. Made once per query.
struct BoxTransform {
  Eigen::Matrix3d rotation;      ///< B's box axes in A's box axes
  Eigen::Matrix3d abs_rotation;  ///< entrywise absolute values
  Eigen::Vector3d translation;   ///< B's origin in A's axes, m
  double margin_a = 0.0;         ///< m, added along A's axes
  double margin_b = 0.0;         ///< m, added along B's axes
};

namespace detail {
inline double largest_coordinate(const Box& box) {
  return std::max(static_cast<double>(box.min.cwiseAbs().maxCoeff()),
                  static_cast<double>(box.max.cwiseAbs().maxCoeff()));
}
}  // namespace detail

/// Margins. Let S = |t|₁ + 3·(largest coordinate of A's root box + that of B's): no sum formed
/// below exceeds 4·S in magnitude, and no chain of operations is longer than 24, so with u = 2^-53
/// everything the test computes is within 24·4·u·S < 2^-46·S of the real number meant. The vertices
/// are not where the real motion puts them either: `carry` rounds four times, 4·u·S. Box axes are
/// orthonormal within 2^-46 (validate() refuses others), which moves a box by at most 3·2^-46·S.
/// Together below 5·2^-46·S; 2^-43·S is used. Along B's axes a pose that is not quite a rotation
/// (up to 1e-6 is accepted) turns a box of half extents h into one of half extents |RᵀR|·h.
inline BoxTransform box_transform(const AabbTree& a, const AabbTree& b, const Pose& b_in_a) {
  BoxTransform to;
  to.rotation = b_in_a.rotation;
  to.translation = b_in_a.translation;
  if (!b.axes_are_world) to.rotation = detail::multiply(to.rotation, b.axes);
  if (!a.axes_are_world) {
    const Eigen::Matrix3d back = a.axes.transpose();
    to.rotation = detail::multiply(back, to.rotation);
    to.translation = detail::rotate(back, to.translation);
  }
  to.abs_rotation = to.rotation.cwiseAbs();
  const double b_size = detail::largest_coordinate(b.nodes[0].box);
  const double size =
      to.translation.cwiseAbs().sum() + 3.0 * (detail::largest_coordinate(a.nodes[0].box) + b_size);
  to.margin_a = 0x1p-43 * size;
  const Eigen::Matrix3d skew =
      detail::multiply(to.rotation.transpose(), to.rotation) - Eigen::Matrix3d::Identity();
  to.margin_b = to.margin_a + skew.cwiseAbs().rowwise().sum().maxCoeff() * 2.0 * b_size;
  return to;
}

/// Separates two boxes along the six face normals; the nine edge pairs are not worth their time
/// (they reject a few percent more and double the cost). False means certainly apart. NaN and
/// infinity compare as overlap.
inline bool boxes_may_touch(const Box& a, const Box& b, const BoxTransform& to) {
  const Eigen::Vector3d a_min = a.min.cast<double>();
  const Eigen::Vector3d a_max = a.max.cast<double>();
  const Eigen::Vector3d b_min = b.min.cast<double>();
  const Eigen::Vector3d b_max = b.max.cast<double>();
  const Eigen::Vector3d a_half = 0.5 * (a_max - a_min);
  const Eigen::Vector3d b_half = 0.5 * (b_max - b_min);
  const Eigen::Vector3d b_center = 0.5 * (b_max + b_min);
  const Eigen::Matrix3d& r = to.rotation;
  const Eigen::Matrix3d& s = to.abs_rotation;
  const Eigen::Vector3d apart =
      detail::rotate(r, b_center) + to.translation - 0.5 * (a_max + a_min);
  for (int i = 0; i < 3; ++i) {
    const double reach = a_half[i] + (s(i, 0) * b_half[0] + s(i, 1) * b_half[1]) +
                         (s(i, 2) * b_half[2] + to.margin_a);
    if (std::abs(apart[i]) > reach) return false;
  }
  for (int j = 0; j < 3; ++j) {
    const double distance = (r(0, j) * apart[0] + r(1, j) * apart[1]) + r(2, j) * apart[2];
    const double reach = b_half[j] + (s(0, j) * a_half[0] + s(1, j) * a_half[1]) +
                         (s(2, j) * a_half[2] + to.margin_b);
    if (std::abs(distance) > reach) return false;
  }
  return true;
}

}  // namespace crashrank

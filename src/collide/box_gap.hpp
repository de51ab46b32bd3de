#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/internal/collide/box_test.hpp"

#include <Eigen/Core>

#include <cmath>

namespace crashrank::detail {

/// Where two boxes lie apart: how far along each axis of a frame, signed from A to B, 0 along axes
/// on which they overlap. Its length is a lower bound of their distance.
struct BoxGap {
  Eigen::Vector3d along_a;  ///< axes of A's boxes
  Eigen::Vector3d along_b;  ///< axes of B's boxes
};

inline double positive_gap(double apart, double reach) {
  const double gap = std::abs(apart) - reach;
  return gap > 0.0 ? std::copysign(gap, apart) : 0.0;
}

/// A box by its middle and half its extent.
struct CentredBox {
  Eigen::Vector3d center;
  Eigen::Vector3d half;
};

inline CentredBox centred(const Box& box) {
  const Eigen::Vector3d low = box.min.cast<double>();
  const Eigen::Vector3d high = box.max.cast<double>();
  return {0.5 * (high + low), 0.5 * (high - low)};
}

/// `apart`: from A's middle to B's, along A's axes.
inline BoxGap box_gap(const CentredBox& a, const CentredBox& b, const Eigen::Vector3d& apart,
                      const BoxTransform& to) {
  const Eigen::Matrix3d& r = to.rotation;
  const Eigen::Matrix3d& s = to.abs_rotation;
  BoxGap gap;
  for (int i = 0; i < 3; ++i) {
    const double reach_a = a.half[i] + (s(i, 0) * b.half[0] + s(i, 1) * b.half[1]) +
                           (s(i, 2) * b.half[2] + to.margin_a);
    gap.along_a[i] = positive_gap(apart[i], reach_a);
    const double b_apart = (r(0, i) * apart[0] + r(1, i) * apart[1]) + r(2, i) * apart[2];
    const double reach_b = b.half[i] + (s(0, i) * a.half[0] + s(1, i) * a.half[1]) +
                           (s(2, i) * a.half[2] + to.margin_b);
    gap.along_b[i] = positive_gap(b_apart, reach_b);
  }
  return gap;
}

inline BoxGap box_gap(const Box& a, const Box& b, const BoxTransform& to) {
  const CentredBox box_a = centred(a);
  const CentredBox box_b = centred(b);
  const Eigen::Vector3d at = rotate(to.rotation, box_b.center) + to.translation;
  return box_gap(box_a, box_b, at - box_a.center, to);
}

/// Factor that makes a length measured along B's axes a lower bound in A's frame when the pose is
/// not quite a rotation: |Rᵀd|² = dᵀRRᵀd <= (1 + 3e)·|d|² with e the largest entry of |RRᵀ - 1|.
/// The constant covers the rounding of a length (four roundings and a root).
inline double shrink_along_b(const BoxTransform& to) {
  const Eigen::Matrix3d skew =
      multiply(to.rotation, to.rotation.transpose()) - Eigen::Matrix3d::Identity();
  return 1.0 - 3.0 * skew.cwiseAbs().maxCoeff() - 0x1p-48;
}

}  // namespace crashrank::detail

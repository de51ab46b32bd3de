#pragma once

#include "crashrank/base/version.hpp"

#include <Eigen/Core>

namespace crashrank::detail {

// Written out, because Eigen's products fuse multiply and add where the caller's flags allow it,
// and a pose has to have the same bits in every translation unit.
inline Eigen::Vector3d rotate(const Eigen::Matrix3d& r, const Eigen::Vector3d& v) {
  return {(r(0, 0) * v.x() + r(0, 1) * v.y()) + r(0, 2) * v.z(),
          (r(1, 0) * v.x() + r(1, 1) * v.y()) + r(1, 2) * v.z(),
          (r(2, 0) * v.x() + r(2, 1) * v.y()) + r(2, 2) * v.z()};
}

inline Eigen::Matrix3d multiply(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  Eigen::Matrix3d product;
  for (int j = 0; j < 3; ++j) product.col(j) = rotate(a, b.col(j));
  return product;
}

}  // namespace crashrank::detail

#pragma once

#include "crashrank/internal/collide/triangle_test.hpp"

#include <Eigen/Core>

namespace crashrank::test {

inline TriangleD triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                          const Eigen::Vector3d& c) {
  return {{a, b, c}};
}

}  // namespace crashrank::test

#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/internal/base/products.hpp"

#include <assimp/matrix4x4.h>

#include <Eigen/Core>

#include <cmath>

namespace crashrank::importer {

/// A node's transform in double: linear part and translation.
struct Affine {
  Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Eigen::Vector3d operator()(const Eigen::Vector3d& point) const {
    return crashrank::detail::rotate(linear, point) + translation;
  }
  bool finite() const { return linear.allFinite() && translation.allFinite(); }
  bool mirrors() const { return linear.row(0).dot(linear.row(1).cross(linear.row(2))) < 0.0; }
};

/// Applies `inner` first.
inline Affine compose(const Affine& outer, const Affine& inner) {
  return {crashrank::detail::multiply(outer.linear, inner.linear), outer(inner.translation)};
}

inline Affine from_assimp(const aiMatrix4x4& m) {
  Affine affine;
  affine.linear << m.a1, m.a2, m.a3, m.b1, m.b2, m.b3, m.c1, m.c2, m.c3;
  affine.translation << m.a4, m.b4, m.c4;
  return affine;
}

inline bool is_affine(const aiMatrix4x4& m) {
  return m.d1 == 0.0F && m.d2 == 0.0F && m.d3 == 0.0F && m.d4 == 1.0F;
}

}  // namespace crashrank::importer

#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/internal/base/products.hpp"

namespace crashrank {

inline Pose compose(const Pose& outer, const Pose& inner) {
  return {detail::multiply(outer.rotation, inner.rotation),
          detail::rotate(outer.rotation, inner.translation) + outer.translation};
}

inline Pose inverse(const Pose& pose) {
  const Eigen::Matrix3d back = pose.rotation.transpose();
  return {back, -detail::rotate(back, pose.translation)};
}

inline Pose relative(const Pose& a_in_world, const Pose& b_in_world) {
  const Eigen::Matrix3d back = a_in_world.rotation.transpose();
  return {detail::multiply(back, b_in_world.rotation),
          detail::rotate(back, b_in_world.translation - a_in_world.translation)};
}

}  // namespace crashrank

#pragma once

#include "crashrank/dispatch/dispatcher.hpp"
#include "crashrank/internal/collide/box_test.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {

/// What a unit of estimated work takes, about: for thresholds.
inline float seconds_per_work(Kernel kernel) noexcept {
  return kernel == Kernel::fast ? 0.16e-6F : 1.1e-6F;
}

/// Part of a box's length along each axis that an interval around `center` covers, multiplied.
inline float covered(const Box& box, const Eigen::Vector3f& center, const Eigen::Vector3f& half) {
  float share = 1.0F;
  for (int i = 0; i < 3; ++i) {
    const float length = box.max[i] - box.min[i];
    if (!(length > 0.0F)) continue;
    const float overlap =
        std::min(box.max[i], center[i] + half[i]) - std::max(box.min[i], center[i] - half[i]);
    share *= std::clamp(overlap / length, 0.0F, 1.0F);
  }
  return share;
}

/// What a job will cost: each part's triangles times the share of its box that the other's box
/// covers, and one for the job itself, to the power of 2/3, since surfaces meet along curves. Over
/// four decades a job takes between half and twice what the median job of its estimate does (see
/// `dispatch_bench estimates`). A guess; nothing but balance rests on it. Made once per query.
class WorkEstimate {
public:
  explicit WorkEstimate(const BoxTransform& to)
      : rotation_(to.rotation.cast<float>()),
        spread_(to.abs_rotation.cast<float>()),
        translation_(to.translation.cast<float>()) {}

  float operator()(const IndexedNode& a, const IndexedNode& b) const {
    const Eigen::Vector3f b_in_a = rotation_ * b.box.center() + translation_;
    const Eigen::Vector3f a_in_b = rotation_.transpose() * (a.box.center() - translation_);
    const float of_a = covered(a.box, b_in_a, spread_ * (0.5F * b.box.extent()));
    const float of_b = covered(b.box, a_in_b, spread_.transpose() * (0.5F * a.box.extent()));
    const float triangles =
        1.0F + of_a * static_cast<float>(a.slots.count) + of_b * static_cast<float>(b.slots.count);
    return std::cbrt(triangles * triangles);
  }

private:
  Eigen::Matrix3f rotation_;
  Eigen::Matrix3f spread_;
  Eigen::Vector3f translation_;
};

}  // namespace crashrank::detail

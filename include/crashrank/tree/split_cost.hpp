#pragma once

#include "crashrank/tree/build_records.hpp"

#include <Eigen/Core>

#include <cstdint>

namespace crashrank::detail {

/// Surface-area heuristic: triangles of a half times its surface.
struct SurfaceAreaCost {
  static float area(const LaneBox& box) {
    const Lanes e = box.max - box.min;
    return e[0] * e[1] + e[1] * e[2] + e[2] * e[0];
  }
  float cost(int /*axis*/, const Box& /*whole*/, const LaneBox& left, std::uint32_t left_count,
             const LaneBox& right, std::uint32_t right_count) const {
    return static_cast<float>(left_count) * area(left) +
           static_cast<float>(right_count) * area(right);
  }
};

/// The paper's sum of relative segments, each weighted by its half's share of the triangles.
struct RelativeSegmentCost {
  float cost(int axis, const Box& whole, const LaneBox& left, std::uint32_t left_count,
             const LaneBox& right, std::uint32_t right_count) const {
    const float length = whole.max[axis] - whole.min[axis];
    const float l = left.max[axis] - left.min[axis];
    const float r = right.max[axis] - right.min[axis];
    return (static_cast<float>(left_count) * l + static_cast<float>(right_count) * r) /
           (length * static_cast<float>(left_count + right_count));
  }
};

}  // namespace crashrank::detail

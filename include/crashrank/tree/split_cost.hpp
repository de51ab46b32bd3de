#pragma once

#include "crashrank/tree/lanes.hpp"

namespace crashrank::detail {

// A split rule gives every box within a node a size, which stands for the chance that a box of the
// other body meets it. A cut costs what its halves are expected to: triangles times size, summed.

/// Surface-area heuristic: the size of a half is its surface.
class SurfaceAreaRule {
public:
  explicit SurfaceAreaRule(const LaneBox& /*whole*/) {}

  float size(const LaneBox& half) const {
    const Lanes e = half.extent();
    return e[0] * e[1] + e[1] * e[2] + e[2] * e[0];
  }
};

/// The paper's sum of relative segments, carried from one axis to three and weighted. A half's
/// relative segment on an axis is the length of its projection over the length of the node's,
/// taken as the mean over the axes, so that axes weigh by their lengths. A cube of relative edge
/// 5/16 at a random place near the node meets the half's box with a chance proportional to the
/// product, over the axes, of relative segment + 5/16 (the volume of their Minkowski sum); each
/// half counts by its share of the triangles. On an axis the cut leaves alone, the halves' segments
/// shrink as well, which the sum over the split axis alone does not see.
class RelativeSegmentRule {
public:
  explicit RelativeSegmentRule(const LaneBox& whole) {
    const Lanes e = whole.extent();
    per_mean_ = 3.0F / (e[0] + e[1] + e[2]);
  }

  float size(const LaneBox& half) const {
    constexpr float probe = 0.3125F;
    const Lanes s = half.extent() * all_lanes(per_mean_) + all_lanes(probe);
    return s[0] * s[1] * s[2];
  }

private:
  float per_mean_;  ///< infinite for a point, which makes every cost NaN and no cut the best
};

}  // namespace crashrank::detail

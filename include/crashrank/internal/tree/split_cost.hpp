#pragma once

#include "crashrank/internal/tree/lanes.hpp"

namespace crashrank::detail {

// A split rule gives every box within a node a size, which stands for the chance that a box of the
// other body meets it. A cut costs what its halves are expected to: triangles times size, summed.
// The size is made of one term an axis, so that four boxes can be sized at once.

/// The size of one box.
template <class Rule> float size_of(const Rule& rule, const LaneBox& half) {
  const Lanes t = rule.terms(half);
  return Rule::size(t[0], t[1], t[2]);
}

/// Surface-area heuristic: the size of a half is its surface.
class SurfaceAreaRule {
public:
  explicit SurfaceAreaRule(const LaneBox& /*whole*/) {}

  Lanes terms(const LaneBox& half) const { return half.extent(); }
  template <class Number> static Number size(Number x, Number y, Number z) {
    return x * y + y * z + z * x;
  }
};

/// The paper's sum of relative segments, extended from one axis to three and weighted. A half's
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

  Lanes terms(const LaneBox& half) const {
    constexpr float probe = 0.3125F;
    return half.extent() * all_lanes(per_mean_) + all_lanes(probe);
  }
  template <class Number> static Number size(Number x, Number y, Number z) { return x * y * z; }

private:
  float per_mean_;  ///< infinite for a point, which makes every cost NaN and no cut the best
};

}  // namespace crashrank::detail

#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/tree/build_records.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace crashrank::detail {

/// A place to cut: records whose bin on the axis is at most `bin` go left.
struct BinnedCut {
  int axis = -1;  ///< -1: none found
  int bin = 0;
  std::uint32_t left_count = 0;
  Box left;
  Box right;
};

/// Cuts at the bin border of least `rule.cost`, tried on all three axes, first found among equals.
/// Records fall into equal bins by the middle of their boxes. Nothing is found where all middles
/// coincide or the box is too long for a float. O(n + bins).
template <class Rule> class BinnedSplitter {
public:
  static constexpr int max_bins = 32;

  BinnedCut find(View<const BuildRecord> records, const Box& box, const Rule& rule, int bins) {
    BinnedCut best;
    float best_cost = std::numeric_limits<float>::infinity();
    measure(records, bins);
    fill(records);
    for (int axis = 0; axis < 3; ++axis) {
      if (scale_[axis] > 0.0F) sweep(axis, records.size(), box, rule, bins, best, best_cost);
    }
    return best;
  }

  /// Moves the left records before the right ones, keeping the order on both sides.
  void partition(View<BuildRecord> records, const BinnedCut& cut,
                 std::vector<BuildRecord>& scratch) const {
    std::size_t left = 0;
    std::size_t right = 0;
    for (std::size_t i = 0; i < records.size(); ++i) {
      const BuildRecord record = records[i];
      const bool goes_left = bin_of(record, cut.axis) <= cut.bin;
      records[left] = record;
      scratch[right] = record;
      left += goes_left ? 1U : 0U;
      right += goes_left ? 0U : 1U;
    }
    std::copy_n(scratch.begin(), right, records.begin() + left);
  }

private:
  int bin_of(const BuildRecord& record, int axis) const {
    return std::min(static_cast<int>((middle(record, axis) - origin_[axis]) * scale_[axis]), last_);
  }

  void measure(View<const BuildRecord> records, int bins) {
    LaneBox middles;
    for (const BuildRecord& record : records) {
      const Lanes m = 0.5F * low(record) + 0.5F * high(record);
      middles.grow({m, m});
    }
    last_ = bins - 1;
    for (int axis = 0; axis < 3; ++axis) {
      const float length = middles.max[axis] - middles.min[axis];
      const float scale = static_cast<float>(bins) / length;
      const bool usable = length > 0.0F && std::isfinite(length) && std::isfinite(scale);
      origin_[axis] = middles.min[axis];
      scale_[axis] = usable ? scale : 0.0F;
    }
  }

  void fill(View<const BuildRecord> records) {
    for (int axis = 0; axis < 3; ++axis) {
      std::fill_n(counts_[axis], last_ + 1, 0U);
      std::fill_n(boxes_[axis], last_ + 1, LaneBox{});
    }
    for (const BuildRecord& record : records) {
      const LaneBox box{low(record), high(record)};
      for (int axis = 0; axis < 3; ++axis) {
        if (!(scale_[axis] > 0.0F)) continue;
        const auto bin = static_cast<std::size_t>(bin_of(record, axis));
        ++counts_[axis][bin];
        boxes_[axis][bin].grow(box);
      }
    }
  }

  void sweep(int axis, std::size_t count, const Box& box, const Rule& rule, int bins,
             BinnedCut& best, float& best_cost) const {
    const auto last = static_cast<std::size_t>(bins) - 1;
    LaneBox right[max_bins];
    right[last] = boxes_[axis][last];
    for (std::size_t b = last; b-- > 0;) {
      right[b] = boxes_[axis][b];
      right[b].grow(right[b + 1]);
    }
    LaneBox left;
    std::uint32_t left_count = 0;
    for (std::size_t b = 0; b < last; ++b) {
      left_count += counts_[axis][b];
      left.grow(boxes_[axis][b]);
      if (counts_[axis][b] == 0) continue;
      const auto right_count = static_cast<std::uint32_t>(count) - left_count;
      if (right_count == 0) break;
      const float cost = rule.cost(axis, box, left, left_count, right[b + 1], right_count);
      if (cost < best_cost) {
        best_cost = cost;
        best = {axis, static_cast<int>(b), left_count, left.box(), right[b + 1].box()};
      }
    }
  }

  LaneBox boxes_[3][max_bins];
  std::uint32_t counts_[3][max_bins];
  float origin_[3];
  float scale_[3];
  int last_;
};

}  // namespace crashrank::detail

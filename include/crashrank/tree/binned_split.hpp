#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/tree/build_records.hpp"
#include "crashrank/tree/lanes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace crashrank::detail {

/// A cut that was found: where, what it leaves on both sides, and triangles times size summed.
struct Cut {
  int axis = -1;  ///< -1: none found
  int bin = 0;
  std::uint32_t left_count = 0;
  float cost = std::numeric_limits<float>::infinity();
  LaneBox left{};
  LaneBox right{};
};

/// Counts stay below 2^31, where the conversion of a signed number is one instruction.
inline float to_float(std::uint32_t count) {
  return static_cast<float>(static_cast<std::int32_t>(count));
}

/// Cuts a set of records at the border of two of `bins` equal bins where the rule's cost is least,
/// tried on all three axes, the first of equals. Records fall into bins by the middle of their
/// boxes. No cut is found where all middles coincide, or where the box is too long or too short for
/// a float. O(n + bins).
template <class Rule> class BinnedSplitter {
public:
  static constexpr int bins = 16;

  Cut find(View<const BuildRecord> records, const Rule& rule) {
    Cut best;
    if (!place_bins(records)) return best;
    fill_bins(records);
    for (int axis = 0; axis < 3; ++axis) {
      if (scale_[axis] > 0.0F) sweep(axis, static_cast<std::uint32_t>(records.size()), rule, best);
    }
    return best;
  }

  /// Moves the left records before the right ones and keeps the order on both sides. Every record
  /// is written to both places and the index of the wrong one stays: no branch to be guessed.
  void partition(View<BuildRecord> records, const Cut& cut, View<BuildRecord> scratch) const {
    std::size_t left = 0;
    std::size_t right = 0;
    const float origin = origin_[cut.axis];
    const float scale = scale_[cut.axis];
    for (std::size_t i = 0; i < records.size(); ++i) {
      const BuildRecord& record = records[i];
      const RecordBits bits = load(record);
      const float place = ((record.min[cut.axis] + record.max[cut.axis]) - origin) * scale;
      const auto beyond = static_cast<std::uint32_t>(cut.bin - static_cast<int>(place));
      const std::size_t goes_right = beyond >> 31U;  // the sign
      store(bits, records[left]);
      store(bits, scratch[right]);
      left += 1 - goes_right;
      right += goes_right;
    }
    std::copy_n(scratch.begin(), right, records.begin() + left);
  }

private:
  /// Returns false where no axis can be divided.
  bool place_bins(View<const BuildRecord> records) {
    LaneBox middles = LaneBox::empty();
    for (const BuildRecord& record : records) {
      const Lanes m = middle(lanes(record));
      middles.grow({m, m});
    }
    bool divisible = false;
    for (int axis = 0; axis < 3; ++axis) {
      const float length = middles.max[axis] - middles.min[axis];
      // A little less than bins / length, so that the last middle rounds into the last bin.
      const float scale = static_cast<float>(bins) * 0.999999F / length;
      const bool usable = length > 0.0F && std::isfinite(length) && std::isfinite(scale);
      // An axis that cannot be divided sends finite middles to bin 0; an overflowed one would not.
      if (!std::isfinite(middles.min[axis]) || !std::isfinite(middles.max[axis])) return false;
      origin_[axis] = usable ? middles.min[axis] : 0.0F;
      scale_[axis] = usable ? scale : 0.0F;
      divisible = divisible || usable;
    }
    return divisible;
  }

  void fill_bins(View<const BuildRecord> records) {
    for (int axis = 0; axis < 3; ++axis) {
      std::fill_n(counts_[axis], bins, 0U);
      std::fill_n(boxes_[axis], bins, LaneBox::empty());
    }
    const Lanes origin = origin_;
    const Lanes scale = scale_;
    for (const BuildRecord& record : records) {
      const LaneBox box = lanes(record);
      const IntLanes bin = __builtin_convertvector((middle(box) - origin) * scale, IntLanes);
      for (int axis = 0; axis < 3; ++axis) {
        ++counts_[axis][bin[axis]];
        boxes_[axis][bin[axis]].grow(box);
      }
    }
  }

  void sweep(int axis, std::uint32_t count, const Rule& rule, Cut& best) const {
    const LaneBox* boxes = boxes_[axis];
    LaneBox right[bins];
    right[bins - 1] = boxes[bins - 1];
    for (int b = bins - 1; b-- > 0;) {
      right[b] = boxes[b];
      right[b].grow(right[b + 1]);
    }
    LaneBox left = LaneBox::empty();
    std::uint32_t left_count = 0;
    for (int b = 0; b + 1 < bins; ++b) {
      if (counts_[axis][b] == 0) continue;
      left_count += counts_[axis][b];
      if (left_count == count) break;
      left.grow(boxes[b]);
      const float cost = to_float(left_count) * rule.size(left) +
                         to_float(count - left_count) * rule.size(right[b + 1]);
      if (cost < best.cost) best = {axis, b, left_count, cost, left, right[b + 1]};
    }
  }

  LaneBox boxes_[3][bins];
  std::uint32_t counts_[3][bins];
  Lanes origin_ = all_lanes(0.0F);
  Lanes scale_ = all_lanes(0.0F);
};

}  // namespace crashrank::detail

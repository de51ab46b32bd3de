#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/internal/tree/build_records.hpp"
#include "crashrank/internal/tree/cut_search.hpp"
#include "crashrank/internal/tree/lanes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace crashrank::detail {

/// Cuts a set of records at the border of two of `bins` equal bins where the rule's cost is least,
/// tried on all three axes, the first of equals. Records fall into bins by the middle of their
/// boxes. No cut is found where all middles coincide, or where the box is too long or too short for
/// a float. O(n + bins).
template <class Rule> class BinnedSplitter {
public:
  static constexpr std::size_t bins = 16;

  Cut find(View<const BuildRecord> records, const Rule& rule) {
    Cut best;
    if (!place_bins(records)) return best;
    fill_bins(records);
    search_.begin();
    const auto count = static_cast<std::uint32_t>(records.size());
    for (int axis = 0; axis < 3; ++axis) {
      if (scale_[axis] > 0.0F) sweep(axis, count, rule);
    }
    const auto found = search_.cheapest();
    if (found.axis >= 0) best = cut_at(found);
    return best;
  }

  /// Copies the left records to the front of `to` and the right ones behind them, and keeps the
  /// order on both sides.
  void partition(View<const BuildRecord> records, const Cut& cut, View<BuildRecord> to) const {
    std::size_t left = 0;
    std::size_t right = cut.left_count;
    const float origin = origin_[cut.axis];
    const float scale = scale_[cut.axis];
    for (const BuildRecord& record : records) {
      const float place = ((record.min[cut.axis] + record.max[cut.axis]) - origin) * scale;
      const auto beyond = static_cast<std::uint32_t>(cut.bin - static_cast<int>(place));
      const std::size_t goes_right = beyond >> 31U;  // the sign
      // A mask and no branch, which could not be guessed.
      store(load(record), to[left ^ ((left ^ right) & (0 - goes_right))]);
      left += 1 - goes_right;
      right += goes_right;
    }
  }

private:
  struct Bins {
    LaneBox boxes[3][bins];
    std::uint32_t counts[3][bins];
  };

  static void clear(Bins& all) {
    for (int axis = 0; axis < 3; ++axis) {
      std::fill_n(all.counts[axis], bins, 0U);
      std::fill_n(all.boxes[axis], bins, LaneBox::empty());
    }
  }

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

  /// Neighbours in the mesh fall into the same bins, and then each waits for the one before it.
  /// Sets that are not small are therefore filled in from two places at once. Of boxes that begin
  /// at minus and at plus zero the last decides, as it would in one go.
  void fill_bins(View<const BuildRecord> records) {
    constexpr std::size_t worth_it = 64;
    const std::size_t half = records.size() < worth_it ? 0 : records.size() / 2;
    const Lanes origin = origin_;
    const Lanes scale = scale_;
    const auto put = [origin, scale](const BuildRecord& record, Bins& to) {
      const LaneBox box = lanes(record);
      const IntLanes bin = __builtin_convertvector((middle(box) - origin) * scale, IntLanes);
      for (int axis = 0; axis < 3; ++axis) {
        ++to.counts[axis][bin[axis]];
        to.boxes[axis][bin[axis]].grow(box);
      }
    };
    clear(bins_);
    if (half == 0) {
      for (const BuildRecord& record : records) put(record, bins_);
      return;
    }
    clear(second_);
    for (std::size_t i = 0; i < half; ++i) {
      put(records[i], bins_);
      put(records[half + i], second_);
    }
    if (records.size() != 2 * half) put(records[2 * half], second_);
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t b = 0; b < bins; ++b) {
        bins_.counts[axis][b] += second_.counts[axis][b];
        bins_.boxes[axis][b].grow(second_.boxes[axis][b]);
      }
    }
  }

  /// Has every border between two bins considered. An empty bin makes a place that costs what the
  /// one before it costs, and of equals the first stays.
  void sweep(int axis, std::uint32_t count, const Rule& rule) {
    const LaneBox* boxes = bins_.boxes[axis];
    LaneBox right = boxes[bins - 1];
    for (std::size_t b = bins - 1; b-- > 0;) {
      search_.right[b] = rule.terms(right);
      right = joined(boxes[b], right);
    }
    LaneBox left = LaneBox::empty();
    std::uint32_t left_count = 0;
    for (std::size_t b = 0; b + 1 < bins; ++b) {
      left_count += bins_.counts[axis][b];
      left.grow(boxes[b]);
      search_.left[b] = rule.terms(left);
      search_.left_count[b] = static_cast<std::int32_t>(left_count);
    }
    search_.consider(axis, bins - 1, count);
  }

  Cut cut_at(const typename CutSearch<Rule>::Found& found) const {
    const LaneBox* boxes = bins_.boxes[found.axis];
    Cut cut;
    cut.axis = found.axis;
    cut.bin = static_cast<int>(found.place);
    cut.cost = found.cost;
    cut.right = boxes[bins - 1];
    for (std::size_t b = bins - 1; b-- > found.place + 1;) cut.right = joined(boxes[b], cut.right);
    cut.left = LaneBox::empty();
    for (std::size_t b = 0; b <= found.place; ++b) {
      cut.left_count += bins_.counts[found.axis][b];
      cut.left.grow(boxes[b]);
    }
    return cut;
  }

  Bins bins_;
  Bins second_;
  Lanes origin_ = all_lanes(0.0F);
  Lanes scale_ = all_lanes(0.0F);
  CutSearch<Rule> search_;
};

}  // namespace crashrank::detail

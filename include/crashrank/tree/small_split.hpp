#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/tree/binned_split.hpp"
#include "crashrank/tree/build_records.hpp"
#include "crashrank/tree/lanes.hpp"

#include <cstddef>
#include <cstdint>

namespace crashrank::detail {

/// Cuts a handful of records where the rule's cost is least over every place between two of them in
/// the order of their middles, on all three axes, the first of equals. Bins cost more than that
/// where there are no more records than bins. O(n²) compares and O(n) sizes.
template <class Rule> class SmallSplitter {
public:
  static constexpr std::size_t max_records = 16;

  Cut find(View<const BuildRecord> records, const Rule& rule) {
    const std::size_t n = records.size();
    for (std::size_t i = 0; i < n; ++i) {
      boxes_[i] = lanes(records[i]);
      const Lanes m = middle(boxes_[i]);
      for (int axis = 0; axis < 3; ++axis) keys_[axis][i] = m[axis];
    }
    Cut best;
    for (int axis = 0; axis < 3; ++axis) {
      sort(axis, n);
      sweep(axis, n, rule, best);
    }
    return best;
  }

  /// Puts the records into the order in which the cut was found.
  void partition(View<BuildRecord> records, const Cut& cut) const {
    BuildRecord sorted[max_records];
    for (std::size_t i = 0; i < records.size(); ++i) sorted[i] = records[order_[cut.axis][i]];
    for (std::size_t i = 0; i < records.size(); ++i) records[i] = sorted[i];
  }

private:
  /// Every record's place is the number of records before it: no branch to be guessed.
  void sort(int axis, std::size_t n) {
    const float* keys = keys_[axis];
    std::uint32_t place[max_records] = {};
    for (std::size_t i = 1; i < n; ++i) {
      std::uint32_t before = 0;
      for (std::size_t j = 0; j < i; ++j) {
        const std::uint32_t in_order = keys[j] <= keys[i] ? 1U : 0U;
        before += in_order;
        place[j] += 1U - in_order;
      }
      place[i] = before;
    }
    for (std::size_t i = 0; i < n; ++i) order_[axis][place[i]] = static_cast<std::uint8_t>(i);
  }

  void sweep(int axis, std::size_t n, const Rule& rule, Cut& best) const {
    const std::uint8_t* order = order_[axis];
    LaneBox right[max_records];
    right[n - 1] = boxes_[order[n - 1]];
    for (std::size_t i = n - 1; i-- > 1;) {
      right[i] = boxes_[order[i]];
      right[i].grow(right[i + 1]);
    }
    LaneBox left;
    for (std::size_t i = 1; i < n; ++i) {
      left.grow(boxes_[order[i - 1]]);
      const float cost =
          static_cast<float>(i) * rule.size(left) + static_cast<float>(n - i) * rule.size(right[i]);
      if (cost < best.cost) {
        best = {axis, 0, static_cast<std::uint32_t>(i), cost, left, right[i]};
      }
    }
  }

  LaneBox boxes_[max_records];
  float keys_[3][max_records];
  std::uint8_t order_[3][max_records];
};

}  // namespace crashrank::detail

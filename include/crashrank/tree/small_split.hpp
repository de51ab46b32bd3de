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
    for (std::size_t i = 0; i < n; ++i) boxes_[i] = lanes(records[i]);
    Cut best;
    if (n == 2) {  // a frequent set with one cut only
      const float cost = rule.size(boxes_[0]) + rule.size(boxes_[1]);
      order_[0][0] = 0;
      order_[0][1] = 1;
      if (cost < best.cost) best = {0, 0, 1, cost, boxes_[0], boxes_[1]};
      return best;
    }
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < n; ++i) {
        keys_[axis][i] = boxes_[i].min[axis] + boxes_[i].max[axis];
      }
      sort(axis, n);
      sweep(axis, n, rule, best);
    }
    return best;
  }

  /// Puts the records into the order in which the cut was found.
  void partition(View<BuildRecord> records, const Cut& cut) const {
    RecordBits sorted[max_records];
    for (std::size_t i = 0; i < records.size(); ++i) {
      sorted[i] = load(records[order_[cut.axis][i]]);
    }
    for (std::size_t i = 0; i < records.size(); ++i) store(sorted[i], records[i]);
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
    LaneBox left = boxes_[order[0]];
    for (std::size_t i = 1; i < n; ++i) {
      const auto left_count = static_cast<std::uint32_t>(i);
      const float cost = to_float(left_count) * rule.size(left) +
                         to_float(static_cast<std::uint32_t>(n) - left_count) * rule.size(right[i]);
      if (cost < best.cost) best = {axis, 0, left_count, cost, left, right[i]};
      left.grow(boxes_[order[i]]);
    }
  }

  LaneBox boxes_[max_records];
  float keys_[3][max_records];
  std::uint8_t order_[3][max_records];
};

}  // namespace crashrank::detail

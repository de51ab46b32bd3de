#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/internal/tree/build_records.hpp"
#include "crashrank/internal/tree/cut_search.hpp"
#include "crashrank/internal/tree/lanes.hpp"
#include "crashrank/internal/tree/split_cost.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

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
      const float cost = size_of(rule, boxes_[0]) + size_of(rule, boxes_[1]);
      order_[0][0] = 0;
      order_[0][1] = 1;
      if (cost < best.cost) best = {0, 0, 1, cost, boxes_[0], boxes_[1]};
      return best;
    }
    sort(n);
    search_.begin();
    for (int axis = 0; axis < 3; ++axis) sweep(axis, n, rule);
    const auto found = search_.cheapest();
    if (found.axis >= 0) best = cut_at(found, n);
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
  /// Orders by axis.
  void sort(std::size_t n) {
    const std::size_t fours = (n + 3) / 4;
    for (std::size_t four = 0; four < fours; ++four) {
      Lanes middles[4];
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t i = 4 * four + k;
        middles[k] = i < n ? boxes_[i].min + boxes_[i].max
                           : all_lanes(std::numeric_limits<float>::infinity());
      }
      const AxisLanes keys = by_axis(middles);
      keys_[0][four] = keys.x;
      keys_[1][four] = keys.y;
      keys_[2][four] = keys.z;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      switch (fours) {
        case 1:
          rank<1>(axis);
          break;
        case 2:
          rank<2>(axis);
          break;
        case 3:
          rank<3>(axis);
          break;
        default:
          rank<4>(axis);
      }
      for (std::size_t i = 0; i < n; ++i) {
        order_[axis][places_[i]] = static_cast<std::uint8_t>(i);
      }
    }
  }

  /// Every record's place is the number of records before it, equal ones in the order they have:
  /// no branch to be guessed. What fills up the last four is behind all records.
  template <std::size_t fours> void rank(std::size_t axis) {
    float keys[4 * fours];
    std::memcpy(keys, keys_[axis], sizeof keys);
    for (std::size_t four = 0; four < fours; ++four) {
      const Lanes own = keys_[axis][four];
      IntLanes place{0, 0, 0, 0};
      std::size_t i = 0;
      for (; i < 4 * four; ++i) place -= all_lanes(keys[i]) <= own;
      for (int k = 0; k < 4; ++k, ++i) {
        const Lanes key = all_lanes(keys[i]);
        const IntLanes later = IntLanes{0, 1, 2, 3} > IntLanes{k, k, k, k};
        place -= (key < own) | ((key == own) & later);
      }
      for (; i < 4 * fours; ++i) place -= all_lanes(keys[i]) < own;
      std::memcpy(places_ + 4 * four, &place, sizeof place);
    }
  }

  void sweep(int axis, std::size_t n, const Rule& rule) {
    const std::uint8_t* order = order_[axis];
    LaneBox right = boxes_[order[n - 1]];
    for (std::size_t i = n - 1; i-- > 0;) {
      search_.right[i] = rule.terms(right);
      right = joined(boxes_[order[i]], right);
    }
    LaneBox left = boxes_[order[0]];
    for (std::size_t i = 0; i + 1 < n; ++i) {
      search_.left[i] = rule.terms(left);
      search_.left_count[i] = static_cast<std::int32_t>(i + 1);
      left.grow(boxes_[order[i + 1]]);
    }
    search_.consider(axis, n - 1, static_cast<std::uint32_t>(n));
  }

  Cut cut_at(const typename CutSearch<Rule>::Found& found, std::size_t n) const {
    const std::uint8_t* order = order_[found.axis];
    LaneBox right = boxes_[order[n - 1]];
    for (std::size_t i = n - 1; i-- > found.place + 1;) right = joined(boxes_[order[i]], right);
    LaneBox left = boxes_[order[0]];
    for (std::size_t i = 1; i <= found.place; ++i) left.grow(boxes_[order[i]]);
    return {found.axis, 0, static_cast<std::uint32_t>(found.place + 1), found.cost, left, right};
  }

  LaneBox boxes_[max_records];
  Lanes keys_[3][max_records / 4];
  std::int32_t places_[max_records];
  std::uint8_t order_[3][max_records];
  CutSearch<Rule> search_;
};

}  // namespace crashrank::detail

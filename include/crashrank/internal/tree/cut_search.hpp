#pragma once

#include "crashrank/internal/tree/lanes.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
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

/// The cheapest of many places to cut, four at a time and without a branch to be guessed: which
/// place is the cheapest so far can hardly be foreseen. The caller writes what is on both sides of
/// every place of an axis, then has them considered.
template <class Rule> class CutSearch {
public:
  /// Places on one axis are below this.
  static constexpr std::size_t places = 16;

  Lanes left[places];               ///< the rule's terms of what is left of a place
  Lanes right[places];              ///< and of what is right of it
  std::int32_t left_count[places];  ///< records on the left

  void begin() {
    least_ = all_lanes(std::numeric_limits<float>::infinity());
    at_ = IntLanes{-1, -1, -1, -1};
  }

  /// Considers the first `count` places of an axis for a set of `records`.
  void consider(int axis, std::size_t count, std::uint32_t records) {
    for (std::size_t i = count; i % 4 != 0; ++i) {
      left[i] = all_lanes(0.0F);
      right[i] = all_lanes(0.0F);
      left_count[i] = 0;
    }
    const auto all = static_cast<std::int32_t>(records);
    const auto end = static_cast<std::int32_t>(count);
    for (std::size_t i = 0; i < count; i += 4) {
      const AxisLanes l = by_axis(left + i);
      const AxisLanes r = by_axis(right + i);
      IntLanes on_left;
      std::memcpy(&on_left, left_count + i, sizeof on_left);
      const IntLanes on_right = IntLanes{all, all, all, all} - on_left;
      const Lanes cost = __builtin_convertvector(on_left, Lanes) * Rule::size(l.x, l.y, l.z) +
                         __builtin_convertvector(on_right, Lanes) * Rule::size(r.x, r.y, r.z);
      const auto first = static_cast<std::int32_t>(i);
      const IntLanes place = IntLanes{0, 1, 2, 3} + IntLanes{first, first, first, first};
      const IntLanes better = (cost < least_) & (place < IntLanes{end, end, end, end});
      const std::int32_t base = axis * static_cast<std::int32_t>(places);
      least_ = better ? cost : least_;
      at_ = better ? place + IntLanes{base, base, base, base} : at_;
    }
  }

  /// The cheapest, the first of equals, axes in their order; none where no cost is a number. Boxes
  /// are left to the caller.
  struct Found {
    float cost;
    int axis;  ///< -1: none
    std::size_t place;
  };
  Found cheapest() const {
    float cost = least_[0];
    std::int32_t at = at_[0];
    for (int i = 1; i < 4; ++i) {
      const bool better = least_[i] < cost || (least_[i] == cost && at_[i] < at);
      cost = better ? least_[i] : cost;
      at = better ? at_[i] : at;
    }
    if (!(cost < std::numeric_limits<float>::infinity())) return {cost, -1, 0};
    constexpr auto each = static_cast<std::int32_t>(places);
    return {cost, at / each, static_cast<std::size_t>(at % each)};
  }

private:
  Lanes least_;
  IntLanes at_;
};

}  // namespace crashrank::detail

#pragma once

#include "crashrank/base/box.hpp"

#include <limits>

namespace crashrank::detail {

/// Four floats worked on at once, three of them axes. The compilers' own vectors: one instruction
/// where the processor has it, the same values where it has not. The fourth lane is never looked
/// at, but multiplied only after `three` has made it zero: what lies beside a box in memory may be
/// a denormal number, which processors multiply slowly.
using Lanes __attribute__((vector_size(16))) = float;
using IntLanes __attribute__((vector_size(16))) = int;

inline Lanes all_lanes(float value) { return Lanes{value, value, value, value}; }
inline Lanes lesser(Lanes a, Lanes b) { return a < b ? a : b; }
inline Lanes greater(Lanes a, Lanes b) { return a > b ? a : b; }
inline Lanes three(Lanes value) {
  value[3] = 0.0F;
  return value;
}

/// Box in lanes. Left uninitialised unless said otherwise: builders keep arrays of them.
struct LaneBox {
  Lanes min;
  Lanes max;

  /// Growing it by a box gives that box.
  static LaneBox empty() {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    return {all_lanes(infinity), all_lanes(-infinity)};
  }
  Lanes extent() const { return three(max - min); }
  void grow(const LaneBox& other) {
    min = lesser(min, other.min);
    max = greater(max, other.max);
  }
};

inline LaneBox to_lanes(const Box& box) {
  return {Lanes{box.min[0], box.min[1], box.min[2], 0.0F},
          Lanes{box.max[0], box.max[1], box.max[2], 0.0F}};
}

inline Box to_box(const LaneBox& box) {
  return {{box.min[0], box.min[1], box.min[2]}, {box.max[0], box.max[1], box.max[2]}};
}

}  // namespace crashrank::detail

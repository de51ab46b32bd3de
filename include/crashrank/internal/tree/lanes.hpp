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
  return reinterpret_cast<Lanes>(reinterpret_cast<IntLanes>(value) & IntLanes{-1, -1, -1, 0});
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

/// Two elements of each of two vectors, by their numbers: 0 to 3 in the first, 4 to 7 in the
/// second.
template <int i, int j, int k, int l> Lanes pick_lanes(Lanes a, Lanes b) {
#ifdef __clang__
  return __builtin_shufflevector(a, b, i, j, k, l);
#else
  return __builtin_shuffle(a, b, IntLanes{i, j, k, l});
#endif
}

/// Four vectors by their elements: all first ones, all second ones.
struct AxisLanes {
  Lanes x;
  Lanes y;
  Lanes z;
  Lanes w;
};

inline AxisLanes by_axis(const Lanes* four) {
  const Lanes low_a = pick_lanes<0, 4, 1, 5>(four[0], four[1]);
  const Lanes low_b = pick_lanes<0, 4, 1, 5>(four[2], four[3]);
  const Lanes high_a = pick_lanes<2, 6, 3, 7>(four[0], four[1]);
  const Lanes high_b = pick_lanes<2, 6, 3, 7>(four[2], four[3]);
  return {pick_lanes<0, 1, 4, 5>(low_a, low_b), pick_lanes<2, 3, 6, 7>(low_a, low_b),
          pick_lanes<0, 1, 4, 5>(high_a, high_b), pick_lanes<2, 3, 6, 7>(high_a, high_b)};
}

/// The box around both.
inline LaneBox joined(LaneBox a, const LaneBox& b) {
  a.grow(b);
  return a;
}

inline LaneBox to_lanes(const Box& box) {
  return {Lanes{box.min[0], box.min[1], box.min[2], 0.0F},
          Lanes{box.max[0], box.max[1], box.max[2], 0.0F}};
}

inline Box to_box(const LaneBox& box) {
  return {{box.min[0], box.min[1], box.min[2]}, {box.max[0], box.max[1], box.max[2]}};
}

}  // namespace crashrank::detail

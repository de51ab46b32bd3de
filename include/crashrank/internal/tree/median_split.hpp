#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/internal/tree/build_records.hpp"

#include <algorithm>
#include <cstddef>

namespace crashrank::detail {

/// Puts the half of lower middles on the axis first; ties go by triangle index, so the halves are
/// the same whatever order the records came in. Returns the size of the first half. O(n) on
/// average.
inline std::size_t median_split(View<BuildRecord> records, int axis) {
  const std::size_t half = records.size() / 2;
  std::nth_element(records.begin(), records.begin() + half, records.end(),
                   [axis](const BuildRecord& a, const BuildRecord& b) {
                     const float ma = a.min[axis] + a.max[axis];
                     const float mb = b.min[axis] + b.max[axis];
                     return ma != mb ? ma < mb : a.index < b.index;
                   });
  return half;
}

/// The axis along which a box is longest, the first of equals.
inline int longest_axis(const Box& box) {
  int longest = 0;
  for (int k = 1; k < 3; ++k) {
    if (box.extent()[k] > box.extent()[longest]) longest = k;
  }
  return longest;
}

}  // namespace crashrank::detail

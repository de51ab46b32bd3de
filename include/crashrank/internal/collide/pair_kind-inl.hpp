#pragma once

#include "crashrank/collide/collide.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank {

inline PairKind pair_kind(const TriangleD& a, const TriangleD& b) {
  std::uint64_t exact_calls = 0;
  std::array<int, 3> b_side{};
  std::array<int, 3> a_side{};
  for (std::size_t i = 0; i < 3; ++i) {
    b_side[i] = orient3d(a.corner[0], a.corner[1], a.corner[2], b.corner[i], exact_calls);
    a_side[i] = orient3d(b.corner[0], b.corner[1], b.corner[2], a.corner[i], exact_calls);
  }
  const std::array<int, 3> zero{};
  if (a_side == zero && b_side == zero) return PairKind::coplanar;
  // A flat triangle has every point in its plane, as it were, and lies in the other's only if its
  // own corners do; if they do not, it touches or pierces without a segment in common.
  const auto goes_through = [](const std::array<int, 3>& side) {
    return *std::min_element(side.begin(), side.end()) < 0 &&
           *std::max_element(side.begin(), side.end()) > 0;
  };
  if (!goes_through(a_side) || !goes_through(b_side)) return PairKind::touching;
  // As in triangles_intersect: the planes' common line is cut in an interval by each triangle. They
  // share more than a point when neither begins where the other ends.
  bool a_positive = false;
  bool b_positive = false;
  const std::size_t ia = detail::alone(a_side, a_positive);
  const std::size_t ib = detail::alone(b_side, b_positive);
  const std::size_t turn_a = b_positive ? 1 : 2;
  const std::size_t turn_b = a_positive ? 1 : 2;
  const Eigen::Vector3d& a0 = a.corner[ia];
  const Eigen::Vector3d& a1 = a.corner[(ia + turn_a) % 3];
  const Eigen::Vector3d& a2 = a.corner[(ia + 3 - turn_a) % 3];
  const Eigen::Vector3d& b0 = b.corner[ib];
  const Eigen::Vector3d& b1 = b.corner[(ib + turn_b) % 3];
  const Eigen::Vector3d& b2 = b.corner[(ib + 3 - turn_b) % 3];
  return orient3d(a0, a1, b0, b1, exact_calls) < 0 && orient3d(a0, a2, b0, b2, exact_calls) > 0
             ? PairKind::crossing
             : PairKind::touching;
}

inline std::vector<PairKind> pair_kinds(const TriangleMesh& a, const TriangleMesh& b,
                                        const Pose& b_in_a, View<const Pair> pairs) {
  std::vector<PairKind> kinds;
  kinds.reserve(pairs.size());
  for (const Pair& pair : pairs) {
    kinds.push_back(pair_kind(to_double(a.triangle(static_cast<std::size_t>(pair.a))),
                              carry(b_in_a, b.triangle(static_cast<std::size_t>(pair.b)))));
  }
  return kinds;
}

}  // namespace crashrank

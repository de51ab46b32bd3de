#pragma once

#include "crashrank/collide/pair.hpp"
#include "crashrank/dispatch/dispatcher.hpp"
#include "crashrank/internal/collide/box_test.hpp"
#include "crashrank/internal/collide/traverse.hpp"

#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// Descends two trees from their roots and calls `found(node_a, node_b)`, indices in the part
/// indices, for every pair of parts whose boxes, and all boxes above them, may touch; `found`
/// returns false to stop. The larger box is split first, as in `traverse`. Left before right, so
/// jobs that follow each other tend to share parts. A node of no more than `whole` triangles is a
/// part wherever it stands, and a pair of nodes for which `enough(node, node)` is not cut further.
/// `stack` keeps its memory between calls.
template <class Enough, class Found>
bool find_jobs(const PartIndex& a, const PartIndex& b, const BoxTransform& to, std::uint32_t depth,
               std::uint32_t whole, std::vector<NodePair>& stack, CollideWork& work,
               Enough&& enough, Found&& found) {
  const View<const IndexedNode> nodes_a = a.nodes();
  const View<const IndexedNode> nodes_b = b.nodes();
  stack.clear();
  stack.push_back({0, 0});
  while (!stack.empty()) {
    const NodePair pair = stack.back();
    stack.pop_back();
    const IndexedNode& na = nodes_a[pair.a];
    const IndexedNode& nb = nodes_b[pair.b];
    ++work.bv_tests;
    if (!boxes_may_touch(na.box, nb.box, to)) continue;
    const bool part_a = a.is_part(na, depth) || na.slots.count <= whole;
    const bool part_b = b.is_part(nb, depth) || nb.slots.count <= whole;
    if ((part_a && part_b) || enough(na, nb)) {
      if (!found(pair.a, pair.b)) return false;
    } else if (part_b || (!part_a && na.half_area_m2 >= nb.half_area_m2)) {
      stack.push_back({na.left + 1, pair.b});
      stack.push_back({na.left, pair.b});
    } else {
      stack.push_back({pair.a, nb.left + 1});
      stack.push_back({pair.a, nb.left});
    }
  }
  return true;
}

}  // namespace crashrank::detail

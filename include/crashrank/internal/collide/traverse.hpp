#pragma once

#include "crashrank/collide/pair.hpp"
#include "crashrank/internal/collide/box_test.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <cassert>
#include <cstddef>
#include <cstdint>

namespace crashrank {

/// A node of A's tree with a node of B's.
struct NodePair {
  std::uint32_t a = 0;  ///< node of A
  std::uint32_t b = 0;  ///< node of B
};

/// Stack entries that `traverse` needs below two nodes of trees of these depths. Every step takes
/// one pair off and puts at most two on, and each pair on the stack is deeper by one level of one
/// tree than the one before it was when put there: one waiting pair per level of either tree, and
/// the current pair.
inline std::size_t traversal_stack_size(std::uint32_t depth_a, std::uint32_t depth_b) {
  return std::size_t{depth_a} + depth_b + 2;
}

/// Visits all pairs of leaves below (start.a, start.b) whose boxes, and all boxes above them, may
/// touch. `visit(leaf_a, leaf_b)` returns false to stop. Descends into the larger box. `stack` has
/// room for `traversal_stack_size` entries and its content on entry does not matter.
/// Returns false when stopped. Adds the boxes tested to `work`. `Tree` is AabbTree or TreeView.
template <class Tree, class Visit>
bool traverse(const Tree& a, const Tree& b, const BoxTransform& to, NodePair start,
              View<NodePair> stack, CollideWork& work, Visit&& visit) {
  const auto touch = [&](NodePair pair) {
    ++work.bv_tests;
    return boxes_may_touch(a.nodes[pair.a].box, b.nodes[pair.b].box, to);
  };
  if (!touch(start)) return true;
  std::size_t waiting = 0;
  NodePair pair = start;
  for (;;) {
    const Node& na = a.nodes[pair.a];
    const Node& nb = b.nodes[pair.b];
    if (na.is_leaf() && nb.is_leaf()) {
      if (!visit(na, nb)) return false;
    } else {
      const bool split_a =
          nb.is_leaf() || (!na.is_leaf() && half_area(na.box) >= half_area(nb.box));
      const NodePair left = split_a ? NodePair{na.first, pair.b} : NodePair{pair.a, nb.first};
      const NodePair right =
          split_a ? NodePair{na.first + 1, pair.b} : NodePair{pair.a, nb.first + 1};
      const bool go_left = touch(left);
      const bool go_right = touch(right);
      if (go_right && go_left) {
        assert(waiting < stack.size());
        stack[waiting++] = right;
      }
      if (go_left || go_right) {
        pair = go_left ? left : right;
        continue;
      }
    }
    if (waiting == 0) return true;
    pair = stack[--waiting];
  }
}

}  // namespace crashrank

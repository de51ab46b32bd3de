#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/collide/pair.hpp"
#include "crashrank/internal/collide/box_test.hpp"
#include "crashrank/internal/collide/traverse.hpp"
#include "crashrank/internal/collide/triangle_test.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank {

/// Tests all triangle pairs of two leaves; calls `found(Pair)`, which returns false to stop.
/// Returns false when stopped. `Tree` is AabbTree or TreeView.
template <class Tree, class Found>
bool collide_leaves(const Tree& a, const Node& leaf_a, const Tree& b, const Node& leaf_b,
                    const Pose& b_in_a, CollideWork& work, Found&& found) {
  for (std::uint32_t j = leaf_b.first; j < leaf_b.first + leaf_b.count; ++j) {
    const TriangleD tb = carry(b_in_a, b.triangles[j]);
    for (std::uint32_t i = leaf_a.first; i < leaf_a.first + leaf_a.count; ++i) {
      ++work.primitive_tests;
      if (triangles_intersect(to_double(a.triangles[i]), tb, work.exact_tests) &&
          !found(
              Pair{static_cast<std::int32_t>(a.order[i]), static_cast<std::int32_t>(b.order[j])})) {
        return false;
      }
    }
  }
  return true;
}

/// What a query writes to besides its answer, kept between queries so that a warm query allocates
/// nothing. One per thread.
struct CollideWorkspace {
  std::vector<NodePair> stack;  ///< node pairs still to be tested

  /// Makes room for queries between trees of up to these depths.
  void prepare(std::uint32_t depth_a, std::uint32_t depth_b) {
    const std::size_t needed = traversal_stack_size(depth_a, depth_b);
    if (stack.size() < needed) stack.resize(needed);
  }
};

/// Pairs below one node of each tree, appended to `pairs`; work added to `work`. The workspace has
/// to be prepared. As `collide` otherwise.
inline void collide_below(const AabbTree& a, std::uint32_t a_node, const AabbTree& b,
                          std::uint32_t b_node, const Pose& b_in_a, const BoxTransform& to,
                          std::vector<Pair>& pairs, CollideWorkspace& workspace,
                          const CollideOptions& options, CollideWork& work) {
  traverse(a, b, to, {a_node, b_node}, workspace.stack, work,
           [&](const Node& leaf_a, const Node& leaf_b) {
             return collide_leaves(a, leaf_a, b, leaf_b, b_in_a, work, [&](Pair pair) {
               pairs.push_back(pair);
               return !options.any;
             });
           });
}

/// All pairs of triangles of A and B that share a point, or with `options.any` the first one met,
/// in no particular order. B stands at `b_in_a` in A's frame and its vertices are where `carry`
/// puts them; on those coordinates the answer is exact: no pair is missed or invented.
/// A body wholly inside the other touches nothing and gives no pair.
///
/// `pairs` is cleared and filled; it allocates only to grow beyond its capacity. The scalar engine:
/// header-only, on the calling thread. Both trees non-empty; the pose finite and rigid within
/// `max_rigidity_error`. Safe from any thread with its own workspace and buffer.
/// Source: Wiseman & Grinberg 2016, section 2 (recursive check of two trees from the roots).
inline CollideResult collide(const AabbTree& a, const AabbTree& b, const Pose& b_in_a,
                             std::vector<Pair>& pairs, CollideWorkspace& workspace,
                             const CollideOptions& options = {}) {
  workspace.prepare(a.depth, b.depth);
  pairs.clear();
  CollideResult result;
  collide_below(a, 0, b, 0, b_in_a, box_transform(a, b, b_in_a), pairs, workspace, options,
                result.work);
  result.pairs = pairs.size();
  result.intersecting = !pairs.empty();
  return result;
}

/// The same with a workspace of its own, which it allocates.
inline CollideResult collide(const AabbTree& a, const AabbTree& b, const Pose& b_in_a,
                             std::vector<Pair>& pairs, const CollideOptions& options = {}) {
  CollideWorkspace workspace;
  return collide(a, b, b_in_a, pairs, workspace, options);
}

}  // namespace crashrank

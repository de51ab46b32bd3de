#pragma once

#include "crashrank/tree/aabb_tree.hpp"

#include <cstddef>
#include <cstdint>

namespace crashrank {

/// What a tree is worth, without a query. For inspection and for comparing builds.
struct TreeQuality {
  std::uint32_t depth = 0;          ///< edges on the longest way from the root to a leaf
  std::size_t nodes = 0;            ///< inner nodes and leaves
  std::size_t leaves = 0;           ///< nodes that hold triangles
  double triangles_per_leaf = 0.0;  ///< mean
  /// Surface-area cost with both kinds of test at 1: the sum over inner nodes of their surface, and
  /// over leaves of surface times triangles, over the root's surface. 0 for a root without surface.
  double surface_cost = 0.0;
  std::size_t bytes = 0;  ///< nodes, order and corners
};

/// Measures a valid tree in one pass over its nodes. O(nodes), allocates nothing.
inline TreeQuality assess(const AabbTree& tree) {
  TreeQuality quality;
  quality.depth = tree.depth;
  quality.nodes = tree.nodes.size();
  quality.bytes = tree.bytes();
  double cost = 0.0;
  for (const Node& node : tree.nodes) {
    const double surface = half_area(node.box);
    cost += node.is_leaf() ? surface * static_cast<double>(node.count) : surface;
    quality.leaves += node.is_leaf() ? 1U : 0U;
  }
  if (quality.leaves == 0) return quality;
  quality.triangles_per_leaf =
      static_cast<double>(tree.order.size()) / static_cast<double>(quality.leaves);
  const double root = half_area(tree.nodes[0].box);
  if (root > 0.0) quality.surface_cost = cost / root;
  return quality;
}

}  // namespace crashrank

#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <cstdint>

namespace crashrank {

/// The arrays of a tree, or of a copied part of one, as traversal reads them. Owns nothing.
struct TreeView {
  View<const Node> nodes;           ///< the tree's
  View<const std::uint32_t> order;  ///< the tree's
  View<const Triangle> triangles;   ///< the tree's
};

/// A look at a whole tree, which has to outlive it.
inline TreeView view_of(const AabbTree& tree) { return {tree.nodes, tree.order, tree.triangles}; }

}  // namespace crashrank

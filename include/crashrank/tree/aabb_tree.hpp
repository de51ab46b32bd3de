#pragma once

#include "crashrank/base/box.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank {

/// How a set of triangles is split in two.
enum class SplitRule {
  min_relative_segment,  ///< each half's relative segment weighted by its share of the triangles
  paper,                 ///< Wiseman & Grinberg 2016, section 3, to the letter; one triangle a leaf
  sah,                   ///< surface-area heuristic, for comparison
  median,                ///< median of the longest axis, for comparison
};

/// Along which axes the boxes stand.
enum class BoxFrame {
  world,     ///< the body's own x, y, z
  gaussian,  ///< eigenvectors of the covariance of the vertices ("Fitting points with Gaussian
             ///< distribution", section 2), largest eigenvalue first
};

/// One box of the tree, 32 bytes. Siblings lie side by side, the left at an odd index; all
/// descendants of a node form one contiguous range that begins at its left child.
struct Node {
  Box box;                  ///< in the tree's frame, encloses every triangle below
  std::uint32_t first = 0;  ///< inner node: index of its left child; leaf: first slot
  std::uint32_t count = 0;  ///< leaf: number of triangles, at least 1; inner node: 0

  /// True for a node that holds triangles itself.
  bool is_leaf() const noexcept { return count != 0; }
};

/// A binary tree of axis-aligned boxes over the triangles of one mesh. A value without pointers to
/// other objects: may be copied and moved; reading from many threads is safe.
struct AabbTree {
  /// Columns are the box axes in body coordinates, orthonormal: u = axesᵀ·x.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  bool axes_are_world = true;  ///< axes is exactly the identity
  Column<Node> nodes;          ///< nodes[0] is the root
  /// Slot to triangle index of the mesh. A subtree's triangles are a contiguous run of slots.
  Column<std::uint32_t> order;
  Column<Triangle> triangles;  ///< corners by slot, body coordinates
  std::uint32_t depth = 0;     ///< see `measure_depth`; bounds every traversal's stack

  /// True without any node.
  bool empty() const noexcept { return nodes.empty(); }
  /// Memory of its columns without spare capacity, bytes.
  std::size_t bytes() const noexcept {
    return nodes.size() * sizeof(Node) + order.size() * sizeof(std::uint32_t) +
           triangles.size() * sizeof(Triangle);
  }
};

/// Edges on the longest way from the root to a leaf: 0 for a lone leaf. O(nodes), with one pass
/// because a child's index is above its parent's.
inline std::uint32_t measure_depth(View<const Node> nodes) {
  std::vector<std::uint32_t> depth(nodes.size(), 0);
  std::uint32_t deepest = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    deepest = depth[i] > deepest ? depth[i] : deepest;
    if (nodes[i].is_leaf()) continue;
    depth[nodes[i].first] = depth[i] + 1;
    depth[nodes[i].first + 1] = depth[i] + 1;
  }
  return deepest;
}

/// A run of consecutive elements.
struct Range {
  std::uint32_t first = 0;  ///< the first of them
  std::uint32_t count = 0;  ///< how many
};

/// Slots of all triangles below a node. O(depth).
inline Range slots_below(const AabbTree& tree, std::uint32_t node) {
  std::uint32_t left = node;
  while (!tree.nodes[left].is_leaf()) left = tree.nodes[left].first;
  std::uint32_t right = node;
  while (!tree.nodes[right].is_leaf()) right = tree.nodes[right].first + 1;
  const Node& last = tree.nodes[right];
  return {tree.nodes[left].first, last.first + last.count - tree.nodes[left].first};
}

/// All nodes below a node, itself excluded: one contiguous range, a node's two children first, then
/// what lies below the left one, then what lies below the right one. O(depth).
inline Range descendants(const AabbTree& tree, std::uint32_t node) {
  if (tree.nodes[node].is_leaf()) return {node + 1, 0};
  const std::uint32_t first = tree.nodes[node].first;
  std::uint32_t left = first;
  while (true) {
    const bool right_inner = !tree.nodes[left + 1].is_leaf();
    const bool left_inner = !tree.nodes[left].is_leaf();
    if (!right_inner && !left_inner) return {first, left + 2 - first};
    left = tree.nodes[right_inner ? left + 1 : left].first;
  }
}

/// How a tree is built.
struct BuildOptions {
  SplitRule rule = SplitRule::min_relative_segment;  ///< where sets are split
  BoxFrame frame = BoxFrame::world;                  ///< axes of the boxes
  std::uint32_t leaf_size = 4;  ///< most triangles a leaf may hold, 1 to 255; `paper` means 1
  /// Split no set that fits into a leaf. Otherwise min_relative_segment and sah make smaller leaves
  /// where that is expected to save tests: fewer triangle pairs tested for more nodes.
  bool fill_leaves = false;
  /// After the build, whatever its rule, subtrees are moved to where the boxes above them come out
  /// smaller; at most this many passes over the tree, fewer when nothing moves any more. Worth its
  /// time (see bench/tree_bench) for a model that is built once and queried often.
  std::uint32_t reinsertion_passes = 0;
  /// Threads that min_relative_segment and sah build on, and that a model's wide tree is written
  /// on, 1 to 256, the calling one among them. The trees are the same, bit for bit.
  std::uint32_t threads = 1;
};

}  // namespace crashrank

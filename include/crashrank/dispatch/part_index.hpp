#pragma once

#include "crashrank/base/box.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/internal/tree/tree_view.hpp"
#include "crashrank/tree/aabb_tree.hpp"
#include "crashrank/tree/model.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank {

/// Deepest level at which trees are cut into parts.
inline constexpr std::uint32_t max_distribution_depth = 16;

/// A node of the tree's top and what lies below it: a part, when it stands at the distribution
/// depth or is a leaf above it.
struct IndexedNode {
  Box box;                    ///< m
  float half_area_m2 = 0.0F;  ///< of the box, m²
  std::uint32_t left = 0;     ///< index here of the left child, the right one follows; 0: none here
  std::uint32_t parent = 0;   ///< index here; the root's is 0
  std::uint32_t depth = 0;    ///< below the root
  std::uint32_t tree_node = 0;  ///< index in the tree
  Range below;                  ///< its descendants in the tree
  Range slots;                  ///< its triangles

  /// Bytes that a core needs to work on it: nodes, triangles, and their numbers.
  std::size_t bytes() const noexcept {
    return (std::size_t{below.count} + 1) * sizeof(Node) +
           std::size_t{slots.count} * (sizeof(Triangle) + sizeof(std::uint32_t));
  }
};

/// The top of a tree, as the main thread sees it when it looks for jobs, level by level: nodes at
/// or above any depth D are a prefix. Made once per model; it looks at the tree it was made from,
/// which has to stay where it is. Reading from many threads is safe. The two sides of a query are
/// two models, also when they look alike: make one index each.
class CRASHRANK_API PartIndex {
public:
  /// O(nodes down to `deepest` + leaves of the cut · depth). Errors: bad_input for an empty tree,
  /// usage for a depth above `max_distribution_depth`.
  static Result<PartIndex> make(const AabbTree& tree,
                                std::uint32_t deepest = max_distribution_depth);
  /// The same for the vector engine, whose smallest pieces are clusters of up to eight triangles:
  /// nodes are not cut below those. The model has to stay where it is.
  static Result<PartIndex> make(const Model& model, std::uint32_t deepest = max_distribution_depth);

  /// Level by level, the root first.
  View<const IndexedNode> nodes() const noexcept { return nodes_; }
  /// The tree it is about.
  const AabbTree& tree() const noexcept { return *tree_; }
  /// The model it was made from, null where it was made from a tree.
  const Model* model() const noexcept { return model_; }
  /// The depth that it reaches down to.
  std::uint32_t deepest() const noexcept { return deepest_; }
  /// Number of nodes at depths 0 to `depth`.
  std::uint32_t nodes_down_to(std::uint32_t depth) const noexcept;
  /// Whether this node is handed out whole when trees are cut at `depth`.
  bool is_part(const IndexedNode& node, std::uint32_t depth) const noexcept {
    return node.left == 0 || node.depth >= depth;
  }
  /// Axes and root box alone: what box_transform reads.
  const AabbTree& frame() const noexcept { return frame_; }
  /// Levels of the tree below its root.
  std::uint32_t tree_depth() const noexcept { return tree_depth_; }
  /// Bytes of the whole model: nodes, triangles, and their numbers.
  std::size_t model_bytes() const noexcept { return model_bytes_; }

private:
  PartIndex() = default;

  static Result<PartIndex> make(const AabbTree& tree, const Model* model, std::uint32_t deepest);

  const AabbTree* tree_ = nullptr;
  const Model* model_ = nullptr;
  std::uint32_t deepest_ = 0;
  std::uint32_t tree_depth_ = 0;
  std::size_t model_bytes_ = 0;
  std::vector<IndexedNode> nodes_;
  std::vector<std::uint32_t> level_end_;  ///< by depth
  AabbTree frame_;
};

}  // namespace crashrank

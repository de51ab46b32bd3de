#include "crashrank/dispatch/dispatcher.hpp"

#include <algorithm>

namespace crashrank {

namespace {

IndexedNode indexed(const AabbTree& tree, std::uint32_t tree_node) {
  IndexedNode node;
  node.box = tree.nodes[tree_node].box;
  node.half_area_m2 = half_area(node.box);
  node.tree_node = tree_node;
  return node;
}

}  // namespace

Result<PartIndex> PartIndex::make(const AabbTree& tree, std::uint32_t deepest) {
  return make(tree, nullptr, deepest);
}

Result<PartIndex> PartIndex::make(const Model& model, std::uint32_t deepest) {
  return make(model.tree, &model, deepest);
}

Result<PartIndex> PartIndex::make(const AabbTree& tree, const Model* model, std::uint32_t deepest) {
  if (tree.empty()) return make_error(ErrorCode::bad_input, "the tree has no nodes");
  if (deepest > max_distribution_depth) {
    return make_error(ErrorCode::usage, "parts lie at depth 16 at most");
  }
  PartIndex index;
  index.tree_ = &tree;
  index.model_ = model;
  index.tree_depth_ = tree.depth;
  index.model_bytes_ = tree.bytes();
  index.frame_.axes = tree.axes;
  index.frame_.axes_are_world = tree.axes_are_world;
  index.frame_.nodes = {tree.nodes[0]};

  const bool wide = model != nullptr && !model->wide.empty();
  const auto uncut = [&](const Node& node) {
    return node.is_leaf() || (wide && model->wide.lanes_of[node.first].lanes == 0);
  };
  std::vector<IndexedNode>& nodes = index.nodes_;
  nodes.push_back(indexed(tree, 0));
  index.level_end_.push_back(1);
  for (std::uint32_t i = 0, depth = 0; depth < deepest; ++depth) {
    for (; i < index.level_end_[depth]; ++i) {
      const Node& node = tree.nodes[nodes[i].tree_node];
      if (uncut(node)) continue;
      nodes[i].left = static_cast<std::uint32_t>(nodes.size());
      for (const std::uint32_t child : {node.first, node.first + 1}) {
        nodes.push_back(indexed(tree, child));
        nodes.back().parent = i;
        nodes.back().depth = depth + 1;
      }
    }
    index.level_end_.push_back(static_cast<std::uint32_t>(nodes.size()));
    if (index.level_end_[depth + 1] == index.level_end_[depth]) break;
  }
  index.deepest_ = static_cast<std::uint32_t>(index.level_end_.size()) - 1;

  for (std::size_t i = nodes.size(); i-- > 0;) {  // children before parents
    IndexedNode& node = nodes[i];
    if (node.left == 0) {
      node.below = descendants(tree, node.tree_node);
      node.slots = slots_below(tree, node.tree_node);
    } else {
      const IndexedNode& left = nodes[node.left];
      const IndexedNode& right = nodes[node.left + 1];
      node.below = {left.tree_node, 2 + left.below.count + right.below.count};
      node.slots = {left.slots.first, left.slots.count + right.slots.count};
    }
  }
  return index;
}

std::uint32_t PartIndex::nodes_down_to(std::uint32_t depth) const noexcept {
  return level_end_[std::min(depth, deepest_)];
}

}  // namespace crashrank

#pragma once

#include "crashrank/tree/aabb_tree.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// A node whose triangles are known and whose split is not decided yet.
struct OpenNode {
  std::uint32_t node;
  std::uint32_t first;  ///< first record
  std::uint32_t count;
  std::uint32_t depth;
  std::uint32_t buffer;  ///< where its records are, for builders that keep them in two places
};

/// Writes nodes in the order of the layout: children in pairs, a node's left side before its right.
/// The open nodes wait in a vector, so a tree of any depth costs heap and never stack.
class TreeWriter {
public:
  explicit TreeWriter(std::vector<Node>& nodes) : nodes_(nodes) {}

  void open_root(const Box& box, std::uint32_t first, std::uint32_t count, std::uint32_t depth,
                 std::uint32_t buffer = 0) {
    nodes_.push_back({box, 0, 0});
    open_.push_back({static_cast<std::uint32_t>(nodes_.size() - 1), first, count, depth, buffer});
  }
  bool next(OpenNode& out) {
    if (open_.empty()) return false;
    out = open_.back();
    open_.pop_back();
    return true;
  }
  void leaf(const OpenNode& of) {
    nodes_[of.node].first = of.first;
    nodes_[of.node].count = of.count;
    deepest_ = of.depth > deepest_ ? of.depth : deepest_;
  }
  void split(const OpenNode& of, std::uint32_t left_count, const Box& left, const Box& right,
             std::uint32_t buffer = 0) {
    const auto child = static_cast<std::uint32_t>(nodes_.size());
    nodes_[of.node].first = child;
    nodes_.push_back({left, 0, 0});
    nodes_.push_back({right, 0, 0});
    open_.push_back(
        {child + 1, of.first + left_count, of.count - left_count, of.depth + 1, buffer});
    open_.push_back({child, of.first, left_count, of.depth + 1, buffer});
  }
  /// Decides one open node and all that opens below it before anything else that is open.
  /// `decide(writer, open)` calls leaf() or split() once.
  template <class Decide> void descend(const OpenNode& from, const Decide& decide) {
    const std::size_t others = open_.size();
    open_.push_back(from);
    while (open_.size() > others) {
      const OpenNode open = open_.back();
      open_.pop_back();
      decide(*this, open);
    }
  }
  const Box& box(const OpenNode& of) const { return nodes_[of.node].box; }
  /// Depth of the deepest leaf so far.
  std::uint32_t deepest() const { return deepest_; }

private:
  std::vector<Node>& nodes_;
  std::vector<OpenNode> open_;
  std::uint32_t deepest_ = 0;
};

}  // namespace crashrank::detail

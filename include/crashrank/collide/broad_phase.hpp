#pragma once

#include "crashrank/base/box.hpp"
#include "crashrank/base/view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank {

/// Finds which of many boxes overlap without testing every pair: a balanced binary tree over the
/// boxes, split at the median of the longest axis. Bodies on a road form a line or fill a plane;
/// sorting along a single axis would leave n^1.5 pairs of such a grid to test.
///
/// Boxes are closed: touching ones overlap. An empty box overlaps nothing; none may hold a NaN.
/// A value; reading from many threads is safe.
class BroadPhase {
public:
  /// Room for a number of boxes, none of them empty.
  void reserve(std::size_t boxes) {
    boxes_.reserve(boxes);
    order_.reserve(boxes);
    nodes_.reserve(2 * boxes);
  }

  /// Copies the boxes and builds the tree. O(n log n); allocates only to grow beyond earlier sizes.
  void build(View<const Box> boxes) {
    boxes_.assign(boxes.begin(), boxes.end());
    order_.clear();
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (!boxes[i].empty()) order_.push_back(static_cast<std::uint32_t>(i));
    }
    nodes_.clear();
    if (order_.empty()) return;
    nodes_.push_back({});
    split_below_root();
  }

  /// Number of boxes.
  std::size_t size() const noexcept { return boxes_.size(); }

  /// Calls `found(index)` once for every box that overlaps this one, in an order that only depends
  /// on the boxes. O(log n + hits) where boxes are spread out. Returns the number of boxes tested.
  template <class Found> std::uint64_t query(const Box& box, Found&& found) const {
    if (nodes_.empty()) return 0;
    std::uint64_t tests = 0;
    std::array<std::uint32_t, max_depth> stack{};
    std::size_t filled = 1;
    while (filled != 0) {
      const Node& node = nodes_[stack[--filled]];
      ++tests;
      if (!node.box.overlaps(box)) continue;
      if (node.count == 0) {
        stack[filled++] = node.first + 1;
        stack[filled++] = node.first;
        continue;
      }
      for (std::uint32_t slot = node.first; slot < node.first + node.count; ++slot) {
        ++tests;
        if (boxes_[order_[slot]].overlaps(box)) found(static_cast<std::size_t>(order_[slot]));
      }
    }
    return tests;
  }

  /// Calls `found(i, j)` once for every two boxes i < j that overlap, by rising i.
  /// O(n log n + pairs) where boxes are spread out. Returns the number of boxes tested.
  template <class Found> std::uint64_t pairs(Found&& found) const {
    std::uint64_t tests = 0;
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      if (boxes_[i].empty()) continue;
      tests += query(boxes_[i], [&](std::size_t j) {
        if (i < j) found(i, j);
      });
    }
    return tests;
  }

private:
  struct Node {
    Box box;
    std::uint32_t first = 0;  // inner: left child, its sibling follows; leaf: first slot of order_
    std::uint32_t count = 0;  // leaf: number of slots; inner: 0
  };

  static constexpr std::uint32_t leaf_size = 4;
  // Halving 2^32 boxes takes 32 levels, and a traversal keeps one sibling a level.
  static constexpr std::size_t max_depth = 64;

  // Halves every node that is too large, in the order they are made; no recursion.
  void split_below_root() {
    nodes_[0].count = static_cast<std::uint32_t>(order_.size());
    for (std::size_t at = 0; at < nodes_.size(); ++at) {
      const std::uint32_t first = nodes_[at].first;
      const std::uint32_t count = nodes_[at].count;
      Box bounds;
      Box centers;
      for (std::uint32_t slot = first; slot < first + count; ++slot) {
        bounds.grow(boxes_[order_[slot]]);
        centers.grow(center(order_[slot]));
      }
      nodes_[at].box = bounds;
      if (count <= leaf_size) continue;
      int axis = 0;
      centers.extent().maxCoeff(&axis);
      const std::uint32_t half = count / 2;
      const auto begin = order_.begin() + first;
      std::nth_element(begin, begin + half, begin + count,
                       [this, axis](std::uint32_t i, std::uint32_t j) {
                         const float p = center(i)[axis];
                         const float q = center(j)[axis];
                         return p != q ? p < q : i < j;
                       });
      const auto left = static_cast<std::uint32_t>(nodes_.size());
      nodes_.push_back({{}, first, half});
      nodes_.push_back({{}, first + half, count - half});
      nodes_[at].first = left;
      nodes_[at].count = 0;
    }
  }

  // A box without bounds has no centre to sort by; anywhere is right for it.
  Eigen::Vector3f center(std::uint32_t index) const {
    const Eigen::Vector3f middle = boxes_[index].center();
    return middle.allFinite() ? middle : Eigen::Vector3f::Zero();
  }

  std::vector<Box> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace crashrank

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// Set of triangle indices with constant-time clearing and sorted output. Nodes of the tree of the
/// triangles can be marked as full: all triangles below are members.
class TriangleSet {
public:
  /// Clears the set for triangle indices below `size` and node indices below `nodes`.
  void clear(std::size_t size, std::size_t nodes) {
    if (stamps_.size() < size) stamps_.resize(size, 0);
    if (full_.size() < nodes) full_.resize(nodes, 0);
    members_.clear();
    if (++stamp_ == 0) {
      stamps_.assign(stamps_.size(), 0);
      full_.assign(full_.size(), 0);
      stamp_ = 1;
    }
  }
  bool contains(std::uint32_t triangle) const { return stamps_[triangle] == stamp_; }
  void add(std::uint32_t triangle) {
    if (contains(triangle)) return;
    stamps_[triangle] = stamp_;
    members_.push_back(triangle);
  }
  /// Marks a node as full.
  void note_full(std::uint32_t node) { full_[node] = stamp_; }
  /// Returns true if the node is marked as full.
  bool is_full(std::uint32_t node) const { return full_[node] == stamp_; }
  /// The members in ascending order.
  const std::vector<std::uint32_t>& sorted() {
    std::sort(members_.begin(), members_.end());
    return members_;
  }

private:
  std::vector<std::uint32_t> stamps_;
  std::vector<std::uint32_t> full_;
  std::vector<std::uint32_t> members_;
  std::uint32_t stamp_ = 0;
};

}  // namespace crashrank::detail

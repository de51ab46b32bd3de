#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// A set of triangle indices that is emptied at no cost and lists its members in order. Nodes of
/// the triangles' tree below which all are members can be noted.
class TriangleSet {
public:
  /// Empties it for indices below `size`, of triangles and of nodes below `nodes`.
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
  /// All triangles below a node are members.
  void note_full(std::uint32_t node) { full_[node] = stamp_; }
  /// Whether that was noted.
  bool is_full(std::uint32_t node) const { return full_[node] == stamp_; }
  /// Rising.
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

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// A set of triangle indices that is emptied at no cost and lists its members in order.
class TriangleSet {
public:
  /// Empties it for indices below `size`.
  void clear(std::size_t size) {
    if (stamps_.size() < size) stamps_.resize(size, 0);
    members_.clear();
    if (++stamp_ == 0) {
      stamps_.assign(stamps_.size(), 0);
      stamp_ = 1;
    }
  }
  bool contains(std::uint32_t triangle) const { return stamps_[triangle] == stamp_; }
  void add(std::uint32_t triangle) {
    if (contains(triangle)) return;
    stamps_[triangle] = stamp_;
    members_.push_back(triangle);
  }
  /// Rising.
  const std::vector<std::uint32_t>& sorted() {
    std::sort(members_.begin(), members_.end());
    return members_;
  }

private:
  std::vector<std::uint32_t> stamps_;
  std::vector<std::uint32_t> members_;
  std::uint32_t stamp_ = 0;
};

}  // namespace crashrank::detail

#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

namespace crashrank::importer {

/// Vertices by position, each kept once, in the order of first use. −0 counts as 0. A hash table
/// with open addressing, at most two thirds full; the vertices themselves are its keys.
class VertexPool {
public:
  std::uint32_t index_of(Eigen::Vector3f position) {
    position += Eigen::Vector3f::Zero();  // −0 + 0 = 0, everything else stays
    if (3 * (vertices_.size() + 1) > 2 * slots_.size()) grow();
    std::size_t slot = hash(position) & (slots_.size() - 1);
    while (slots_[slot] != empty) {
      if (vertices_[slots_[slot]] == position) return slots_[slot];
      slot = (slot + 1) & (slots_.size() - 1);
    }
    slots_[slot] = static_cast<std::uint32_t>(vertices_.size());
    vertices_.push_back(position);
    return slots_[slot];
  }

  const std::vector<Eigen::Vector3f>& vertices() const { return vertices_; }
  std::vector<Eigen::Vector3f> take() { return std::move(vertices_); }

private:
  static constexpr std::uint32_t empty = std::numeric_limits<std::uint32_t>::max();

  // Multiplication spreads low bits upwards only, and coordinates of real meshes often end in
  // zeros: so the high half is folded down after every step.
  static std::size_t hash(const Eigen::Vector3f& position) {
    std::uint64_t state = 0x9e3779b97f4a7c15U;
    for (int axis = 0; axis < 3; ++axis) {
      std::uint32_t bits = 0;
      std::memcpy(&bits, &position[axis], sizeof bits);
      state = (state ^ bits) * 0xbf58476d1ce4e5b9U;
      state ^= state >> 32;
    }
    return static_cast<std::size_t>(state);
  }

  void grow() {
    slots_.assign(slots_.empty() ? 1024 : 2 * slots_.size(), empty);
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      std::size_t slot = hash(vertices_[i]) & (slots_.size() - 1);
      while (slots_[slot] != empty) slot = (slot + 1) & (slots_.size() - 1);
      slots_[slot] = static_cast<std::uint32_t>(i);
    }
  }

  std::vector<Eigen::Vector3f> vertices_;
  std::vector<std::uint32_t> slots_;
};

}  // namespace crashrank::importer

#pragma once

#include "crashrank/internal/tree/tree_view.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace crashrank::detail {

/// A part to copy: which nodes and triangles of which tree.
struct Fetch {
  TreeView from;
  std::uint32_t tree_node = 0;
  Range below;
  Range slots;

  std::size_t bytes() const noexcept {
    return (std::size_t{below.count} + 1) * sizeof(Node) +
           std::size_t{slots.count} * (sizeof(Triangle) + sizeof(std::uint32_t));
  }
};

/// Index of a tree's node within the copy of the part that holds it.
inline std::uint32_t copied_node(std::uint32_t part_root, const Range& below, std::uint32_t node) {
  return node == part_root ? 0 : node - below.first + 1;
}

/// A core's own memory with copies of parts: small trees whose root is node 0. Only the core that
/// owns it touches it. Memory is taken in blocks and kept when the store is emptied.
class PartStore {
public:
  /// Copies a part; its number is how many there were before. Throws std::bad_alloc.
  void copy(const Fetch& part);
  View<const TreeView> parts() const noexcept { return parts_; }
  /// Forgets all parts, keeps the memory.
  void clear() noexcept;
  /// Forgets all parts and gives the memory back.
  void release() noexcept;

private:
  struct Block {
    std::unique_ptr<std::byte[]> memory;
    std::size_t bytes = 0;
  };

  std::byte* take(std::size_t bytes);

  std::vector<TreeView> parts_;
  std::vector<Block> blocks_;
  std::size_t block_ = 0;  ///< block being filled
  std::size_t used_ = 0;   ///< bytes of it taken
};

}  // namespace crashrank::detail

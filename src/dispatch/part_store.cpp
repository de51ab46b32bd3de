#include "dispatch/part_store.hpp"

#include <algorithm>
#include <memory>

namespace crashrank::detail {

namespace {

constexpr std::size_t block_bytes = std::size_t{1} << 18U;
constexpr std::size_t alignment = 16;

static_assert(alignof(Node) <= alignment && alignof(Triangle) <= alignment);
static_assert(sizeof(Node) % 4 == 0 && sizeof(Triangle) % 4 == 0);

}  // namespace

std::byte* PartStore::take(std::size_t bytes) {
  bytes = (bytes + alignment - 1) / alignment * alignment;
  while (block_ < blocks_.size() && blocks_[block_].bytes - used_ < bytes) {
    ++block_;
    used_ = 0;
  }
  if (block_ == blocks_.size()) {
    const std::size_t size = std::max(block_bytes, bytes);
    blocks_.push_back({std::unique_ptr<std::byte[]>(new std::byte[size]), size});
  }
  std::byte* const memory = blocks_[block_].memory.get() + used_;
  used_ += bytes;
  return memory;
}

void PartStore::copy(const Fetch& part) {
  const std::size_t node_count = std::size_t{part.below.count} + 1;
  std::byte* const memory = take(part.bytes());
  Node* const nodes = reinterpret_cast<Node*>(memory);
  Triangle* const triangles = reinterpret_cast<Triangle*>(nodes + node_count);
  std::uint32_t* const order = reinterpret_cast<std::uint32_t*>(triangles + part.slots.count);

  std::uninitialized_copy_n(part.from.nodes.data() + part.tree_node, 1, nodes);
  std::uninitialized_copy_n(part.from.nodes.data() + part.below.first, part.below.count, nodes + 1);
  for (std::size_t i = 0; i < node_count; ++i) {
    Node& node = nodes[i];
    node.first = node.is_leaf() ? node.first - part.slots.first : node.first - part.below.first + 1;
  }
  std::uninitialized_copy_n(part.from.triangles.data() + part.slots.first, part.slots.count,
                            triangles);
  std::uninitialized_copy_n(part.from.order.data() + part.slots.first, part.slots.count, order);
  parts_.push_back({{nodes, node_count}, {order, part.slots.count}, {triangles, part.slots.count}});
}

void PartStore::clear() noexcept {
  parts_.clear();
  block_ = 0;
  used_ = 0;
}

void PartStore::release() noexcept {
  clear();
  blocks_.clear();
}

}  // namespace crashrank::detail

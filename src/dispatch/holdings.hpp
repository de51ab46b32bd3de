#pragma once

#include "crashrank/dispatch/dispatcher.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace crashrank::detail {

/// What the main thread knows of the cores' stores: which parts of which bodies each holds or will
/// have been sent with its batch, under which number, and how many bytes that is. A part inside a
/// held larger part counts as held.
class Holdings {
public:
  /// Where a core finds a part: number in its store, and the index node that was sent whole.
  struct Place {
    std::uint32_t number = 0;
    std::uint32_t sent_node = 0;
  };

  /// Starts with cores that hold nothing.
  void begin(std::uint32_t cores) {
    cores_ = cores;
    clear();
  }

  /// Forgets what cores hold, in time proportional to that; keeps the memory of the tables.
  void clear() {
    for (std::uint32_t number = 0; number < used_; ++number) {
      Body& body = bodies_[number];
      for (const std::uint32_t node : body.held) body.holders[node] = 0;
      body.held.clear();
      body.known = 0;
    }
    used_ = 0;
    core_.assign(cores_, {});
  }

  /// Number of a body; makes room for its parts down to `depth`.
  std::uint32_t body(const PartIndex& index, std::uint32_t depth) {
    std::uint32_t number = 0;
    while (number < used_ && bodies_[number].index != &index) ++number;
    if (number == used_) {
      if (used_ == bodies_.size()) bodies_.emplace_back();
      bodies_[used_].index = &index;
      ++used_;
    }
    extend(bodies_[number], index.nodes_down_to(depth));
    return number;
  }

  std::uint32_t bodies() const noexcept { return used_; }
  const PartIndex& index(std::uint32_t body) const noexcept { return *bodies_[body].index; }

  /// One bit per core that holds the node.
  std::uint64_t holders(std::uint32_t body, std::uint32_t node) const noexcept {
    return bodies_[body].holders[node];
  }
  /// The same word, which stays in place until another body is added or made deeper.
  const std::uint64_t* holders_of(std::uint32_t body, std::uint32_t node) const noexcept {
    return &bodies_[body].holders[node];
  }
  bool holds(std::uint32_t core, std::uint32_t body, std::uint32_t node) const noexcept {
    return ((holders(body, node) >> core) & 1U) != 0;
  }
  Place place(std::uint32_t core, std::uint32_t body, std::uint32_t node) const noexcept {
    return bodies_[body].places[std::size_t{node} * cores_ + core];
  }
  std::uint64_t bytes(std::uint32_t core) const noexcept { return core_[core].bytes; }

  /// Notes that a core will have been sent a part that it does not hold.
  void add(std::uint32_t core, std::uint32_t body, std::uint32_t node) {
    Body& of = bodies_[body];
    const Place place{core_[core].parts++, node};
    core_[core].bytes += of.index->nodes()[node].bytes();
    const std::uint64_t bit = std::uint64_t{1} << core;
    open_.assign(1, node);
    while (!open_.empty()) {
      const std::uint32_t at = open_.back();
      open_.pop_back();
      if (at >= of.known) continue;
      if (of.holders[at] == 0) of.held.push_back(at);
      of.holders[at] |= bit;
      of.places[std::size_t{at} * cores_ + core] = place;
      const std::uint32_t left = of.index->nodes()[at].left;
      if (left != 0) {
        open_.push_back(left);
        open_.push_back(left + 1);
      }
    }
  }

private:
  struct Body {
    const PartIndex* index = nullptr;
    std::uint32_t known = 0;             ///< nodes there is room for; the first of the index
    std::vector<std::uint64_t> holders;  ///< by node; 0 where no core holds it
    std::vector<std::uint32_t> held;     ///< nodes that are held
    std::vector<Place> places;           ///< by node, then core; valid where the bit is set
  };
  struct Core {
    std::uint32_t parts = 0;
    std::uint64_t bytes = 0;
  };

  /// What lies in a held part is held: a child inherits from its parent, which comes first.
  void extend(Body& body, std::uint32_t nodes) const {
    if (nodes <= body.known) return;
    if (body.holders.size() < nodes) body.holders.resize(nodes, 0);
    if (body.places.size() < std::size_t{nodes} * cores_) {
      body.places.resize(std::size_t{nodes} * cores_);
    }
    const std::uint32_t known = std::exchange(body.known, nodes);
    if (body.held.empty()) return;
    for (std::uint32_t node = std::max(known, 1U); node < nodes; ++node) {
      const std::uint32_t parent = body.index->nodes()[node].parent;
      if (body.holders[parent] == 0) continue;
      body.held.push_back(node);
      body.holders[node] = body.holders[parent];
      for (std::uint32_t core = 0; core < cores_; ++core) {
        body.places[std::size_t{node} * cores_ + core] =
            body.places[std::size_t{parent} * cores_ + core];
      }
    }
  }

  std::uint32_t cores_ = 0;
  std::uint32_t used_ = 0;
  std::vector<Body> bodies_;  ///< the first `used_` are in use
  std::vector<Core> core_;
  std::vector<std::uint32_t> open_;
};

}  // namespace crashrank::detail

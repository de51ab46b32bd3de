#pragma once

#include "crashrank/internal/tree/lanes.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace crashrank::detail {

/// Moves subtrees to places where the inner boxes above them come out smaller, measured by the sum
/// of their surfaces (the idea of Bittner, Hapala and Havran 2013, "Fast insertion-based
/// optimization of bounding volume hierarchies", with the search that begins at the removed node of
/// Meister and Bittner 2018). Leaves stay as they are. Boxes that come out are unions of the boxes
/// below them, so they enclose what those enclose.
class Reinsertion {
public:
  explicit Reinsertion(const std::vector<Node>& nodes) : nodes_(nodes.size()) {
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
      nodes_[i].box = to_lanes(nodes[i].box);
      nodes_[i].leaf = nodes[i];
      if (nodes[i].is_leaf()) continue;
      nodes_[i].child[0] = nodes[i].first;
      nodes_[i].child[1] = nodes[i].first + 1;
      nodes_[nodes[i].first].parent = i;
      nodes_[nodes[i].first + 1].parent = i;
    }
  }

  /// Tries every node but the root and its children once, largest box first; moves each whose best
  /// place saves something. Returns the number of moves.
  std::size_t pass() {
    std::vector<std::pair<float, std::uint32_t>> candidates;
    for (std::uint32_t i = 1; i < nodes_.size(); ++i) {
      if (nodes_[i].parent != 0) candidates.emplace_back(surface(nodes_[i].box), i);
    }
    std::sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
      return a.first != b.first ? a.first > b.first : a.second < b.second;
    });
    std::size_t moves = 0;
    for (const auto& [size, node] : candidates) {
      // Earlier moves may have brought it under the root, from where nothing can be saved.
      if (nodes_[node].parent == 0) continue;
      const std::uint32_t place = best_place(node);
      if (place == none) continue;
      move(node, place);
      ++moves;
    }
    return moves;
  }

  /// Writes the tree back in the order of the layout; `order` is permuted along.
  void write(std::vector<Node>& nodes, std::vector<std::uint32_t>& order) const {
    const std::vector<std::uint32_t> old_order = order;
    nodes.assign(1, Node{});
    std::uint32_t slot = 0;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> open{{0U, 0U}};  // from here, to there
    while (!open.empty()) {
      const auto [from, to] = open.back();
      open.pop_back();
      const Work& work = nodes_[from];
      nodes[to].box = to_box(work.box);
      if (work.leaf.is_leaf()) {
        nodes[to].first = slot;
        nodes[to].count = work.leaf.count;
        for (std::uint32_t k = 0; k < work.leaf.count; ++k) {
          order[slot++] = old_order[work.leaf.first + k];
        }
        continue;
      }
      const auto first = static_cast<std::uint32_t>(nodes.size());
      nodes[to].first = first;
      nodes.resize(nodes.size() + 2);
      open.emplace_back(work.child[1], first + 1);
      open.emplace_back(work.child[0], first);
    }
  }

private:
  static constexpr std::uint32_t none = 0xffffffff;

  struct Work {
    LaneBox box;
    std::uint32_t parent = none;
    std::uint32_t child[2] = {none, none};
    Node leaf;  ///< slots of a leaf; an inner node's count is 0
  };

  static float surface(const LaneBox& box) {
    const Lanes e = box.extent();
    return e[0] * e[1] + e[1] * e[2] + e[2] * e[0];
  }

  static LaneBox merged(LaneBox a, const LaneBox& b) {
    a.grow(b);
    return a;
  }

  std::uint32_t sibling(std::uint32_t node) const {
    const Work& parent = nodes_[nodes_[node].parent];
    return parent.child[parent.child[0] == node ? 1 : 0];
  }

  /// The node beside which the given one is best put, or `none` where it stands best. Goes up from
  /// the node; at each ancestor the surface saved so far by taking the node out is known, and the
  /// subtree beside is searched for a place that costs less. A subtree is left alone where even a
  /// place that costs nothing but the node's own surface would save less than the best one found.
  std::uint32_t best_place(std::uint32_t node) {
    const LaneBox box = nodes_[node].box;
    const float own = surface(box);
    const std::uint32_t parent = nodes_[node].parent;
    float best_saving = 0.0F;
    std::uint32_t best = none;

    std::uint32_t pivot = parent;          // the ancestor looked at
    std::uint32_t beside = sibling(node);  // root of the subtree to be searched
    LaneBox without = nodes_[beside].box;  // box of the pivot once the node is out
    float saved = surface(nodes_[parent].box);
    while (true) {
      search_.emplace_back(saved, beside);
      while (!search_.empty()) {
        const auto [saved_here, at] = search_.back();
        search_.pop_back();
        if (saved_here - own <= best_saving) continue;
        const Work& work = nodes_[at];
        const float saving = saved_here - surface(merged(work.box, box));
        // Beside its own sibling it would be where it was.
        if (saving > best_saving && !(pivot == parent && at == beside)) {
          best_saving = saving;
          best = at;
        }
        if (work.leaf.is_leaf()) continue;
        const float saved_below = saving + surface(work.box);
        search_.emplace_back(saved_below, work.child[0]);
        search_.emplace_back(saved_below, work.child[1]);
      }
      if (pivot != parent) {
        without.grow(nodes_[beside].box);
        saved += surface(nodes_[pivot].box) - surface(without);
      }
      if (pivot == 0) break;
      beside = sibling(pivot);
      pivot = nodes_[pivot].parent;
    }
    // Differences of floats up to the root's surface: a saving within their rounding is none.
    constexpr float rounding = 1e-7F;
    return best_saving > rounding * surface(nodes_[0].box) ? best : none;
  }

  void replace_child(std::uint32_t parent, std::uint32_t old_child, std::uint32_t new_child) {
    Work& work = nodes_[parent];
    work.child[work.child[0] == old_child ? 0 : 1] = new_child;
    nodes_[new_child].parent = parent;
  }

  void refit_upward(std::uint32_t node) {
    for (; node != none; node = nodes_[node].parent) {
      Work& work = nodes_[node];
      work.box = merged(nodes_[work.child[0]].box, nodes_[work.child[1]].box);
    }
  }

  /// Takes a node out and puts it beside `place`; its old parent becomes their parent.
  void move(std::uint32_t node, std::uint32_t place) {
    const std::uint32_t parent = nodes_[node].parent;
    const std::uint32_t grandparent = nodes_[parent].parent;
    replace_child(grandparent, parent, sibling(node));
    refit_upward(grandparent);
    replace_child(nodes_[place].parent, place, parent);
    nodes_[parent].child[0] = place;
    nodes_[parent].child[1] = node;
    nodes_[place].parent = parent;
    refit_upward(parent);
  }

  std::vector<Work> nodes_;
  std::vector<std::pair<float, std::uint32_t>> search_;
};

}  // namespace crashrank::detail

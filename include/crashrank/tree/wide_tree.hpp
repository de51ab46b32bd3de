#pragma once

#include "crashrank/base/column.hpp"
#include "crashrank/base/huge_pages.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace crashrank {

/// Children of a wide node, and triangles of a cluster: the lanes of one vector of eight floats.
inline constexpr std::size_t wide_lanes = 8;

/// Eight boxes side by side, four cache lines. Boxes are centre and half extent in the tree's
/// frame, rounded outward; lanes without a child have a negative half extent and touch nothing.
struct alignas(64) WideNode {
  std::array<std::array<float, wide_lanes>, 3> center;  ///< of each child, by axis, m
  std::array<std::array<float, wide_lanes>, 3> half;  ///< half the extent of each child, by axis, m
  /// Inner child: index of its node. Leaf: `wide_leaf_bit`, number of triangles less one in the
  /// three bits below, index of its cluster in the rest.
  std::array<std::uint32_t, wide_lanes> child;
  std::array<float, 3> own_center;  ///< the box around all eight
  std::array<float, 3> own_half;    ///< and half its extent
  std::uint32_t used_lanes = 0;     ///< bit per lane that has a child
  std::uint32_t leaf_lanes = 0;     ///< bit per lane whose child is a cluster
};
static_assert(sizeof(WideNode) == 256);

/// Half extent of a lane without a child, m.
inline constexpr float unused_half = -1e30F;

inline constexpr std::uint32_t wide_leaf_bit = 0x80000000U;  ///< Set in a child that is a cluster.
inline constexpr std::uint32_t max_clusters = 1U << 28U;     ///< Most clusters of a tree.

/// The cluster that a child stands for.
inline std::uint32_t cluster_index(std::uint32_t child) { return child & (max_clusters - 1); }
/// Its number of triangles.
inline std::uint32_t cluster_size(std::uint32_t child) { return ((child >> 28U) & 7U) + 1; }

/// One to eight triangles with their exact float32 corners, by coordinate: corner[3·k +
/// axis][lane]. Lanes beyond the cluster's size repeat its first triangle.
struct alignas(64) TriangleCluster {
  std::array<std::array<float, wide_lanes>, 9> corner;  ///< m
  std::array<std::uint32_t, wide_lanes> index;          ///< in the mesh
};
static_assert(sizeof(TriangleCluster) == 320);

/// Where the lanes of a wide tree hold a subtree of the binary tree.
struct WideLanes {
  std::uint32_t node = 0;   ///< of the wide tree
  std::uint32_t lanes = 0;  ///< bit i: lane i
};

/// A tree of eight children a node, collapsed from the binary tree, with all that a query touches.
/// Subtrees of at most eight triangles become clusters. Lanes stand in the order of the binary
/// tree's slots, so that a binary subtree is a run of lanes of one wide node.
struct WideTree {
  Column<WideNode> nodes;            ///< nodes[0] is the root; empty: the binary tree was too deep
  Column<TriangleCluster> clusters;  ///< of up to eight triangles
  /// By binary node: the lanes that hold its subtree, for nodes that hold more than one cluster or
  /// are one; nodes inside a cluster have no lanes.
  Column<WideLanes> lanes_of;
  std::uint32_t depth = 0;  ///< levels of nodes

  /// True without any node.
  bool empty() const noexcept { return nodes.empty(); }
  /// Memory that it holds, but for slack.
  std::size_t bytes() const noexcept {
    return nodes.size() * sizeof(WideNode) + clusters.size() * sizeof(TriangleCluster);
  }
};

/// Binary trees deeper than this (the literal rule makes them) have no wide tree.
inline constexpr std::uint32_t max_wide_depth = 512;

namespace detail {

/// Smallest float that is not below x.
inline float round_up(double x) {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) >= x ? f
                                     : std::nextafter(f, std::numeric_limits<float>::infinity());
}

/// Centre and half extent that enclose [min, max]. Both differences are exact or rounded by 2^-53
/// relative; the factor covers that before rounding up to float.
inline void center_half(float min, float max, float& center, float& half) {
  const double lo = min;
  const double hi = max;
  center = static_cast<float>(0.5 * lo + 0.5 * hi);
  const double reach = std::max(hi - center, center - lo);
  half = round_up(reach * (1.0 + 0x1p-50));
}

/// Collapses a binary tree. Near the root the largest boxes are opened first. Below, the surfaces
/// of the wide nodes, which stand for the chance that one is visited, sum up to the least: found by
/// dynamic programming, as Ylitie, Karras and Laine
/// 2017 do ("Efficient incoherent ray traversal on GPUs through compressed wide BVHs"). Opening the
/// largest boxes all the way down leaves the nodes near the clusters half empty.
class WideBuilder {
public:
  explicit WideBuilder(const AabbTree& tree)
      : tree_(tree), slots_(tree.nodes.size()), plans_(tree.nodes.size()) {
    for (std::size_t i = tree.nodes.size(); i-- > 0;) {
      const Node& node = tree.nodes[i];
      slots_[i] = {node.first, node.count};
      if (!node.is_leaf()) {
        slots_[i] = {slots_[node.first].first,
                     slots_[node.first].count + slots_[node.first + 1].count};
      }
      if (!is_cluster(i)) plan(node, plans_[i]);
    }
  }

  WideTree build() {
    wide_.lanes_of.assign(tree_.nodes.size(), {});
    wide_.nodes.emplace_back();
    open_.push_back({0, 0, 1});
    while (!open_.empty()) {
      const Open next = open_.back();
      open_.pop_back();
      fill(next);
    }
    prefer_huge_pages(wide_.nodes.data(), wide_.nodes.size() * sizeof(WideNode));
    prefer_huge_pages(wide_.clusters.data(), wide_.clusters.size() * sizeof(TriangleCluster));
    return std::move(wide_);
  }

private:
  struct Open {
    std::uint32_t binary;
    std::uint32_t wide;
    std::uint32_t level;
  };
  using Lanes8 = std::array<std::uint32_t, wide_lanes>;

  /// The least sum of surfaces below a binary node that gets at most 1 to 8 lanes, [lanes - 1], and
  /// how many of them go to its left child; 0: the subtree stays one lane. A cluster costs nothing.
  struct Plan {
    std::array<float, wide_lanes> cost{};
    std::array<std::uint8_t, wide_lanes> left{};
    std::uint8_t left_of_all = 0;  ///< as left[7], where the node has to be opened
  };

  /// Nodes of more triangles than this count as near the root.
  static constexpr std::uint32_t top_triangles = 4096;

  bool is_cluster(std::size_t binary) const { return slots_[binary].count <= wide_lanes; }

  void plan(const Node& node, Plan& plan) const {
    const Plan& first = plans_[node.first];
    const Plan& second = plans_[node.first + 1];
    for (std::size_t lanes = 2; lanes <= wide_lanes; ++lanes) {
      float best = std::numeric_limits<float>::infinity();
      std::size_t left = 1;
      for (std::size_t k = 1; k < lanes; ++k) {
        const float cost = first.cost[k - 1] + second.cost[lanes - k - 1];
        if (cost < best) {
          best = cost;
          left = k;
        }
      }
      plan.cost[lanes - 1] = best;
      plan.left[lanes - 1] = static_cast<std::uint8_t>(left);
    }
    plan.left_of_all = plan.left[wide_lanes - 1];
    plan.cost[0] = half_area(node.box) + plan.cost[wide_lanes - 1];
    for (std::size_t lanes = 2; lanes <= wide_lanes; ++lanes) {
      if (!(plan.cost[0] < plan.cost[lanes - 1])) continue;
      plan.cost[lanes - 1] = plan.cost[0];
      plan.left[lanes - 1] = 0;
    }
  }

  /// Appends the lanes of a subtree in slot order. Nested at most seven deep.
  void choose_lanes(std::uint32_t binary, std::size_t lanes, std::size_t left, Lanes8& lane,
                    std::size_t& used) {
    if (left == 0) {
      lane[used++] = binary;
      return;
    }
    opened_.push_back(binary);
    const std::uint32_t child = tree_.nodes[binary].first;
    const std::size_t right = lanes - left;
    choose_lanes(child, left, plans_[child].left[left - 1], lane, used);
    choose_lanes(child + 1, right, plans_[child + 1].left[right - 1], lane, used);
  }

  /// The lanes of a node near the root, in slot order: the largest boxes are opened first. Queries
  /// between bodies that hardly meet end up here, and mind that more than how well the nodes below
  /// are filled.
  void open_largest(std::uint32_t binary, Lanes8& lane, std::size_t& used) {
    lane[0] = binary;
    used = 1;
    while (used < wide_lanes) {
      std::size_t largest = wide_lanes;
      float size = -1.0F;
      for (std::size_t i = 0; i < used; ++i) {
        if (is_cluster(lane[i])) continue;
        const float own = half_area(tree_.nodes[lane[i]].box);
        if (!(own <= size)) {  // NaN, from boxes too large for a float, is opened as well
          size = own;
          largest = i;
        }
      }
      if (largest == wide_lanes) break;
      opened_.push_back(lane[largest]);
      const std::uint32_t left = tree_.nodes[lane[largest]].first;
      for (std::size_t i = used; i > largest + 1; --i) lane[i] = lane[i - 1];
      lane[largest] = left;
      lane[largest + 1] = left + 1;
      ++used;
    }
  }

  void fill(const Open& open) {
    wide_.depth = std::max(wide_.depth, open.level);
    Lanes8 lane{};
    std::size_t used = 0;
    opened_.clear();
    if (slots_[open.binary].count > top_triangles) {
      open_largest(open.binary, lane, used);
    } else {
      choose_lanes(open.binary, wide_lanes, plans_[open.binary].left_of_all, lane, used);
    }
    place(open, lane, used);
    for (const std::uint32_t binary : opened_) record_lanes(open.wide, binary, lane, used);
  }

  void place(const Open& open, const Lanes8& lane, std::size_t used) {
    WideNode node{};
    const Box& own = tree_.nodes[open.binary].box;
    for (int axis = 0; axis < 3; ++axis) {
      const auto d = static_cast<std::size_t>(axis);
      center_half(own.min[axis], own.max[axis], node.own_center[d], node.own_half[d]);
      node.half[d].fill(unused_half);
    }
    for (std::size_t i = 0; i < used; ++i) {
      const Box& box = tree_.nodes[lane[i]].box;
      for (int axis = 0; axis < 3; ++axis) {
        const auto d = static_cast<std::size_t>(axis);
        center_half(box.min[axis], box.max[axis], node.center[d][i], node.half[d][i]);
      }
      node.used_lanes |= 1U << i;
      wide_.lanes_of[lane[i]] = {open.wide, 1U << i};
      if (is_cluster(lane[i])) {
        node.leaf_lanes |= 1U << i;
        node.child[i] = add_cluster(lane[i]);
      } else {
        node.child[i] = static_cast<std::uint32_t>(wide_.nodes.size());
        wide_.nodes.emplace_back();
        open_.push_back({lane[i], node.child[i], open.level + 1});
      }
    }
    wide_.nodes[open.wide] = node;
  }

  void record_lanes(std::uint32_t wide, std::uint32_t binary, const Lanes8& lane,
                    std::size_t used) {
    const Range below = slots_[binary];
    std::uint32_t lanes = 0;  ///< bit i: lane i
    for (std::size_t i = 0; i < used; ++i) {
      const std::uint32_t first = slots_[lane[i]].first;
      if (first >= below.first && first < below.first + below.count) lanes |= 1U << i;
    }
    // The node that fills the whole wide node keeps the address of its box, one level up, unless
    // it is the root.
    if (wide_.lanes_of[binary].lanes == 0) wide_.lanes_of[binary] = {wide, lanes};
  }

  std::uint32_t add_cluster(std::uint32_t binary) {
    const Range slots = slots_[binary];
    TriangleCluster cluster{};
    for (std::size_t lane = 0; lane < wide_lanes; ++lane) {
      const std::size_t slot = slots.first + (lane < slots.count ? lane : 0);
      const Triangle& triangle = tree_.triangles[slot];
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          cluster.corner[3 * k + axis][lane] = triangle.corner[k][static_cast<int>(axis)];
        }
      }
      cluster.index[lane] = tree_.order[slot];
    }
    const auto index = static_cast<std::uint32_t>(wide_.clusters.size());
    wide_.clusters.push_back(cluster);
    return wide_leaf_bit | (slots.count - 1) << 28U | index;
  }

  const AabbTree& tree_;
  std::vector<Range> slots_;  // of the triangles below each binary node
  std::vector<Plan> plans_;
  std::vector<Open> open_;
  std::vector<std::uint32_t> opened_;
  WideTree wide_;
};

}  // namespace detail

/// Collapses a binary tree of leaves of at most eight triangles into nodes of eight. O(n). Empty
/// when the tree is deeper than `max_wide_depth`, has larger leaves, or has no triangles: the
/// scalar engine serves those.
inline WideTree widen(const AabbTree& tree) {
  if (tree.empty() || tree.depth > max_wide_depth || tree.order.size() >= max_clusters) return {};
  for (const Node& node : tree.nodes) {
    if (node.count > wide_lanes) return {};
  }
  return detail::WideBuilder(tree).build();
}

}  // namespace crashrank

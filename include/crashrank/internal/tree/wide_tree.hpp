#pragma once

#include "crashrank/base/view.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

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

}  // namespace crashrank

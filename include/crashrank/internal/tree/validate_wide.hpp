#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/internal/tree/lanes.hpp"
#include "crashrank/internal/tree/validate_tree.hpp"
#include "crashrank/internal/tree/wide_tree.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace crashrank::detail {

/// Rows become columns.
inline void transpose(Lanes& a, Lanes& b, Lanes& c, Lanes& d) {
  const Lanes low_ab = __builtin_shufflevector(a, b, 0, 4, 1, 5);
  const Lanes low_cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const Lanes high_ab = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Lanes high_cd = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  a = __builtin_shufflevector(low_ab, low_cd, 0, 1, 4, 5);
  b = __builtin_shufflevector(low_ab, low_cd, 2, 3, 6, 7);
  c = __builtin_shufflevector(high_ab, high_cd, 0, 1, 4, 5);
  d = __builtin_shufflevector(high_ab, high_cd, 2, 3, 6, 7);
}

/// Checks a wide tree against the binary tree that it was collapsed from, which has been checked.
class WideValidator {
public:
  WideValidator(const WideTree& wide, const AabbTree& tree, const Below* below)
      : nodes_(wide.nodes),
        clusters_(wide.clusters),
        lanes_of_(wide.lanes_of),
        wide_(wide),
        tree_(tree),
        below_(below) {}

  Status check() {
    if (Status status = check_sizes(); !status) return status;
    if (Status status = walk(); !status) return status;
    return check_lanes_of();
  }

private:
  struct Open {
    std::uint32_t node;
    std::uint32_t lane;
  };

  /// The slots that one lane holds, and whether its box was seen to enclose them.
  struct Lane {
    std::uint32_t first = 0;
    std::uint32_t end = 0;
    bool enclosed = false;
  };

  static Error broken(std::size_t node, const char* reason) {
    return broken_tree("wide node " + std::to_string(node), reason);
  }

  Status check_sizes() const {
    if (clusters_.size() > tree_.order.size() || nodes_.size() > clusters_.size()) {
      return broken_tree("wide tree", "it has more nodes or clusters than triangles");
    }
    if (lanes_of_.size() != tree_.nodes.size()) {
      return broken_tree("wide tree", "its table of lanes is not that of the binary tree");
    }
    if (wide_.depth > max_wide_depth) return broken_tree("wide tree", "it is too deep");
    return Success{};
  }

  /// Visits lanes in the order of the slots, so that each cluster has to hold the next ones.
  Status walk() {
    lane_.assign(nodes_.size() * wide_lanes, {});
    std::vector<unsigned char> node_seen(nodes_.size(), 0);
    std::vector<unsigned char> cluster_seen(clusters_.size(), 0);
    std::size_t nodes = 0;
    std::size_t clusters = 0;
    std::size_t slot = 0;
    std::size_t depth = 0;
    std::vector<Open> open;
    const auto enter = [&](std::uint32_t node) -> Status {
      if (node >= nodes_.size()) return broken(node, "it does not exist");
      if (node_seen[node] != 0) return broken(node, "two lanes lead to it");
      node_seen[node] = 1;
      ++nodes;
      open.push_back({node, 0});
      depth = std::max(depth, open.size());
      return check_lanes(node);
    };
    if (Status status = enter(0); !status) return status;
    while (!open.empty()) {
      Open& at = open.back();
      const WideNode& node = nodes_[at.node];
      if (at.lane > 0) lane(at.node, at.lane - 1).end = static_cast<std::uint32_t>(slot);
      if (at.lane == wide_lanes || (node.used_lanes >> at.lane & 1U) == 0) {
        open.pop_back();
        continue;
      }
      const std::uint32_t child = node.child[at.lane];
      const bool leaf = (node.leaf_lanes >> at.lane & 1U) != 0;
      lane(at.node, at.lane).first = static_cast<std::uint32_t>(slot);
      ++at.lane;  // `enter` below may move what `at` refers to
      if (leaf != ((child & wide_leaf_bit) != 0)) {
        return broken(open.back().node, "a lane is marked as what it is not");
      }
      if (!leaf) {
        if (Status status = enter(child); !status) return status;
        continue;
      }
      const std::uint32_t cluster = cluster_index(child);
      const std::size_t size = cluster_size(child);
      if (cluster >= clusters_.size() || cluster_seen[cluster] != 0) {
        return broken(open.back().node, "a lane's cluster does not exist or is another's");
      }
      cluster_seen[cluster] = 1;
      ++clusters;
      if (size > tree_.order.size() - slot || !same_triangles(clusters_[cluster], slot, size)) {
        return broken_tree("cluster " + std::to_string(cluster),
                           "its triangles are not those of the next slots");
      }
      slot += size;
    }
    if (nodes != nodes_.size() || clusters != clusters_.size() || slot != tree_.order.size()) {
      return broken_tree("wide tree", "a node, a cluster or a triangle is in no lane");
    }
    if (depth != wide_.depth) return broken_tree("wide tree", "its depth is another");
    return Success{};
  }

  /// Used lanes come first; what is not used touches nothing.
  Status check_lanes(std::uint32_t index) const {
    const WideNode& node = nodes_[index];
    const std::uint32_t used = node.used_lanes;
    if (used == 0 || used > 0xffU || (used & (used + 1)) != 0 || (node.leaf_lanes & ~used) != 0) {
      return broken(index, "its lanes are not marked as the layout has it");
    }
    // All lanes are looked at, those that count among the unused by a mask.
    static constexpr std::array<int, 2 * wide_lanes> unused_from{0,  0,  0,  0,  0,  0,  0,  0,
                                                                 -1, -1, -1, -1, -1, -1, -1, -1};
    const int* const mask = &unused_from[wide_lanes - highest_bit(used) - 1];
    const IntLanes idle_half = bits(all_lanes(unused_half));
    IntLanes wrong = {0, 0, 0, 0};
    for (std::size_t i = 0; i < wide_lanes; i += 4) {
      IntLanes counts;
      IntLanes child;
      std::memcpy(&counts, mask + i, sizeof counts);
      std::memcpy(&child, &node.child[i], sizeof child);
      IntLanes found = child;
      for (std::size_t d = 0; d < 3; ++d) {
        found |= load_bits(&node.center[d][i]) | (load_bits(&node.half[d][i]) ^ idle_half);
      }
      wrong |= counts & found;
    }
    if ((wrong[0] | wrong[1] | wrong[2] | wrong[3]) != 0) {
      return broken(index, "a lane without a child is not empty");
    }
    return Success{};
  }

  static IntLanes load_bits(const float* four) {
    IntLanes bits;
    std::memcpy(&bits, four, sizeof bits);
    return bits;
  }

  /// Compares bits, four triangles at a time turned into the order of the cluster.
  bool same_triangles(const TriangleCluster& cluster, std::size_t slot, std::size_t size) const {
    const Triangle* const triangles = tree_.triangles.data() + slot;
    const std::uint32_t* const order = tree_.order.data() + slot;
    IntLanes wrong = {0, 0, 0, 0};
    std::uint32_t wrong_index = 0;
    for (std::size_t half = 0; half < wide_lanes; half += 4) {
      const auto source = [&](std::size_t i) { return half + i < size ? half + i : 0; };
      const std::array<std::size_t, 4> from{source(0), source(1), source(2), source(3)};
      const std::array<const float*, 4> row{
          triangles[from[0]].corner[0].data(), triangles[from[1]].corner[0].data(),
          triangles[from[2]].corner[0].data(), triangles[from[3]].corner[0].data()};
      for (std::size_t k = 0; k < 8; k += 4) {
        Lanes a = load_lanes(row[0] + k);
        Lanes b = load_lanes(row[1] + k);
        Lanes c = load_lanes(row[2] + k);
        Lanes d = load_lanes(row[3] + k);
        transpose(a, b, c, d);
        wrong |= (bits(a) ^ load_bits(&cluster.corner[k][half])) |
                 (bits(b) ^ load_bits(&cluster.corner[k + 1][half])) |
                 (bits(c) ^ load_bits(&cluster.corner[k + 2][half])) |
                 (bits(d) ^ load_bits(&cluster.corner[k + 3][half]));
      }
      const Lanes last{row[0][8], row[1][8], row[2][8], row[3][8]};
      wrong |= bits(last) ^ load_bits(&cluster.corner[8][half]);
      for (std::size_t i = 0; i < 4; ++i) {
        wrong_index |= cluster.index[half + i] ^ order[from[i]];
      }
    }
    return wrong_index == 0 && (wrong[0] | wrong[1] | wrong[2] | wrong[3]) == 0;
  }
  static IntLanes bits(Lanes lanes) {
    IntLanes same;
    std::memcpy(&same, &lanes, sizeof same);
    return same;
  }

  /// Every binary node that says where its lanes are has to say so rightly; every lane, and what it
  /// leads to, has to be the box of a binary node, enlarged by rounding at most.
  Status check_lanes_of() {
    const View<const Node> binary = tree_.nodes;
    const double largest = std::max(static_cast<double>(binary[0].box.min.cwiseAbs().maxCoeff()),
                                    static_cast<double>(binary[0].box.max.cwiseAbs().maxCoeff()));
    limit_ = largest * (1.0 + 0x1p-20) + 0x1p-140;

    std::size_t enclosed = 0;
    for (std::size_t i = 0; i < binary.size(); ++i) {
      const WideLanes& at = lanes_of_[i];
      if (at.lanes == 0) continue;
      if (at.node >= nodes_.size() || (at.lanes & ~nodes_[at.node].used_lanes) != 0) {
        return broken_node(i, "its lanes do not exist");
      }
      const WideNode& node = nodes_[at.node];
      const std::uint32_t lowest = lowest_bit(at.lanes);
      const std::uint32_t highest = highest_bit(at.lanes);
      if (at.lanes >> lowest != (1U << (highest - lowest + 1)) - 1 ||
          lane(at.node, lowest).first != below_[i].first_slot ||
          lane(at.node, highest).end != below_[i].end_slot) {
        return broken_node(i, "its lanes hold other triangles than it does");
      }
      if (lowest != highest) continue;
      Lane& one = lane(at.node, lowest);
      const std::uint32_t child = node.child[lowest];
      if (!encloses_lane(node, lowest, binary[i].box) ||
          ((child & wide_leaf_bit) == 0 && !encloses_own(nodes_[child], binary[i].box))) {
        return broken(at.node, "a lane does not enclose what it holds, or is too large");
      }
      enclosed += one.enclosed ? 0 : 1;
      one.enclosed = true;
    }
    if (!encloses_own(nodes_[0], binary[0].box)) return broken(0, "it does not enclose the tree");
    if (enclosed != clusters_.size() + nodes_.size() - 1) {
      return broken_tree("wide tree", "a lane is no node of the binary tree");
    }
    return Success{};
  }

  /// As `center_half` makes them: the factor covers what rounding takes from the differences.
  bool encloses(float center, float half, float min, float max) const {
    const double c = center;
    const double h = half;
    const double above = static_cast<double>(max) - c;
    const double below = c - static_cast<double>(min);
    const double reach = above > below ? above : below;
    return (h >= reach * (1.0 + 0x1p-50)) & (std::abs(c) + h <= limit_);
  }
  bool encloses_lane(const WideNode& node, std::size_t lane, const Box& box) const {
    bool all = true;
    for (std::size_t d = 0; d < 3; ++d) {
      const int axis = static_cast<int>(d);
      all &= encloses(node.center[d][lane], node.half[d][lane], box.min[axis], box.max[axis]);
    }
    return all;
  }
  bool encloses_own(const WideNode& node, const Box& box) const {
    bool all = true;
    for (std::size_t d = 0; d < 3; ++d) {
      const int axis = static_cast<int>(d);
      all &= encloses(node.own_center[d], node.own_half[d], box.min[axis], box.max[axis]);
    }
    return all;
  }

  // Of words that are not zero.
  static std::uint32_t lowest_bit(std::uint32_t bits) {
    return static_cast<std::uint32_t>(__builtin_ctz(bits));
  }
  static std::uint32_t highest_bit(std::uint32_t bits) {
    return 31U - static_cast<std::uint32_t>(__builtin_clz(bits));
  }
  Lane& lane(std::uint32_t node, std::uint32_t index) { return lane_[node * wide_lanes + index]; }

  View<const WideNode> nodes_;
  View<const TriangleCluster> clusters_;
  View<const WideLanes> lanes_of_;
  const WideTree& wide_;
  const AabbTree& tree_;
  const Below* below_;
  std::vector<Lane> lane_;
  double limit_ = 0.0;
};

/// `validate` of a model, with what `validate_tree` returned about the binary tree.
inline Status validate_wide(const WideTree& wide, const AabbTree& tree, const Below* below) {
  if (wide.nodes.empty()) {
    if (wide.clusters.empty() && wide.lanes_of.empty() && wide.depth == 0) return Success{};
    return broken_tree("wide tree", "it has clusters but no node");
  }
  return WideValidator(wide, tree, below).check();
}

}  // namespace crashrank::detail

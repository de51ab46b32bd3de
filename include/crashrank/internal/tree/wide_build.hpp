#pragma once

#include "crashrank/base/box.hpp"
#include "crashrank/internal/base/huge_pages.hpp"
#include "crashrank/internal/tree/build_records.hpp"
#include "crashrank/internal/tree/lanes.hpp"
#include "crashrank/internal/tree/parallel_build.hpp"
#include "crashrank/internal/tree/round_up.hpp"
#include "crashrank/internal/tree/wide_tree.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <mutex>
#include <utility>
#include <vector>

namespace crashrank {

namespace detail {

/// The least sum of surfaces below a binary node that gets at most 1 to 8 lanes, [lanes - 1], and
/// how many of them go to its left child; 0: the subtree stays one lane. A cluster costs nothing.
struct CollapsePlan {
  std::array<float, wide_lanes> cost{};
  std::array<std::uint8_t, wide_lanes> left{};
  std::uint8_t left_of_all = 0;  ///< as left[7], where the node has to be opened
};

/// Plans a node from the plans of its two children: eight numbers of lanes at once.
inline void plan_collapse(float surface, const CollapsePlan& first, const CollapsePlan& second,
                          CollapsePlan& plan) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  // What is left of the costs makes numbers of lanes that do not suffice for both children cost
  // infinity.
  float right_costs[2 * wide_lanes];
  std::fill_n(right_costs, wide_lanes, infinity);
  std::memcpy(right_costs + wide_lanes, second.cost.data(), sizeof second.cost);
  Lanes best[2] = {all_lanes(infinity), all_lanes(infinity)};
  IntLanes left[2] = {IntLanes{1, 1, 1, 1}, IntLanes{1, 1, 1, 1}};
  for (std::size_t k = 1; k < wide_lanes; ++k) {
    const auto lanes = static_cast<std::int32_t>(k);
    for (std::size_t half = 0; half < 2; ++half) {
      Lanes right;
      std::memcpy(&right, right_costs + wide_lanes + 4 * half - k, sizeof right);
      const Lanes cost = all_lanes(first.cost[k - 1]) + right;
      const IntLanes better = cost < best[half];
      best[half] = better ? cost : best[half];
      left[half] = better ? IntLanes{lanes, lanes, lanes, lanes} : left[half];
    }
  }
  plan.left_of_all = static_cast<std::uint8_t>(left[1][3]);
  // A single lane is a wide node of its own, and what that costs may be best where more are given.
  const Lanes closed = all_lanes(surface + best[1][3]);
  for (std::size_t half = 0; half < 2; ++half) {
    const IntLanes stays = closed < best[half];
    best[half] = stays ? closed : best[half];
    left[half] = stays ? IntLanes{0, 0, 0, 0} : left[half];
    std::memcpy(plan.cost.data() + 4 * half, &best[half], sizeof best[half]);
    for (int i = 0; i < 4; ++i) {
      plan.left[4 * half + static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(left[half][i]);
    }
  }
  plan.cost[0] = closed[0];
  plan.left[0] = 0;
}

/// Collapses a binary tree. Near the root the largest boxes are opened first. Below, the surfaces
/// of the wide nodes, which stand for the chance that one is visited, sum up to the least: found by
/// dynamic programming, as Ylitie, Karras and Laine 2017 do ("Efficient incoherent ray traversal on
/// GPUs through compressed wide BVHs"). Opening the largest boxes all the way down leaves the nodes
/// near the clusters half empty.
///
/// What goes where is decided by one thread, in some hundredths of the time of a build; boxes and
/// corners are then written by several.
class WideBuilder {
public:
  explicit WideBuilder(const AabbTree& tree)
      : nodes_(tree.nodes),
        order_(tree.order),
        triangles_(tree.triangles),
        below_(tree.nodes.size()) {}

  WideTree build(std::uint32_t threads) {
    count_below();
    std::once_flag prepared;
    const auto prepare = [this, &prepared] {
      std::call_once(prepared, [this] {
        clusters_.reserve(cluster_count_);
        prefer_huge_pages_early(clusters_.data(), cluster_count_ * sizeof(TriangleCluster));
        clusters_.resize(cluster_count_);
      });
    };
    on_threads(std::min(threads, 2U), [&](std::uint32_t index) {
      if (index == 1) {
        prepare();
      } else {
        plan();
        lay_out();
      }
    });
    prepare();
    on_slices(wide_.size(), threads, [this](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) fill(i);
    });
    WideTree tree;
    tree.depth = depth_;
    tree.lanes_of = std::move(lanes_of_);
    prefer_huge_pages(wide_.data(), wide_.size() * sizeof(WideNode));
    prefer_huge_pages(clusters_.data(), clusters_.size() * sizeof(TriangleCluster));
    tree.nodes = std::move(wide_);
    tree.clusters = std::move(clusters_);
    return tree;
  }

private:
  struct Open {
    std::uint32_t binary;
    std::uint32_t wide;
    std::uint32_t level;
  };
  using Lanes8 = std::array<std::uint32_t, wide_lanes>;

  /// What is below a binary node.
  struct Below {
    std::uint32_t first;  ///< slot
    std::uint32_t count;  ///< triangles
    std::uint32_t plan;   ///< of its collapse; 0 for what fits into a cluster
  };

  /// Which binary nodes a wide node is made of.
  struct Source {
    std::uint32_t binary = 0;  ///< the whole
    Lanes8 lane{};
  };

  /// Nodes of more triangles than this count as near the root.
  static constexpr std::uint32_t top_triangles = 4096;

  bool is_cluster(std::size_t binary) const { return below_[binary].plan == 0; }

  /// Slots and numbers of plans, children's before their parent's.
  void count_below() {
    std::uint32_t plans = 0;
    for (std::size_t i = nodes_.size(); i-- > 0;) {
      const Node& node = nodes_[i];
      Below& below = below_[i];
      below = {node.first, node.count, 0};
      if (node.is_leaf()) continue;
      const Below& left = below_[node.first];
      const Below& right = below_[node.first + 1];
      below = {left.first, left.count + right.count, 0};
      if (below.count <= wide_lanes) continue;
      below.plan = ++plans;
      cluster_count_ += (left.plan == 0 ? 1U : 0U) + (right.plan == 0 ? 1U : 0U);
    }
    plan_count_ = plans;
    cluster_count_ += plans == 0 ? 1U : 0U;
  }

  void plan() {
    plans_.resize(plan_count_ + 1);
    for (std::size_t i = nodes_.size(); i-- > 0;) {
      const std::uint32_t plan = below_[i].plan;
      if (plan == 0) continue;
      const Node& node = nodes_[i];
      plan_collapse(half_area(node.box), plans_[below_[node.first].plan],
                    plans_[below_[node.first + 1].plan], plans_[plan]);
    }
  }

  void lay_out() {
    lanes_of_.assign(nodes_.size(), {});
    wide_.reserve(cluster_count_ / 4 + 8);
    sources_.reserve(cluster_count_ / 4 + 8);
    wide_.emplace_back();
    sources_.emplace_back();
    open_.push_back({0, 0, 1});
    while (!open_.empty()) {
      const Open next = open_.back();
      open_.pop_back();
      lay_out(next);
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
    const std::uint32_t child = nodes_[binary].first;
    const std::size_t right = lanes - left;
    choose_lanes(child, left, plans_[below_[child].plan].left[left - 1], lane, used);
    choose_lanes(child + 1, right, plans_[below_[child + 1].plan].left[right - 1], lane, used);
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
        const float own = half_area(nodes_[lane[i]].box);
        if (!(own <= size)) {  // NaN, from boxes too large for a float, is opened as well
          size = own;
          largest = i;
        }
      }
      if (largest == wide_lanes) break;
      opened_.push_back(lane[largest]);
      const std::uint32_t left = nodes_[lane[largest]].first;
      for (std::size_t i = used; i > largest + 1; --i) lane[i] = lane[i - 1];
      lane[largest] = left;
      lane[largest + 1] = left + 1;
      ++used;
    }
  }

  void lay_out(const Open& open) {
    depth_ = std::max(depth_, open.level);
    Lanes8 lane{};
    std::size_t used = 0;
    opened_.clear();
    if (below_[open.binary].count > top_triangles) {
      open_largest(open.binary, lane, used);
    } else {
      choose_lanes(open.binary, wide_lanes, plans_[below_[open.binary].plan].left_of_all, lane,
                   used);
    }
    WideNode node{};
    for (std::size_t i = 0; i < used; ++i) {
      node.used_lanes |= 1U << i;
      lanes_of_[lane[i]] = {open.wide, 1U << i};
      if (is_cluster(lane[i])) {
        node.leaf_lanes |= 1U << i;
        node.child[i] = wide_leaf_bit | (below_[lane[i]].count - 1) << 28U | clusters_named_++;
      } else {
        node.child[i] = static_cast<std::uint32_t>(wide_.size());
        wide_.emplace_back();
        sources_.emplace_back();
        open_.push_back({lane[i], node.child[i], open.level + 1});
      }
    }
    wide_[open.wide] = node;
    sources_[open.wide] = {open.binary, lane};
    for (const std::uint32_t binary : opened_) record_lanes(open.wide, binary, lane, used);
  }

  void record_lanes(std::uint32_t wide, std::uint32_t binary, const Lanes8& lane,
                    std::size_t used) {
    const Below below = below_[binary];
    std::uint32_t lanes = 0;  ///< bit i: lane i
    for (std::size_t i = 0; i < used; ++i) {
      const std::uint32_t first = below_[lane[i]].first;
      if (first >= below.first && first < below.first + below.count) lanes |= 1U << i;
    }
    // The node that fills the whole wide node keeps the address of its box, one level up, unless
    // it is the root.
    if (lanes_of_[binary].lanes == 0) lanes_of_[binary] = {wide, lanes};
  }

  /// Writes boxes and clusters of a wide node.
  void fill(std::size_t wide) {
    WideNode& node = wide_[wide];
    const Source& source = sources_[wide];
    const Box& own = nodes_[source.binary].box;
    for (int axis = 0; axis < 3; ++axis) {
      const auto d = static_cast<std::size_t>(axis);
      center_half(own.min[axis], own.max[axis], node.own_center[d], node.own_half[d]);
      node.half[d].fill(unused_half);
    }
    for (std::size_t i = 0; (node.used_lanes >> i & 1U) != 0; ++i) {
      const Box& box = nodes_[source.lane[i]].box;
      for (int axis = 0; axis < 3; ++axis) {
        const auto d = static_cast<std::size_t>(axis);
        center_half(box.min[axis], box.max[axis], node.center[d][i], node.half[d][i]);
      }
      if ((node.leaf_lanes >> i & 1U) != 0) {
        fill_cluster(below_[source.lane[i]], clusters_[cluster_index(node.child[i])]);
      }
    }
  }

  void fill_cluster(const Below& slots, TriangleCluster& cluster) const {
    static_assert(sizeof(Triangle) == 36);
    for (std::size_t four = 0; four < wide_lanes; four += 4) {
      Lanes front[4];
      Lanes back[4];
      for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t lane = four + i;
        const std::size_t slot = slots.first + (lane < slots.count ? lane : 0);
        const auto* const corners = reinterpret_cast<const char*>(&triangles_[slot]);
        std::memcpy(&front[i], corners, sizeof front[i]);
        std::memcpy(&back[i], corners + 16, sizeof back[i]);
        std::memcpy(&cluster.corner[8][lane], corners + 32, sizeof(float));
        cluster.index[lane] = order_[slot];
      }
      const AxisLanes rows[2] = {by_axis(front), by_axis(back)};
      for (std::size_t k = 0; k < 2; ++k) {
        std::memcpy(&cluster.corner[4 * k][four], &rows[k].x, sizeof(Lanes));
        std::memcpy(&cluster.corner[4 * k + 1][four], &rows[k].y, sizeof(Lanes));
        std::memcpy(&cluster.corner[4 * k + 2][four], &rows[k].z, sizeof(Lanes));
        std::memcpy(&cluster.corner[4 * k + 3][four], &rows[k].w, sizeof(Lanes));
      }
    }
  }

  View<const Node> nodes_;
  View<const std::uint32_t> order_;
  View<const Triangle> triangles_;
  RawArray<Below> below_;  ///< by binary node
  std::uint32_t plan_count_ = 0;
  std::uint32_t cluster_count_ = 0;
  std::vector<CollapsePlan> plans_;  ///< [0]: of every cluster
  std::vector<Open> open_;
  std::vector<std::uint32_t> opened_;
  std::uint32_t clusters_named_ = 0;
  std::uint32_t depth_ = 0;
  std::vector<Source> sources_;  ///< by wide node
  std::vector<WideNode> wide_;
  std::vector<TriangleCluster> clusters_;
  Column<WideLanes> lanes_of_;
};

}  // namespace detail

/// Collapses a binary tree of leaves of at most eight triangles into nodes of eight, on up to
/// `threads` threads, which make no difference to the bits. O(n). Empty when the tree is deeper
/// than `max_wide_depth`, has larger leaves, or has no triangles: the scalar engine serves those.
inline WideTree widen(const AabbTree& tree, std::uint32_t threads = 1) {
  if (tree.empty() || tree.depth > max_wide_depth || tree.order.size() >= max_clusters) return {};
  for (const Node& node : tree.nodes) {
    if (node.count > wide_lanes) return {};
  }
  return detail::WideBuilder(tree).build(
      tree.order.size() < detail::min_parallel_triangles ? 1 : threads);
}

}  // namespace crashrank

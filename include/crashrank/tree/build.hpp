#pragma once

#include "crashrank/base/guarded.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/tree/aabb_tree.hpp"
#include "crashrank/tree/build_records.hpp"
#include "crashrank/tree/gaussian_frame.hpp"
#include "crashrank/tree/greedy_build.hpp"
#include "crashrank/tree/literal_split.hpp"
#include "crashrank/tree/parallel_build.hpp"
#include "crashrank/tree/reinsertion.hpp"
#include "crashrank/tree/split_cost.hpp"
#include "crashrank/tree/tree_writer.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace crashrank {

/// How a tree is built.
struct BuildOptions {
  SplitRule rule = SplitRule::min_relative_segment;  ///< where sets are split
  BoxFrame frame = BoxFrame::world;                  ///< axes of the boxes
  std::uint32_t leaf_size = 4;  ///< most triangles a leaf may hold, 1 to 255; `paper` means 1
  /// Split no set that fits into a leaf. Otherwise min_relative_segment and sah make smaller leaves
  /// where that is expected to save tests: fewer triangle pairs tested for more nodes.
  bool fill_leaves = false;
  /// After the build, whatever its rule, subtrees are moved to where the boxes above them come out
  /// smaller; at most this many passes over the tree, fewer when nothing moves any more. Worth its
  /// time (see bench/tree_bench) for a model that is built once and queried often.
  std::uint32_t reinsertion_passes = 0;
  /// Threads that min_relative_segment and sah build on, 1 to 256, the calling one among them. The
  /// tree is the same, bit for bit.
  std::uint32_t threads = 1;
};

namespace detail {

inline constexpr std::uint32_t max_leaf_size = 255;
inline constexpr std::uint32_t max_build_threads = 256;

/// Below this many triangles a tree is built before a second thread has begun to help.
inline constexpr std::size_t min_parallel_triangles = 4096;

template <class Rule>
void build_by_cost(View<BuildRecord> records, const BuildOptions& options, std::uint32_t threads,
                   std::vector<Node>& nodes) {
  std::vector<BuildRecord> scratch(records.size());
  const LeafLimits leaves{options.leaf_size, options.fill_leaves};
  const Box root = to_box(bounds(records));
  if (threads > 1) {
    ParallelBuilder<Rule>(records, scratch, leaves).build(root, threads, nodes);
    return;
  }
  nodes.reserve(records.size());
  TreeWriter writer(nodes);
  writer.open_root(root, 0, static_cast<std::uint32_t>(records.size()), 0);
  GreedyBuilder<Rule>(records, scratch, leaves).build(writer);
}

inline void build_nodes(std::vector<BuildRecord>& records, const BuildOptions& options,
                        std::uint32_t threads, std::vector<Node>& nodes) {
  if (options.rule == SplitRule::min_relative_segment) {
    return build_by_cost<RelativeSegmentRule>(records, options, threads, nodes);
  }
  if (options.rule == SplitRule::sah) {
    return build_by_cost<SurfaceAreaRule>(records, options, threads, nodes);
  }
  nodes.reserve(records.size());
  TreeWriter writer(nodes);
  writer.open_root(to_box(bounds(records)), 0, static_cast<std::uint32_t>(records.size()), 0);
  if (options.rule == SplitRule::paper) {
    LiteralBuilder(records).build(writer, records, literal_work_limit);
  } else {
    build_by_median(writer, records, options.leaf_size);
  }
}

/// Puts the triangles of a leaf into the order of their indices and writes corners by slot.
inline std::vector<Triangle> fill_slots(const TriangleMesh& mesh, std::uint32_t threads,
                                        View<const Node> nodes, std::vector<std::uint32_t>& order) {
  for (const Node& node : nodes) {
    if (node.count < 2) continue;
    std::uint32_t* const first = order.data() + node.first;
    std::sort(first, first + node.count);
  }
  std::vector<Triangle> triangles(order.size());
  on_slices(order.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) triangles[i] = mesh.triangle(order[i]);
  });
  return triangles;
}

inline Result<AabbTree> build_tree_or_throw(const TriangleMesh& mesh, const BuildOptions& options) {
  if (options.leaf_size < 1 || options.leaf_size > max_leaf_size) {
    return make_error(ErrorCode::usage, "a leaf holds 1 to 255 triangles",
                      "choose a leaf size in that range");
  }
  if (options.threads < 1 || options.threads > max_build_threads) {
    return make_error(ErrorCode::usage, "a tree is built on 1 to 256 threads");
  }
  if (Status status = check_mesh(mesh); !status) return status.error();
  AabbTree tree;
  std::vector<BuildRecord> records;
  if (options.frame == BoxFrame::gaussian) {
    tree.axes = gaussian_axes(mesh);
    tree.axes_are_world = tree.axes == Eigen::Matrix3d::Identity();
  }
  if (tree.axes_are_world) {
    records = world_records(mesh);
  } else {
    Result<std::vector<BuildRecord>> projected = projected_records(mesh, tree.axes);
    if (!projected) return projected.error();
    records = std::move(*projected);
  }

  const std::uint32_t threads = records.size() < min_parallel_triangles ? 1 : options.threads;
  std::vector<Node> nodes;
  build_nodes(records, options, threads, nodes);
  std::vector<std::uint32_t> order(records.size());
  for (std::size_t i = 0; i < records.size(); ++i) order[i] = records[i].index;
  if (options.reinsertion_passes > 0) {
    Reinsertion reinsertion(nodes);
    for (std::uint32_t i = 0; i < options.reinsertion_passes && reinsertion.pass() > 0; ++i) {
    }
    reinsertion.write(nodes, order);
  }
  tree.triangles = fill_slots(mesh, threads, nodes, order);
  tree.depth = measure_depth(nodes);
  tree.nodes = std::move(nodes);
  tree.order = std::move(order);
  return tree;
}

}  // namespace detail

/// Builds the box tree of a mesh (Wiseman & Grinberg 2016, sections 2 and 3). The same mesh and
/// options give the same tree, bit for bit, on every machine. Cost: O(n log n) for all rules but
/// `paper`, whose work is O(n · depth) with a fixed upper limit. No recursion: depth costs heap.
/// Errors: usage for a leaf size outside 1 to 255 or a number of threads outside 1 to 256;
/// bad_input for a mesh without triangles, a vertex index out of range, a coordinate that is not
/// finite (of any vertex, used or not), or coordinates too large to be turned into the Gaussian
/// frame; limit_exceeded above `max_triangles`; out_of_memory. Safe from any thread.
inline Result<AabbTree> build_tree(const TriangleMesh& mesh, const BuildOptions& options = {}) {
  return detail::guarded([&] { return detail::build_tree_or_throw(mesh, options); });
}

}  // namespace crashrank

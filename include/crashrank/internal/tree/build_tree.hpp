#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/internal/base/guarded.hpp"
#include "crashrank/internal/tree/build_records.hpp"
#include "crashrank/internal/tree/gaussian_frame.hpp"
#include "crashrank/internal/tree/greedy_build.hpp"
#include "crashrank/internal/tree/literal_split.hpp"
#include "crashrank/internal/tree/parallel_build.hpp"
#include "crashrank/internal/tree/reinsertion.hpp"
#include "crashrank/internal/tree/split_cost.hpp"
#include "crashrank/internal/tree/tree_writer.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

namespace crashrank::detail {

inline constexpr std::uint32_t max_leaf_size = 255;
inline constexpr std::uint32_t max_build_threads = 256;

/// Corners by slot. Filled slot by slot where a tree is built on several threads, each run of slots
/// by the thread that has just made its leaves.
class SlotTriangles {
public:
  SlotTriangles(const TriangleMesh& mesh, View<const std::uint32_t> order)
      : mesh_(mesh), order_(order) {}

  /// Makes the room; the first call does, the others wait for it.
  void prepare() {
    std::call_once(prepared_, [this] { triangles_.resize(order_.size()); });
  }
  void fill(std::size_t first, std::size_t last) {
    prepare();
    for (std::size_t i = first; i < last; ++i) triangles_[i] = mesh_.triangle(order_[i]);
  }
  std::vector<Triangle> take() { return std::move(triangles_); }

private:
  const TriangleMesh& mesh_;
  View<const std::uint32_t> order_;
  std::once_flag prepared_;
  std::vector<Triangle> triangles_;
};

/// The builders below write nodes and `arrays.order`, fill `slots`, and return the depth.
template <class Rule>
std::uint32_t build_by_cost(const BuildArrays& arrays, const BuildOptions& options,
                            std::uint32_t threads, std::vector<Node>& nodes, SlotTriangles& slots) {
  const LeafLimits leaves{options.leaf_size, options.fill_leaves};
  const Box root = to_box(bounds(arrays.records[0]));
  if (threads > 1) return ParallelBuilder<Rule>(arrays, leaves).build(root, threads, nodes, slots);
  nodes.reserve(arrays.order.size());
  TreeWriter writer(nodes);
  writer.open_root(root, 0, static_cast<std::uint32_t>(arrays.order.size()), 0);
  GreedyBuilder<Rule>(arrays, leaves).build(writer);
  slots.fill(0, arrays.order.size());
  return writer.deepest();
}

inline std::uint32_t build_nodes(const BuildArrays& arrays, const BuildOptions& options,
                                 std::uint32_t threads, std::vector<Node>& nodes,
                                 SlotTriangles& slots) {
  if (options.rule == SplitRule::min_relative_segment) {
    return build_by_cost<RelativeSegmentRule>(arrays, options, threads, nodes, slots);
  }
  if (options.rule == SplitRule::sah) {
    return build_by_cost<SurfaceAreaRule>(arrays, options, threads, nodes, slots);
  }
  const View<BuildRecord> records = arrays.records[0];
  nodes.reserve(records.size());
  TreeWriter writer(nodes);
  writer.open_root(to_box(bounds(records)), 0, static_cast<std::uint32_t>(records.size()), 0);
  if (options.rule == SplitRule::paper) {
    LiteralBuilder(records).build(writer, records, literal_work_limit);
  } else {
    build_by_median(writer, records, options.leaf_size);
  }
  for (std::size_t i = 0; i < records.size(); ++i) arrays.order[i] = records[i].index;
  for (const Node& node : nodes) {
    if (node.is_leaf()) sort_leaf(arrays.order.data() + node.first, node.count);
  }
  slots.fill(0, records.size());
  return writer.deepest();
}

/// Refuses meshes no tree can be built over and writes the records of the others.
inline Status write_records(const TriangleMesh& mesh, const AabbTree& tree, std::uint32_t threads,
                            View<BuildRecord> records) {
  const std::size_t triangles = mesh.triangles.size();
  const std::size_t vertices = mesh.vertices.size();
  std::atomic<bool> sound{true};
  on_slices(triangles, threads, [&](std::size_t first, std::size_t last) {
    if (!check_part(mesh, first, last, first * vertices / triangles, last * vertices / triangles)) {
      sound = false;
    } else if (tree.axes_are_world) {
      write_world_records(mesh, first, last, records);
    }
  });
  if (!sound) return check_part(mesh, 0, triangles, 0, vertices);
  return tree.axes_are_world ? Status{Success{}}
                             : write_projected_records(mesh, tree.axes, records);
}

inline Result<AabbTree> build_tree_or_throw(const TriangleMesh& mesh, const BuildOptions& options) {
  if (options.leaf_size < 1 || options.leaf_size > max_leaf_size) {
    return make_error(ErrorCode::usage, "a leaf holds 1 to 255 triangles",
                      "choose a leaf size in that range");
  }
  if (options.threads < 1 || options.threads > max_build_threads) {
    return make_error(ErrorCode::usage, "a tree is built on 1 to 256 threads");
  }
  if (Status status = check_size(mesh); !status) return status.error();
  const std::size_t size = mesh.triangles.size();
  const std::uint32_t threads = size < min_parallel_triangles ? 1 : options.threads;
  AabbTree tree;
  if (options.frame == BoxFrame::gaussian) {
    if (Status status = check_part(mesh, 0, size, 0, mesh.vertices.size()); !status) {
      return status.error();
    }
    tree.axes = gaussian_axes(mesh);
    tree.axes_are_world = tree.axes == Eigen::Matrix3d::Identity();
  }
  const bool by_cost =
      options.rule == SplitRule::min_relative_segment || options.rule == SplitRule::sah;
  std::vector<std::uint32_t> order(size);
  std::vector<Node> nodes;
  SlotTriangles slots(mesh, order);
  {
    const RawArray<BuildRecord> records(by_cost ? 2 * size : size);
    BuildArrays arrays{{{records.data(), size}, {}}, order};
    if (by_cost) arrays.records[1] = {records.data() + size, size};
    if (Status status = write_records(mesh, tree, threads, arrays.records[0]); !status) {
      return status.error();
    }
    tree.depth = build_nodes(arrays, options, threads, nodes, slots);
  }
  if (options.reinsertion_passes > 0) {
    Reinsertion reinsertion(nodes);
    for (std::uint32_t i = 0; i < options.reinsertion_passes && reinsertion.pass() > 0; ++i) {
    }
    reinsertion.write(nodes, order);
    tree.depth = measure_depth(nodes);
    slots.fill(0, size);
  }
  tree.triangles = slots.take();
  tree.nodes = std::move(nodes);
  tree.order = std::move(order);
  return tree;
}

}  // namespace crashrank::detail

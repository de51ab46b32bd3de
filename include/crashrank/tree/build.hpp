#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/tree/aabb_tree.hpp"
#include "crashrank/tree/build_records.hpp"
#include "crashrank/tree/gaussian_frame.hpp"
#include "crashrank/tree/greedy_build.hpp"
#include "crashrank/tree/literal_split.hpp"
#include "crashrank/tree/reinsertion.hpp"
#include "crashrank/tree/split_cost.hpp"
#include "crashrank/tree/tree_writer.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace crashrank {

struct BuildOptions {
  SplitRule rule = SplitRule::min_relative_segment;
  BoxFrame frame = BoxFrame::world;
  std::uint32_t leaf_size = 4;  ///< most triangles a leaf may hold, 1 to 255; `paper` means 1
  /// Split no set that fits into a leaf. Otherwise min_relative_segment and sah make smaller leaves
  /// where that is expected to save tests: fewer triangle pairs tested for more nodes.
  bool fill_leaves = false;
  /// After the build, whatever its rule, subtrees are moved to where the boxes above them come out
  /// smaller; at most this many passes over the tree, fewer when nothing moves any more. Worth its
  /// time (see bench/tree_bench) for a model that is built once and queried often.
  std::uint32_t reinsertion_passes = 0;
};

namespace detail {

inline constexpr std::uint32_t max_leaf_size = 255;

}  // namespace detail

/// Builds the box tree of a mesh (Wiseman & Grinberg 2016, sections 2 and 3). The same mesh and
/// options give the same tree, bit for bit, on every machine. Cost: O(n log n) for all rules but
/// `paper`, whose work is O(n · depth) with a fixed upper limit. No recursion: depth costs heap.
/// Errors: usage for a leaf size outside 1 to 255; bad_input for a mesh without triangles, a vertex
/// index out of range, a coordinate that is not finite (of any vertex, used or not), or coordinates
/// too large to be turned into the Gaussian frame; limit_exceeded above `max_triangles`. Safe from
/// any thread; throws only std::bad_alloc.
inline Result<AabbTree> build_tree(const TriangleMesh& mesh, const BuildOptions& options = {}) {
  if (options.leaf_size < 1 || options.leaf_size > detail::max_leaf_size) {
    return make_error(ErrorCode::usage, "a leaf holds 1 to 255 triangles",
                      "choose a leaf size in that range");
  }
  if (Status status = detail::check_mesh(mesh); !status) return status.error();
  AabbTree tree;
  std::vector<detail::BuildRecord> records;
  if (options.frame == BoxFrame::gaussian) {
    tree.axes = gaussian_axes(mesh);
    tree.axes_are_world = tree.axes == Eigen::Matrix3d::Identity();
  }
  if (tree.axes_are_world) {
    records = detail::world_records(mesh);
  } else {
    Result<std::vector<detail::BuildRecord>> projected = detail::projected_records(mesh, tree.axes);
    if (!projected) return projected.error();
    records = std::move(*projected);
  }

  const auto count = static_cast<std::uint32_t>(records.size());
  tree.nodes.reserve(count);
  detail::TreeWriter writer(tree.nodes);
  writer.open_root(detail::to_box(detail::bounds(records)), 0, count, 0);
  const detail::LeafLimits leaves{options.leaf_size, options.fill_leaves};
  std::vector<detail::BuildRecord> scratch;
  switch (options.rule) {
    case SplitRule::min_relative_segment:
      scratch.resize(records.size());
      detail::build_greedily<detail::RelativeSegmentRule>(writer, records, scratch, leaves);
      break;
    case SplitRule::sah:
      scratch.resize(records.size());
      detail::build_greedily<detail::SurfaceAreaRule>(writer, records, scratch, leaves);
      break;
    case SplitRule::median:
      detail::build_by_median(writer, records, options.leaf_size);
      break;
    case SplitRule::paper:
      detail::LiteralBuilder(records).build(writer, records, detail::literal_work_limit);
      break;
  }

  tree.order.resize(records.size());
  for (std::size_t i = 0; i < records.size(); ++i) tree.order[i] = records[i].index;
  if (options.reinsertion_passes > 0) {
    detail::Reinsertion reinsertion(tree.nodes);
    for (std::uint32_t i = 0; i < options.reinsertion_passes && reinsertion.pass() > 0; ++i) {
    }
    reinsertion.write(tree.nodes, tree.order);
  }
  tree.depth = measure_depth(tree.nodes);
  for (const Node& node : tree.nodes) {
    const auto first = tree.order.begin() + node.first;
    if (node.is_leaf()) std::sort(first, first + node.count);
  }
  tree.triangles.resize(records.size());
  for (std::size_t i = 0; i < records.size(); ++i) tree.triangles[i] = mesh.triangle(tree.order[i]);
  return tree;
}

}  // namespace crashrank

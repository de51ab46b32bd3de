#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/tree/aabb_tree.hpp"
#include "crashrank/tree/binned_split.hpp"
#include "crashrank/tree/build_records.hpp"
#include "crashrank/tree/gaussian_frame.hpp"
#include "crashrank/tree/literal_split.hpp"
#include "crashrank/tree/median_split.hpp"
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
};

namespace detail {

/// Beyond this depth every rule but the literal one splits at the median, so that no mesh makes a
/// tree deeper than this plus 31 levels.
inline constexpr std::uint32_t balanced_depth = 64;

inline constexpr std::uint32_t max_leaf_size = 255;

template <class Rule>
void build_binned(TreeWriter& writer, std::vector<BuildRecord>& records, const Rule& rule,
                  std::uint32_t leaf_size) {
  constexpr int bins = 16;
  BinnedSplitter<Rule> splitter;
  std::vector<BuildRecord> scratch(records.size());
  OpenNode open{};
  while (writer.next(open)) {
    if (open.count <= leaf_size) {
      writer.leaf(open);
      continue;
    }
    const View<BuildRecord> all(records.data() + open.first, open.count);
    const Box box = writer.box(open);
    BinnedCut cut;
    if (open.depth < balanced_depth) cut = splitter.find(all, box, rule, bins);
    if (cut.axis >= 0) {
      splitter.partition(all, cut, scratch);
      writer.split(open, cut.left_count, cut.left, cut.right);
    } else {
      const std::size_t half = median_split(all, longest_axis(box));
      writer.split(open, static_cast<std::uint32_t>(half), bounds({all.data(), half}),
                   bounds({all.data() + half, all.size() - half}));
    }
  }
}

inline void build_median(TreeWriter& writer, std::vector<BuildRecord>& records,
                         std::uint32_t leaf_size) {
  OpenNode open{};
  while (writer.next(open)) {
    if (open.count <= leaf_size) {
      writer.leaf(open);
      continue;
    }
    const View<BuildRecord> all(records.data() + open.first, open.count);
    const std::size_t half = median_split(all, longest_axis(writer.box(open)));
    writer.split(open, static_cast<std::uint32_t>(half), bounds({all.data(), half}),
                 bounds({all.data() + half, all.size() - half}));
  }
}

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
  detail::TreeWriter writer(tree.nodes);
  writer.open_root(detail::bounds(records), 0, count, 0);
  switch (options.rule) {
    case SplitRule::min_relative_segment:
      detail::build_binned(writer, records, detail::RelativeSegmentCost{}, options.leaf_size);
      break;
    case SplitRule::sah:
      detail::build_binned(writer, records, detail::SurfaceAreaCost{}, options.leaf_size);
      break;
    case SplitRule::median:
      detail::build_median(writer, records, options.leaf_size);
      break;
    case SplitRule::paper:
      detail::LiteralBuilder(records).build(writer, records, detail::literal_work_limit);
      break;
  }

  tree.depth = measure_depth(tree.nodes);
  tree.order.resize(records.size());
  for (std::size_t i = 0; i < records.size(); ++i) tree.order[i] = records[i].index;
  for (const Node& node : tree.nodes) {
    const auto first = tree.order.begin() + node.first;
    if (node.is_leaf()) std::sort(first, first + node.count);
  }
  tree.triangles.resize(records.size());
  for (std::size_t i = 0; i < records.size(); ++i) tree.triangles[i] = mesh.triangle(tree.order[i]);
  return tree;
}

}  // namespace crashrank

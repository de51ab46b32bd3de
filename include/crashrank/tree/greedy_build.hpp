#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/tree/binned_split.hpp"
#include "crashrank/tree/build_records.hpp"
#include "crashrank/tree/median_split.hpp"
#include "crashrank/tree/small_split.hpp"
#include "crashrank/tree/tree_writer.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// Beyond this depth every rule but the literal one splits at the median, so that no mesh makes a
/// tree deeper than this plus 31 levels.
inline constexpr std::uint32_t balanced_depth = 64;

/// When a set that fits into a leaf becomes one.
struct LeafLimits {
  std::uint32_t size = 4;  ///< most triangles
  bool fill = false;       ///< always, even where splitting it further would pay
};

/// Whether two leaves are expected to cost less than one. A leaf of n triangles that meets a leaf
/// of m costs n·m primitive tests; its halves cost two box tests more and m tests for each triangle
/// in a half that is met. Both kinds of test count alike, as they nearly do (16 to 19 ns a triangle
/// pair and 8 to 10 ns a box pair in scalar code), and m is taken as 2, which is what leaves come
/// to on car bodies. `whole` is the size of the undivided box.
inline bool worth_splitting(const Cut& cut, std::uint32_t count, float whole) {
  constexpr float met = 2.0F;
  return met * cut.cost + 2.0F * whole < met * static_cast<float>(count) * whole;
}

inline void split_at_median(TreeWriter& writer, const OpenNode& open, View<BuildRecord> records) {
  const std::size_t half = median_split(records, longest_axis(writer.box(open)));
  writer.split(open, static_cast<std::uint32_t>(half), to_box(bounds({records.data(), half})),
               to_box(bounds({records.data() + half, records.size() - half})));
}

/// Decides open nodes, each cut the cheapest by `Rule` at that node. Looks at and moves the node's
/// own records only. `scratch` has room for all records.
template <class Rule> class GreedyBuilder {
public:
  GreedyBuilder(View<BuildRecord> records, View<BuildRecord> scratch, const LeafLimits& leaves)
      : records_(records), scratch_(scratch), leaves_(leaves) {}

  /// Decides one open node: a leaf, or two more that are open.
  void decide(TreeWriter& writer, const OpenNode& open) {
    if (open.count == 1 || (leaves_.fill && open.count <= leaves_.size)) return writer.leaf(open);
    const View<BuildRecord> here(records_.data() + open.first, open.count);
    const LaneBox whole = to_lanes(writer.box(open));
    const Rule rule(whole);
    const bool few = open.count <= SmallSplitter<Rule>::max_records;
    Cut cut;
    if (open.depth < balanced_depth) cut = few ? small_.find(here, rule) : binned_.find(here, rule);
    const bool fits = open.count <= leaves_.size;
    if (fits && (cut.axis < 0 || !worth_splitting(cut, open.count, rule.size(whole)))) {
      return writer.leaf(open);
    }
    if (cut.axis < 0) return split_at_median(writer, open, here);
    if (few) {
      small_.partition(here, cut);
    } else {
      binned_.partition(here, cut, {scratch_.data() + open.first, open.count});
    }
    writer.split(open, cut.left_count, to_box(cut.left), to_box(cut.right));
  }

  /// Decides all that is open, top down.
  void build(TreeWriter& writer) {
    OpenNode open{};
    while (writer.next(open)) decide(writer, open);
  }

private:
  View<BuildRecord> records_;
  View<BuildRecord> scratch_;
  LeafLimits leaves_;
  BinnedSplitter<Rule> binned_;
  SmallSplitter<Rule> small_;
};

inline void build_by_median(TreeWriter& writer, View<BuildRecord> records,
                            std::uint32_t leaf_size) {
  OpenNode open{};
  while (writer.next(open)) {
    if (open.count <= leaf_size) {
      writer.leaf(open);
    } else {
      split_at_median(writer, open, {records.data() + open.first, open.count});
    }
  }
}

}  // namespace crashrank::detail

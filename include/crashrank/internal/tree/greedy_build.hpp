#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/internal/tree/binned_split.hpp"
#include "crashrank/internal/tree/build_records.hpp"
#include "crashrank/internal/tree/median_split.hpp"
#include "crashrank/internal/tree/small_split.hpp"
#include "crashrank/internal/tree/tree_writer.hpp"

#include <cstddef>
#include <cstdint>

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
               to_box(bounds({records.data() + half, records.size() - half})), open.buffer);
}

/// Puts the triangles of a leaf into the order of their indices. Few: each is moved to its place.
inline void sort_leaf(std::uint32_t* order, std::uint32_t count) {
  for (std::uint32_t i = 1; i < count; ++i) {
    const std::uint32_t index = order[i];
    std::uint32_t at = i;
    for (; at > 0 && order[at - 1] > index; --at) order[at] = order[at - 1];
    order[at] = index;
  }
}

/// What a greedy builder works on. Records lie in the first array to begin with, and a node's go
/// over to the other one where it is cut: each is written once and not twice.
struct BuildArrays {
  View<BuildRecord> records[2];
  View<std::uint32_t> order;  ///< slot to triangle, written where leaves are made
};

/// Decides open nodes, each cut the cheapest by `Rule` at that node. Looks at and moves the node's
/// own records only.
template <class Rule> class GreedyBuilder {
public:
  GreedyBuilder(const BuildArrays& arrays, const LeafLimits& leaves)
      : arrays_(arrays), leaves_(leaves) {}

  /// Decides one open node: a leaf, or two more that are open.
  void decide(TreeWriter& writer, const OpenNode& open) {
    const View<BuildRecord> here(arrays_.records[open.buffer].data() + open.first, open.count);
    if (open.count == 1 || (leaves_.fill && open.count <= leaves_.size)) {
      return leaf(writer, open, here);
    }
    const LaneBox whole = to_lanes(writer.box(open));
    const Rule rule(whole);
    const bool few = open.count <= SmallSplitter<Rule>::max_records;
    Cut cut;
    if (open.depth < balanced_depth) cut = few ? small_.find(here, rule) : binned_.find(here, rule);
    const bool fits = open.count <= leaves_.size;
    if (fits && (cut.axis < 0 || !worth_splitting(cut, open.count, size_of(rule, whole)))) {
      return leaf(writer, open, here);
    }
    if (cut.axis < 0) return split_at_median(writer, open, here);
    std::uint32_t buffer = open.buffer;
    if (few) {
      small_.partition(here, cut);
    } else {
      buffer = 1 - buffer;
      binned_.partition(here, cut, {arrays_.records[buffer].data() + open.first, open.count});
    }
    writer.split(open, cut.left_count, to_box(cut.left), to_box(cut.right), buffer);
  }

  /// Decides all that is open, top down.
  void build(TreeWriter& writer) {
    OpenNode open{};
    while (writer.next(open)) decide(writer, open);
  }

private:
  void leaf(TreeWriter& writer, const OpenNode& open, View<const BuildRecord> here) {
    std::uint32_t* const order = arrays_.order.data() + open.first;
    for (std::uint32_t i = 0; i < open.count; ++i) order[i] = here[i].index;
    sort_leaf(order, open.count);
    writer.leaf(open);
  }

  BuildArrays arrays_;
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

#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/internal/tree/build_records.hpp"
#include "crashrank/internal/tree/median_split.hpp"
#include "crashrank/internal/tree/tree_writer.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace crashrank::detail {

/// A triangle as one axis sees it.
struct AxisEntry {
  float min;
  float max;
  std::uint32_t index;
};

/// A split on one axis: the first `index` triangles by maximal vertex form the first sub-mesh.
struct LiteralCut {
  int axis = -1;  ///< -1: every axis has length zero
  std::size_t index = 0;
  double relative_sum = std::numeric_limits<double>::infinity();
};

/// The split algorithm of Wiseman & Grinberg 2016, section 3, on one axis: over all split indices
/// 1 to n−1 the least sum of relative segments, the first of equals. `entries` are sorted by their
/// maximum; `suffix_min` has room for as many. `best` is replaced only by something less. The sums
/// are compared before the division by the whole length, which is common to all of an axis. O(n).
inline void consider_axis(int axis, View<const AxisEntry> entries, View<float> suffix_min,
                          LiteralCut& best) {
  const std::size_t n = entries.size();
  float lowest = std::numeric_limits<float>::infinity();
  for (std::size_t i = n; i-- > 0;) {
    lowest = std::min(lowest, entries[i].min);
    suffix_min[i] = lowest;
  }
  const double highest = entries[n - 1].max;
  const double length = highest - lowest;
  if (!(length > 0.0)) return;
  double least = std::numeric_limits<double>::infinity();
  std::size_t least_index = 0;
  float prefix_min = std::numeric_limits<float>::infinity();
  for (std::size_t i = 1; i < n; ++i) {
    prefix_min = std::min(prefix_min, entries[i - 1].min);
    const double first = static_cast<double>(entries[i - 1].max) - static_cast<double>(prefix_min);
    const double second = highest - static_cast<double>(suffix_min[i]);
    if (first + second < least) {
      least = first + second;
      least_index = i;
    }
  }
  if (least / length < best.relative_sum) best = {axis, least_index, least / length};
}

/// How many triangles the literal rule may look at, node by node, before what is left is split by
/// the median. The rule peels single triangles off meshes without gaps, so that its work grows as
/// n²; this many take some seconds. Meshes up to 46,000 triangles can never reach it.
inline constexpr std::uint64_t literal_work_limit = std::uint64_t{1} << 30;

/// Builds by the literal rule: triangles are sorted once an axis and the sorted lists partitioned
/// after, so a node costs O(its triangles) and a tree O(n log n + n · depth), bounded by the limit.
class LiteralBuilder {
public:
  explicit LiteralBuilder(View<const BuildRecord> records)
      : suffix_min_(records.size()), goes_left_(records.size()), scratch_(records.size()) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::vector<AxisEntry>& entries = entries_[axis];
      entries.reserve(records.size());
      for (const BuildRecord& record : records) {
        entries.push_back({record.min[axis], record.max[axis], record.index});
      }
      std::sort(entries.begin(), entries.end(), [](const AxisEntry& a, const AxisEntry& b) {
        return a.max != b.max ? a.max < b.max : a.index < b.index;
      });
    }
  }

  /// Builds what is open; `records` are by triangle index when it begins and by slot when it ends.
  void build(TreeWriter& writer, View<BuildRecord> records, std::uint64_t work_limit) {
    const std::vector<BuildRecord> by_index(records.begin(), records.end());
    std::uint64_t work = 0;
    OpenNode open{};
    while (writer.next(open)) {
      if (open.count == 1 || work >= work_limit) {
        for (std::uint32_t i = open.first; i < open.first + open.count; ++i) {
          records[i] = by_index[entries_[0][i].index];
        }
        if (open.count == 1) {
          writer.leaf(open);
        } else {
          build_median(writer, open, records);
        }
        continue;
      }
      work += open.count;
      LiteralCut cut;
      for (int axis = 0; axis < 3; ++axis) {
        consider_axis(axis, range(axis, open.first, open.count), {suffix_min_.data(), open.count},
                      cut);
      }
      if (cut.axis < 0) cut = {0, open.count / 2, 0.0};
      partition(open, cut);
      const auto left_count = static_cast<std::uint32_t>(cut.index);
      writer.split(open, left_count, box(open.first, left_count),
                   box(open.first + left_count, open.count - left_count));
    }
  }

private:
  View<AxisEntry> range(int axis, std::size_t first, std::size_t count) {
    return {entries_[static_cast<std::size_t>(axis)].data() + first, count};
  }

  Box box(std::size_t first, std::size_t count) {
    Box result;
    for (int axis = 0; axis < 3; ++axis) {
      const View<AxisEntry> entries = range(axis, first, count);
      for (const AxisEntry& entry : entries) {
        result.min[axis] = std::min(result.min[axis], entry.min);
      }
      result.max[axis] = entries[count - 1].max;
    }
    return result;
  }

  void partition(const OpenNode& open, const LiteralCut& cut) {
    const View<AxisEntry> sorted = range(cut.axis, open.first, open.count);
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      goes_left_[sorted[i].index] = i < cut.index ? 1 : 0;
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (axis == cut.axis) continue;
      const View<AxisEntry> entries = range(axis, open.first, open.count);
      std::size_t left = 0;
      std::size_t right = 0;
      for (std::size_t i = 0; i < entries.size(); ++i) {
        const AxisEntry entry = entries[i];
        const std::size_t goes_left = goes_left_[entry.index];
        entries[left] = entry;
        scratch_[right] = entry;
        left += goes_left;
        right += 1 - goes_left;
      }
      std::copy_n(scratch_.begin(), right, entries.begin() + left);
    }
  }

  static void build_median(TreeWriter& writer, const OpenNode& from, View<BuildRecord> records) {
    writer.descend(from, [&records](TreeWriter& inner, const OpenNode& open) {
      if (open.count == 1) return inner.leaf(open);
      const View<BuildRecord> all(records.data() + open.first, open.count);
      const std::size_t half = median_split(all, longest_axis(inner.box(open)));
      inner.split(open, static_cast<std::uint32_t>(half), to_box(bounds({all.data(), half})),
                  to_box(bounds({all.data() + half, all.size() - half})));
    });
  }

  std::array<std::vector<AxisEntry>, 3> entries_;
  std::vector<float> suffix_min_;
  std::vector<std::uint8_t> goes_left_;  ///< by triangle index
  std::vector<AxisEntry> scratch_;
};

}  // namespace crashrank::detail

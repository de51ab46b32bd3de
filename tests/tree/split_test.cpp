// The searches for a cut, which work on four places at a time, against one place at a time.

#include "crashrank/internal/tree/binned_split.hpp"
#include "crashrank/internal/tree/lanes.hpp"
#include "crashrank/internal/tree/small_split.hpp"
#include "crashrank/internal/tree/split_cost.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace crashrank {
namespace {

using detail::BuildRecord;

struct PlainCut {
  int axis = -1;
  std::size_t left_count = 0;
  float cost = std::numeric_limits<float>::infinity();
};

float middle(const BuildRecord& record, int axis) { return record.min[axis] + record.max[axis]; }

Box box_of(const std::vector<BuildRecord>& records, std::size_t first, std::size_t last) {
  Box box;
  for (std::size_t i = first; i < last; ++i) {
    const BuildRecord& r = records[i];
    box.grow(Box{{r.min[0], r.min[1], r.min[2]}, {r.max[0], r.max[1], r.max[2]}});
  }
  return box;
}

float plain_size(const detail::RelativeSegmentRule& /*rule*/, const Box& whole, const Box& half) {
  const Eigen::Vector3f w = whole.extent();
  const Eigen::Vector3f e = half.extent();
  const float per_mean = 3.0F / (w[0] + w[1] + w[2]);
  std::array<float, 3> s{};
  for (int k = 0; k < 3; ++k) s[static_cast<std::size_t>(k)] = e[k] * per_mean + 0.3125F;
  return s[0] * s[1] * s[2];
}

float plain_size(const detail::SurfaceAreaRule& /*rule*/, const Box& /*whole*/, const Box& half) {
  return half_area(half);
}

template <class Rule>
void try_cut(const Rule& rule, const std::vector<BuildRecord>& sorted, int axis,
             std::size_t left_count, PlainCut& best) {
  const Box whole = box_of(sorted, 0, sorted.size());
  const float left = plain_size(rule, whole, box_of(sorted, 0, left_count));
  const float right = plain_size(rule, whole, box_of(sorted, left_count, sorted.size()));
  const float cost = static_cast<float>(left_count) * left +
                     static_cast<float>(sorted.size() - left_count) * right;
  if (cost < best.cost) best = {axis, left_count, cost};
}

// Coordinates on a coarse grid, so that many middles are equal.
std::vector<BuildRecord> some_records(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<BuildRecord> records(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (int k = 0; k < 3; ++k) {
      records[i].min[k] = static_cast<float>(random() % 8) * 0.37F - 1.0F;
      records[i].max[k] = records[i].min[k] + static_cast<float>(random() % 4) * 0.21F;
    }
    records[i].index = static_cast<std::uint32_t>(i);
    records[i].unused = 0;
  }
  return records;
}

template <class Rule> Rule rule_for(const std::vector<BuildRecord>& records) {
  return Rule(detail::to_lanes(box_of(records, 0, records.size())));
}

void expect_boxes(const detail::Cut& cut, const std::vector<BuildRecord>& records) {
  const auto same = [](const detail::LaneBox& found, const Box& expected) {
    const Box box = detail::to_box(found);
    return box.min == expected.min && box.max == expected.max;
  };
  EXPECT_TRUE(same(cut.left, box_of(records, 0, cut.left_count)));
  EXPECT_TRUE(same(cut.right, box_of(records, cut.left_count, records.size())));
}

template <class Rule> void expect_least_of_small_sets() {
  detail::SmallSplitter<Rule> splitter;
  for (std::size_t count = 2; count <= detail::SmallSplitter<Rule>::max_records; ++count) {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
      SCOPED_TRACE(std::to_string(count) + " records, seed " + std::to_string(seed));
      std::vector<BuildRecord> records = some_records(count, seed);
      const Rule rule = rule_for<Rule>(records);
      PlainCut best;
      for (int axis = 0; axis < (count == 2 ? 1 : 3); ++axis) {
        std::vector<BuildRecord> sorted = records;
        if (count > 2) {
          std::stable_sort(sorted.begin(), sorted.end(),
                           [axis](const BuildRecord& a, const BuildRecord& b) {
                             return middle(a, axis) < middle(b, axis);
                           });
        }
        for (std::size_t left = 1; left < count; ++left) try_cut(rule, sorted, axis, left, best);
      }
      const detail::Cut cut = splitter.find(records, rule);
      ASSERT_EQ(cut.axis, best.axis);
      if (best.axis < 0) continue;
      EXPECT_EQ(cut.left_count, best.left_count);
      EXPECT_EQ(cut.cost, best.cost);
      splitter.partition(records, cut);
      expect_boxes(cut, records);
    }
  }
}

TEST(Split, SmallSetsAreCutWhereItCostsLeast) {
  expect_least_of_small_sets<detail::RelativeSegmentRule>();
  expect_least_of_small_sets<detail::SurfaceAreaRule>();
}

template <class Rule> void expect_least_of_bins() {
  detail::BinnedSplitter<Rule> splitter;
  for (const std::size_t count : {17U, 40U, 63U, 64U, 65U, 200U, 333U}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      SCOPED_TRACE(std::to_string(count) + " records, seed " + std::to_string(seed));
      const std::vector<BuildRecord> records = some_records(count, seed);
      const Rule rule = rule_for<Rule>(records);
      PlainCut best;
      for (int axis = 0; axis < 3; ++axis) {
        float low = middle(records[0], axis);
        float high = low;
        for (const BuildRecord& record : records) {
          low = std::min(low, middle(record, axis));
          high = std::max(high, middle(record, axis));
        }
        const float scale = 16.0F * 0.999999F / (high - low);
        for (int bin = 0; bin < 15; ++bin) {
          std::vector<BuildRecord> sorted = records;
          const auto right =
              std::stable_partition(sorted.begin(), sorted.end(), [&](const BuildRecord& record) {
                return static_cast<int>((middle(record, axis) - low) * scale) <= bin;
              });
          const auto left_count = static_cast<std::size_t>(right - sorted.begin());
          if (left_count > 0 && left_count < count) try_cut(rule, sorted, axis, left_count, best);
        }
      }
      const detail::Cut cut = splitter.find(records, rule);
      ASSERT_EQ(cut.axis, best.axis);
      EXPECT_EQ(cut.left_count, best.left_count);
      EXPECT_EQ(cut.cost, best.cost);
      std::vector<BuildRecord> parted(count);
      splitter.partition(records, cut, parted);
      expect_boxes(cut, parted);
      // Each side in the order it had.
      for (std::size_t i = 1; i < count; ++i) {
        EXPECT_TRUE(i == cut.left_count || parted[i - 1].index < parted[i].index);
      }
    }
  }
}

TEST(Split, LargeSetsAreCutWhereItCostsLeast) {
  expect_least_of_bins<detail::RelativeSegmentRule>();
  expect_least_of_bins<detail::SurfaceAreaRule>();
}

}  // namespace
}  // namespace crashrank

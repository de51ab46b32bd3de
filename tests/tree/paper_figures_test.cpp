// The figures of Wiseman & Grinberg 2016, rebuilt from what the text says about them.

#include "crashrank/internal/tree/literal_split.hpp"
#include "crashrank/tree/build.hpp"
#include "tree/sample_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

namespace crashrank {
namespace {

// Triangles below a node, by mesh index.
std::set<std::uint32_t> triangles_below(const AabbTree& tree, std::uint32_t node) {
  const Range slots = slots_below(tree, node);
  std::set<std::uint32_t> found;
  for (std::uint32_t i = 0; i < slots.count; ++i) found.insert(tree.order[slots.first + i]);
  return found;
}

// A triangle whose projection on x is [from, to].
void add_over(TriangleMesh& mesh, float from, float to, float y) {
  test::add_triangle(mesh, {from, y, 0}, {to, y, 0}, {from, y + 1, 0});
}

// Figure 3: four triangles, two beside two; on the left the neighbours form a sub-mesh, on the
// right each sub-mesh reaches across and its box is larger.
TEST(PaperFigures, BothRulesTakeTheLeftSplitOfFigure3) {
  TriangleMesh mesh;
  add_over(mesh, 0, 1, 0);
  add_over(mesh, 4, 5, 0);
  add_over(mesh, 0, 1, 0.9F);
  add_over(mesh, 4, 5, 0.9F);
  for (const SplitRule rule : {SplitRule::paper, SplitRule::min_relative_segment}) {
    BuildOptions options;
    options.rule = rule;
    options.leaf_size = 1;
    const Result<AabbTree> tree = build_tree(mesh, options);
    ASSERT_TRUE(tree.ok());
    EXPECT_EQ(triangles_below(*tree, 1), (std::set<std::uint32_t>{0, 2}));
    EXPECT_EQ(triangles_below(*tree, 2), (std::set<std::uint32_t>{1, 3}));
  }
}

// Figures 4 and 5: triangles in order along the axis; split index 4 leaves sub-meshes that overlap
// further than those of index 2, so the algorithm selects 2.
class Figure5 : public testing::Test {
protected:
  const std::vector<detail::AxisEntry> entries_{{0.0F, 1.0F, 0}, {1.0F, 2.0F, 1}, {2.1F, 4.0F, 2},
                                                {2.2F, 4.2F, 3}, {2.5F, 5.0F, 4}, {3.0F, 6.0F, 5}};

  // How far the two projections of a split overlap, straight from the definition.
  double overlap(std::size_t index) const {
    double first_end = -INFINITY;
    double second_begin = INFINITY;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      if (i < index) {
        first_end = std::max(first_end, static_cast<double>(entries_[i].max));
      } else {
        second_begin = std::min(second_begin, static_cast<double>(entries_[i].min));
      }
    }
    return first_end - second_begin;
  }
};

TEST_F(Figure5, TheLiteralRuleSelectsIndex2) {
  ASSERT_GT(overlap(4), overlap(2));
  std::vector<float> room(entries_.size());
  detail::LiteralCut cut;
  detail::consider_axis(0, entries_, room, cut);
  EXPECT_EQ(cut.axis, 0);
  EXPECT_EQ(cut.index, 2U);
  EXPECT_NEAR(cut.relative_sum, (2.0 + (6.0 - 2.1)) / 6.0, 1e-6);
}

TEST_F(Figure5, TheTreeIsCutThere) {
  TriangleMesh mesh;
  for (const detail::AxisEntry& entry : entries_) add_over(mesh, entry.min, entry.max, 0);
  BuildOptions options;
  options.rule = SplitRule::paper;
  const Result<AabbTree> tree = build_tree(mesh, options);
  ASSERT_TRUE(tree.ok());
  EXPECT_EQ(triangles_below(*tree, 1), (std::set<std::uint32_t>{0, 1}));
}

TEST(LiteralSplit, TakesTheFirstOfEqualSumsOnTheFirstAxis) {
  const std::vector<detail::AxisEntry> even{{0, 1, 0}, {1, 2, 1}, {2, 3, 2}, {3, 4, 3}};
  std::vector<float> room(even.size());
  detail::LiteralCut cut;
  detail::consider_axis(1, even, room, cut);
  detail::consider_axis(2, even, room, cut);
  EXPECT_EQ(cut.axis, 1);
  EXPECT_EQ(cut.index, 1U);
}

TEST(LiteralSplit, SkipsAnAxisWithoutLength) {
  const std::vector<detail::AxisEntry> flat{{1, 1, 0}, {1, 1, 1}, {1, 1, 2}};
  std::vector<float> room(3);
  detail::LiteralCut cut;
  detail::consider_axis(0, flat, room, cut);
  EXPECT_EQ(cut.axis, -1);
}

TEST(LiteralSplit, HalvesASetThatIsOnePoint) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) test::add_triangle(mesh, {1, 2, 3}, {1, 2, 3}, {1, 2, 3});
  BuildOptions options;
  options.rule = SplitRule::paper;
  const Result<AabbTree> tree = build_tree(mesh, options);
  ASSERT_TRUE(tree.ok());
  EXPECT_EQ(tree->depth, 3U);
}

// The split algorithm of section 3 done the slow way, in whole numbers: every sub-mesh sorted
// afresh, every sum taken from the definition, fractions compared crosswise.
struct WholeNumberSplit {
  std::set<std::uint32_t> first;
  std::set<std::uint32_t> second;
};

WholeNumberSplit split_in_whole_numbers(const TriangleMesh& mesh,
                                        const std::set<std::uint32_t>& submesh) {
  const auto low = [&](std::uint32_t t, int axis) {
    const Triangle x = mesh.triangle(t);
    return static_cast<long>(std::min({x.corner[0][axis], x.corner[1][axis], x.corner[2][axis]}));
  };
  const auto high = [&](std::uint32_t t, int axis) {
    const Triangle x = mesh.triangle(t);
    return static_cast<long>(std::max({x.corner[0][axis], x.corner[1][axis], x.corner[2][axis]}));
  };
  WholeNumberSplit best;
  long best_sum = 0;
  long best_whole = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<std::uint32_t> sorted(submesh.begin(), submesh.end());
    std::stable_sort(sorted.begin(), sorted.end(), [&](std::uint32_t a, std::uint32_t b) {
      return high(a, axis) < high(b, axis);
    });
    const auto length = [&](std::size_t from, std::size_t to) {
      long lowest = low(sorted[from], axis);
      long highest = high(sorted[from], axis);
      for (std::size_t i = from; i < to; ++i) {
        lowest = std::min(lowest, low(sorted[i], axis));
        highest = std::max(highest, high(sorted[i], axis));
      }
      return highest - lowest;
    };
    const long whole = length(0, sorted.size());
    if (whole == 0) continue;
    for (std::size_t index = 1; index < sorted.size(); ++index) {
      const long sum = length(0, index) + length(index, sorted.size());
      if (best_whole == 0 || sum * best_whole < best_sum * whole) {
        best_sum = sum;
        best_whole = whole;
        const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(index);
        best = {{sorted.begin(), at}, {at, sorted.end()}};
      }
    }
  }
  return best;
}

TEST(LiteralSplit, EqualsTheAlgorithmInWholeNumbers) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    const std::size_t n = 2 + random() % 14;
    const auto whole = [&random](std::uint64_t range) {
      return static_cast<float>(random() % range);
    };
    TriangleMesh mesh;
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Vector3f at(whole(20), whole(12), whole(9));
      const Eigen::Vector3f b(whole(6), whole(4), whole(3));
      const Eigen::Vector3f c(whole(6), whole(4), whole(3));
      test::add_triangle(mesh, at, at + b, at - c);
    }
    BuildOptions options;
    options.rule = SplitRule::paper;
    const Result<AabbTree> tree = build_tree(mesh, options);
    ASSERT_TRUE(tree.ok());
    for (std::uint32_t node = 0; node < tree->nodes.size(); ++node) {
      if (tree->nodes[node].is_leaf()) {
        ASSERT_EQ(tree->nodes[node].count, 1U);
        continue;
      }
      const WholeNumberSplit expected = split_in_whole_numbers(mesh, triangles_below(*tree, node));
      if (expected.first.empty()) continue;  // one point: the median, which has a test of its own
      ASSERT_EQ(triangles_below(*tree, tree->nodes[node].first), expected.first);
      ASSERT_EQ(triangles_below(*tree, tree->nodes[node].first + 1), expected.second);
    }
  }
}

}  // namespace
}  // namespace crashrank

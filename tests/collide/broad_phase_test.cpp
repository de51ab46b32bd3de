#include "crashrank/collide/broad_phase.hpp"

#include "oracle/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using Pairs = std::set<std::pair<std::size_t, std::size_t>>;

float real(oracle::Random& random, double low, double high) {
  return static_cast<float>(random.real(low, high));
}

Box box_at(const Eigen::Vector3f& center, const Eigen::Vector3f& half) {
  Box box;
  box.grow(Eigen::Vector3f(center - half));
  box.grow(Eigen::Vector3f(center + half));
  return box;
}

Pairs found_pairs(const std::vector<Box>& boxes) {
  BroadPhase phase;
  phase.build(boxes);
  Pairs pairs;
  phase.pairs([&](std::size_t i, std::size_t j) {
    EXPECT_LT(i, j);
    EXPECT_TRUE(pairs.emplace(i, j).second) << "twice: " << i << ", " << j;
  });
  return pairs;
}

// The reference: every pair looked at, by a test written out here.
Pairs all_pairs(const std::vector<Box>& boxes) {
  Pairs pairs;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t j = i + 1; j < boxes.size(); ++j) {
      bool apart = false;
      for (int axis = 0; axis < 3; ++axis) {
        apart = apart || boxes[i].min[axis] > boxes[j].max[axis] ||
                boxes[j].min[axis] > boxes[i].max[axis];
      }
      if (!apart) pairs.emplace(i, j);
    }
  }
  return pairs;
}

TEST(BroadPhase, FindsThePairsThatBruteForceFinds) {
  std::size_t most = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    oracle::Random random(seed);
    const auto count = static_cast<std::size_t>(random.integer(0, 119));
    const double spread = random.real(0.0, 60.0);
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < count; ++i) {
      if (random.chance(0.05)) {
        boxes.emplace_back();
        continue;
      }
      // Flat scenes and whole numbers, so that boxes line up and touch.
      const bool whole = random.chance(0.5);
      Eigen::Vector3f center(real(random, -spread, spread), real(random, -spread, spread),
                             real(random, 0.0F, 1.0F));
      if (whole) center = center.array().round();
      boxes.push_back(box_at(
          center, {real(random, 0.0F, 3.0F), whole ? 1.0F : real(random, 0.0F, 3.0F), 0.5F}));
    }
    const Pairs expected = all_pairs(boxes);
    EXPECT_EQ(found_pairs(boxes), expected);
    most = std::max(most, expected.size());
  }
  EXPECT_GT(most, 100U);
}

TEST(BroadPhase, AQueryFindsWhatABoxOverlaps) {
  oracle::Random random(7);
  std::vector<Box> boxes;
  for (int i = 0; i < 500; ++i) {
    boxes.push_back(box_at({real(random, -50, 50), real(random, -50, 50), real(random, 0, 2)},
                           {2.0F, 1.0F, 0.7F}));
  }
  BroadPhase phase;
  phase.build(boxes);
  EXPECT_EQ(phase.size(), 500U);
  for (int k = 0; k < 100; ++k) {
    const Box box =
        box_at({real(random, -50, 50), real(random, -50, 50), 1.0F}, {4.0F, 4.0F, 1.0F});
    std::set<std::size_t> found;
    phase.query(box, [&](std::size_t i) { EXPECT_TRUE(found.insert(i).second); });
    std::set<std::size_t> expected;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (boxes[i].overlaps(box)) expected.insert(i);
    }
    EXPECT_EQ(found, expected);
  }
}

TEST(BroadPhase, TouchingBoxesOverlapAndEmptyOnesDoNot) {
  const Box unit = box_at({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(found_pairs({unit, box_at({2, 0, 0}, {1, 1, 1})}), (Pairs{{0, 1}}));
  EXPECT_EQ(found_pairs({unit, box_at({2.001F, 0, 0}, {1, 1, 1})}), Pairs{});
  EXPECT_EQ(found_pairs({Box{}, unit, Box{}, unit}), (Pairs{{1, 3}}));
  EXPECT_EQ(found_pairs({}), Pairs{});
  EXPECT_EQ(found_pairs({Box{}, Box{}}), Pairs{});
}

TEST(BroadPhase, BoxesWithoutBoundsOverlapEverything) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  Box all;
  all.min.setConstant(-inf);
  all.max.setConstant(inf);
  std::vector<Box> boxes(9, box_at({0, 0, 0}, {1, 1, 1}));
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    boxes[i] = box_at({static_cast<float>(10 * i), 0, 0}, {1, 1, 1});
  }
  boxes.push_back(all);
  EXPECT_EQ(found_pairs(boxes).size(), 9U);
}

TEST(BroadPhase, EqualBoxesDoNotDeepenTheTree) {
  const std::vector<Box> boxes(300, box_at({1, 2, 3}, {1, 1, 1}));
  EXPECT_EQ(found_pairs(boxes).size(), 300U * 299U / 2U);
}

// Cars parked in a square grid with gaps: the work has to grow about as n, not as n².
TEST(BroadPhase, WorkGrowsWithTheNumberOfBodiesNotItsSquare) {
  const auto tests_for = [](int side) {
    std::vector<Box> boxes;
    for (int i = 0; i < side; ++i) {
      for (int j = 0; j < side; ++j) {
        boxes.push_back(box_at({6.0F * static_cast<float>(i), 3.0F * static_cast<float>(j), 0.7F},
                               {2.2F, 0.9F, 0.7F}));
      }
    }
    BroadPhase phase;
    phase.build(boxes);
    std::size_t pairs = 0;
    const std::uint64_t tests = phase.pairs([&](std::size_t, std::size_t) { ++pairs; });
    EXPECT_EQ(pairs, 0U);
    return static_cast<double>(tests) / (side * side);
  };
  const double small = tests_for(10);
  const double large = tests_for(100);
  // A hundred times the bodies: each costs a few levels more, not a hundred times as much.
  EXPECT_LT(large, 4.0 * small);
  EXPECT_LT(large, 100.0);
}

}  // namespace
}  // namespace crashrank

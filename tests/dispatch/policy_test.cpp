#include "crashrank/dispatch/policy.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <set>
#include <vector>

namespace crashrank {
namespace {

/// Four cores with a state each, in the words of the definitions.
struct Cores {
  std::array<std::uint32_t, 4> batch{};
  std::array<std::uint32_t, 4> similarity{};
  std::array<bool, 4> claimed{};

  Placement placement() const {
    Placement at;
    at.cores = 4;
    at.buffer = 8;
    at.batch = batch.data();
    for (std::uint32_t core = 0; core < 4; ++core) {
      const std::uint64_t bit = std::uint64_t{1} << core;
      if (similarity[core] >= 1) at.holds_a |= bit;
      if (similarity[core] >= 2) at.holds_b |= bit;
      if (!claimed[core]) at.unclaimed |= bit;
    }
    return at;
  }
};

std::uint32_t choice(Policy policy, const Cores& cores) {
  const std::unique_ptr<PlacementPolicy> made = make_policy(policy);
  made->begin(4, 1);
  return made->choose(cores.placement());
}

TEST(Policy, BestMatchTakesTheMostSimilarThenTheLeastLoadedThenTheLowestNumber) {
  EXPECT_EQ(choice(Policy::best_match, {{0, 0, 7, 0}, {0, 1, 2, 1}, {}}), 2U);
  EXPECT_EQ(choice(Policy::best_match, {{0, 5, 7, 4}, {0, 1, 1, 1}, {}}), 3U);
  EXPECT_EQ(choice(Policy::best_match, {{0, 5, 5, 5}, {0, 1, 1, 1}, {}}), 1U);
  EXPECT_EQ(choice(Policy::best_match, {{3, 5, 0, 5}, {0, 1, 2, 1}, {false, false, true}}), 1U);
}

TEST(Policy, LowestTakesTheLeastSimilarThenTheLeastLoadedThenTheLowestNumber) {
  EXPECT_EQ(choice(Policy::lowest, {{0, 0, 7, 0}, {1, 2, 0, 1}, {}}), 2U);
  EXPECT_EQ(choice(Policy::lowest, {{0, 5, 7, 4}, {2, 1, 1, 1}, {}}), 3U);
  EXPECT_EQ(choice(Policy::lowest, {{0, 5, 5, 5}, {2, 1, 1, 1}, {}}), 1U);
  EXPECT_EQ(choice(Policy::lowest, {{3, 5, 0, 5}, {1, 2, 0, 2}, {false, false, true}}), 0U);
}

TEST(Policy, BestMatchLoadTakesTheLeastLoadedThenTheMostSimilarThenTheLowestNumber) {
  EXPECT_EQ(choice(Policy::best_match_load, {{3, 2, 1, 2}, {2, 2, 0, 2}, {}}), 2U);
  EXPECT_EQ(choice(Policy::best_match_load, {{3, 2, 2, 2}, {2, 0, 1, 2}, {}}), 3U);
  EXPECT_EQ(choice(Policy::best_match_load, {{3, 2, 2, 2}, {2, 1, 1, 1}, {}}), 1U);
  EXPECT_EQ(choice(Policy::best_match_load, {{3, 2, 0, 2}, {2, 1, 1, 2}, {false, false, true}}),
            3U);
}

TEST(Policy, RandomTakesEveryUnclaimedCoreAboutEquallyOftenAndRepeatsWithItsSeed) {
  const Cores cores{{0, 3, 0, 0}, {2, 0, 0, 1}, {false, false, true, false}};
  const std::unique_ptr<PlacementPolicy> policy = make_policy(Policy::random);
  std::vector<std::uint32_t> first;
  for (const std::uint64_t seed : {5U, 5U, 6U}) {
    policy->begin(4, seed);
    std::vector<std::uint32_t> choices;
    std::array<int, 4> times{};
    for (int i = 0; i < 3000; ++i) {
      choices.push_back(policy->choose(cores.placement()));
      ++times[choices.back()];
    }
    EXPECT_EQ(times[2], 0);
    for (const std::uint32_t core : {0U, 1U, 3U}) EXPECT_NEAR(times[core], 1000, 150);
    if (first.empty()) first = choices;
    EXPECT_EQ(choices == first, seed == 5U);
  }
}

// One state in which no two of the schemes agree (the random one never takes one core only).
TEST(Policy, NoTwoAreAlike) {
  const Cores cores{{4, 6, 1, 2}, {1, 2, 1, 0}, {}};
  EXPECT_EQ(choice(Policy::best_match, cores), 1U);
  EXPECT_EQ(choice(Policy::lowest, cores), 3U);
  EXPECT_EQ(choice(Policy::best_match_load, cores), 2U);
  const std::unique_ptr<PlacementPolicy> random = make_policy(Policy::random);
  random->begin(4, 1);
  std::set<std::uint32_t> taken;
  for (int i = 0; i < 200; ++i) taken.insert(random->choose(cores.placement()));
  EXPECT_EQ(taken.size(), 4U);
}

TEST(Policy, NamesAreReadBack) {
  for (const Policy policy : all_policies()) {
    const Result<Policy> read = policy_from_name(policy_name(policy));
    ASSERT_TRUE(read.ok());
    EXPECT_EQ(read.value(), policy);
  }
  EXPECT_FALSE(policy_from_name("bestmatch").ok());
}

}  // namespace
}  // namespace crashrank

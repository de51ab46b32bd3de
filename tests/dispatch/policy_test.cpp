#include "crashrank/dispatch/policy.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <set>
#include <vector>

namespace crashrank {
namespace {

/// Four cores with a state each, in the words of the definitions, and one job that waits.
struct Cores {
  std::array<std::uint32_t, 4> batch{};
  std::array<std::uint32_t, 4> similarity{};
  std::array<bool, 4> claimed{};
};

/// A placement whose parts stay together.
struct State {
  explicit State(const Cores& cores) : batch(cores.batch) {
    for (std::uint32_t core = 0; core < 4; ++core) {
      const std::uint64_t bit = std::uint64_t{1} << core;
      if (cores.similarity[core] >= 1) holders_a |= bit;
      if (cores.similarity[core] >= 2) holders_b |= bit;
      if (!cores.claimed[core]) at.unclaimed |= bit;
    }
    job.holders_a = &holders_a;
    job.holders_b = &holders_b;
    at.cores = 4;
    at.buffer = 8;
    at.batch = batch.data();
    at.batch_work = work.data();
    at.sent = sent.data();
    at.sent_work = work.data();
    at.jobs = {&job, 1};
  }

  std::array<std::uint32_t, 4> batch;
  std::array<std::uint32_t, 4> sent{};
  std::array<float, 4> work{};
  std::uint64_t holders_a = 0;
  std::uint64_t holders_b = 0;
  WaitingJob job;
  Placement at;
};

std::uint32_t choice(Policy policy, const Cores& cores) {
  const std::unique_ptr<PlacementPolicy> made = make_policy(policy);
  made->begin(4, 1);
  const State state(cores);
  return made->choose(state.at).core;
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
  const State state(cores);
  const std::unique_ptr<PlacementPolicy> policy = make_policy(Policy::random);
  std::vector<std::uint32_t> first;
  for (const std::uint64_t seed : {5U, 5U, 6U}) {
    policy->begin(4, seed);
    std::vector<std::uint32_t> choices;
    std::array<int, 4> times{};
    for (int i = 0; i < 3000; ++i) {
      choices.push_back(policy->choose(state.at).core);
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
  const State state(cores);
  std::set<std::uint32_t> taken;
  for (int i = 0; i < 200; ++i) taken.insert(random->choose(state.at).core);
  EXPECT_EQ(taken.size(), 4U);
}

/// Jobs that wait for two cores, by who holds their parts.
struct TwoCores {
  explicit TwoCores(const std::vector<std::array<std::uint64_t, 2>>& parts_held_by)
      : held(parts_held_by) {
    for (const std::array<std::uint64_t, 2>& by : held) {
      jobs.push_back({&by[0], &by[1], 1000, 1000, 10.0F});
      at.waiting_work += 10.0F;
    }
    at.cores = 2;
    at.buffer = 8;
    at.unclaimed = 3;
    at.batch = batch.data();
    at.batch_work = batch_work.data();
    at.sent = sent.data();
    at.sent_work = sent_work.data();
    at.seconds_per_work = 0.125e-6F;
    at.jobs = jobs;
  }

  std::vector<std::array<std::uint64_t, 2>> held;
  std::vector<WaitingJob> jobs;
  std::array<std::uint32_t, 2> batch{};
  std::array<float, 2> batch_work{};
  std::array<std::uint32_t, 2> sent{};
  std::array<float, 2> sent_work{};
  Placement at;
};

TEST(Policy, LateMatchGivesTheCoreWithLeastWorkTheJobItIsNearestTo) {
  const std::unique_ptr<PlacementPolicy> late = make_policy(Policy::late_match);
  late->begin(2, 1);
  // Held by: core 1 half; both cores; nobody; core 0 half; core 0 whole.
  TwoCores two({{2, 0}, {3, 3}, {0, 0}, {1, 0}, {1, 1}});
  EXPECT_EQ(late->choose(two.at).core, 0U);
  EXPECT_EQ(late->choose(two.at).job, 4U);
  two.sent_work = {30.0F, 0.0F};
  EXPECT_EQ(late->choose(two.at).core, 1U);
  EXPECT_EQ(late->choose(two.at).job, 0U);
  two.batch_work = {0.0F, 40.0F};
  EXPECT_EQ(late->choose(two.at).core, 0U);
  two.at.unclaimed = 2;
  EXPECT_EQ(late->choose(two.at).core, 1U);
}

TEST(Policy, LateMatchTakesOfEquallyNearJobsTheFirst) {
  const std::unique_ptr<PlacementPolicy> late = make_policy(Policy::late_match);
  late->begin(2, 1);
  const TwoCores two({{2, 2}, {3, 3}, {0, 0}});
  EXPECT_EQ(late->choose(two.at).core, 0U);
  EXPECT_EQ(late->choose(two.at).job, 1U);
}

TEST(Policy, LateMatchWaitsForMoreJobsUnlessACoreIsIdleOrSoonWillBe) {
  const std::unique_ptr<PlacementPolicy> late = make_policy(Policy::late_match);
  late->begin(2, 1);
  EXPECT_GT(late->window(), 1U);
  TwoCores few({{0, 0}, {0, 0}});
  EXPECT_TRUE(late->in_haste(few.at));
  few.sent = {1, 1};
  EXPECT_FALSE(late->in_haste(few.at));
  TwoCores many({{0, 0}, {0, 0}, {0, 0}, {0, 0}});
  many.sent = {2, 1};
  EXPECT_TRUE(late->in_haste(many.at));
  many.sent = {2, 2};
  EXPECT_FALSE(late->in_haste(many.at));
  TwoCores one({{0, 0}});  // fewer than cores
  EXPECT_FALSE(late->in_haste(one.at));
}

TEST(Policy, LateMatchAloneLeavesSmallNodesWhole) {
  for (const Policy policy : all_policies()) {
    EXPECT_EQ(make_policy(policy)->whole_triangles() > 0, policy == Policy::late_match);
  }
}

TEST(Policy, LateMatchSendsBatchesThatShrinkTowardsTheEnd) {
  const std::unique_ptr<PlacementPolicy> late = make_policy(Policy::late_match);
  late->begin(2, 1);
  TwoCores two({{0, 0}, {0, 0}, {0, 0}, {0, 0}});
  two.at.waiting_work = 400.0F;
  two.batch_work = {300.0F, 0.0F};
  EXPECT_FALSE(late->send_early(two.at, 0));  // half of 700 is 350
  two.batch_work = {400.0F, 0.0F};
  EXPECT_TRUE(late->send_early(two.at, 0));
  two.at.waiting_work = 0.0F;
  two.batch_work = {1.0F, 0.5F};
  EXPECT_FALSE(late->send_early(two.at, 0)) << "not worth waking a core for, while more may come";
  two.at.all_found = true;
  two.batch_work = {1.0F, 0.5F};
  EXPECT_TRUE(late->send_early(two.at, 0));
  EXPECT_FALSE(late->send_early(two.at, 1));
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

// Deadlines at every single reading of the clock, with a clock that the test controls.
#include "crashrank/rank/anytime/ranker.hpp"

#include "rank/random_scene.hpp"
#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <sched.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

namespace {

/// Number of clock readings before all deadlines have passed; none: real clock.
std::int64_t looks_left = -1;
std::int64_t looks = 0;

/// A thread other than the main thread waits at its reading of this number while `held` is set.
std::atomic<bool> held{false};
std::atomic<int> looks_until_held{0};
std::atomic<int> holding{0};

}  // namespace

// Replaces steady_clock of the whole process.
extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
  const auto end = static_cast<int>(::syscall(SYS_clock_gettime, clock, time));
  if (held.load() && ::syscall(SYS_gettid) != ::getpid() && looks_until_held.fetch_sub(1) <= 1) {
    holding.fetch_add(1);
    while (held.load()) ::sched_yield();
  }
  if (clock != CLOCK_MONOTONIC || looks_left < 0) return end;
  ++looks;
  constexpr time_t years = 100'000'000;
  if (looks > looks_left) time->tv_sec += years;
  return end;
}

namespace crashrank {
namespace {

std::uint64_t wished(const char* variable, std::uint64_t otherwise) {
  const char* const wish = std::getenv(variable);
  return wish != nullptr ? std::strtoull(wish, nullptr, 10) : otherwise;
}

/// CRASHRANK_RANKER_SCENES, _SEED and _LOOKS (deadlines for each scene) make this a campaign.
TEST(RankerClock, IntervalsHoldAtEveryDeadline) {
  const std::uint64_t scenes = wished("CRASHRANK_RANKER_SCENES", 6);
  const std::uint64_t first = wished("CRASHRANK_RANKER_SEED", 300);
  const auto most = static_cast<std::int64_t>(wished("CRASHRANK_RANKER_LOOKS", 120));
  RankOptions how;
  how.measure = Measure::harm;
  how.harm.emplace();
  how.harm->intervals = false;
  std::int64_t cuts = 0;
  for (std::uint64_t seed = first; seed < first + scenes; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const scenes::Scene scene = scenes::traffic(seed);
    const RankResult plain = scene.ranked(how);
    std::vector<double> scores(plain.candidates.size());
    for (const CandidateResult& c : plain.ranking) scores[c.candidate] = c.score.value();
    RankerOptions options;
    options.rank = how;
    options.limits.candidates = plain.candidates.size();
    Result<Ranker> ranker = Ranker::prepare(scene.scenario, scene.models, options);
    ASSERT_TRUE(ranker.ok());
    RankBudget budget;
    budget.deadline_s = 1e5;

    const auto cut_at = [&](std::int64_t look) {
      looks = 0;
      looks_left = look;
      const RankerAnswer answer = ranker->rank(plain.candidates, budget);
      looks_left = -1;
      return answer;
    };
    ASSERT_TRUE(cut_at(std::numeric_limits<std::int64_t>::max()).complete);
    const std::int64_t all = looks;
    ASSERT_GT(all, 10);
    const std::int64_t step = std::max<std::int64_t>(1, all / most);
    // A different start in every scene, so that many scenes cover all residues.
    const auto begin = static_cast<std::int64_t>(seed % static_cast<std::uint64_t>(step));
    for (std::int64_t look = begin; look <= all; look += step) {
      SCOPED_TRACE("look " + std::to_string(look) + " of " + std::to_string(all));
      const RankerAnswer answer = cut_at(look);
      ++cuts;
      ASSERT_EQ(answer.ranking.size(), scores.size());
      for (const RankedCandidate& told : answer.ranking) {
        EXPECT_LE(told.interval.lowest, scores[told.candidate]) << "candidate " << told.candidate;
        EXPECT_GE(told.interval.highest, scores[told.candidate]) << "candidate " << told.candidate;
        if (told.known) {
          EXPECT_EQ(told.score, scores[told.candidate]);
        }
      }
      if (answer.proved) {
        const double best = *std::min_element(scores.begin(), scores.end());
        EXPECT_EQ(scores[answer.ranking[0].candidate], best);
      }
      if (HasFailure()) return;
    }
    // An interrupted call has no effect on the next one.
    EXPECT_EQ(cut_at(std::numeric_limits<std::int64_t>::max()).hash,
              ranker->rank(plain.candidates).hash);
  }
  std::printf("%lld cuts in %llu scenes\n", static_cast<long long>(cuts),
              static_cast<unsigned long long>(scenes));
}

TEST(RankerClock, ABlockedWorkerDoesNotDelayACall) {
  RankOptions how;
  how.measure = Measure::harm;
  how.harm.emplace();
  how.harm->intervals = false;
  const scenes::Scene scene = scenes::traffic(301);
  const RankResult plain = scene.ranked(how);
  RankerOptions options;
  options.rank = how;
  options.rank.workers = 3;
  options.spin_us = 0;  // idle workers do not read the clock
  options.limits.candidates = plain.candidates.size();
  Result<Ranker> ranker = Ranker::prepare(scene.scenario, scene.models, options);
  ASSERT_TRUE(ranker.ok());
  const std::uint64_t whole = ranker->rank(plain.candidates).hash;
  RankBudget budget;
  budget.deadline_s = 5e-3;
  int caught = 0;
  for (int attempt = 0; attempt < 4000 && caught < 6; ++attempt) {
    const int look = 1 + attempt % 3;
    SCOPED_TRACE("look " + std::to_string(look));
    holding.store(0);
    looks_until_held.store(look);
    held.store(true);
    // The test is that both calls return, and that the second one knows no score.
    ranker->rank(plain.candidates, budget);
    const bool away = holding.load() > 0;
    const RankerAnswer next = ranker->rank(plain.candidates, budget);
    ASSERT_TRUE(next.status);
    if (away) {
      EXPECT_EQ(next.effort.work, 0U);
      for (const RankedCandidate& told : next.ranking) EXPECT_EQ(told.stage, RankStage::unseen);
    }
    held.store(false);
    if (!away) continue;
    ++caught;
    EXPECT_EQ(ranker->rank(plain.candidates).hash, whole);
  }
  EXPECT_GT(caught, 0);
}

}  // namespace
}  // namespace crashrank

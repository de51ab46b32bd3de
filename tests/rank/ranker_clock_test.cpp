// Deadlines that come at every single look at the clock, by a clock that the test sets.
#include "crashrank/rank/ranker.hpp"

#include "rank/random_scene.hpp"
#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

namespace {

/// Looks at the clock after which it is late for everything; none: the clock is the real one.
std::int64_t looks_left = -1;
std::int64_t looks = 0;

}  // namespace

// Every steady_clock of the process ends up here.
extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
  const auto end = static_cast<int>(::syscall(SYS_clock_gettime, clock, time));
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

/// CRASHRANK_RANKER_SCENES, _SEED and _LOOKS (cuts of a scene at most) make a campaign of it.
TEST(RankerClock, TheIntervalsHoldAtWhateverLookTheTimeIsUp) {
  const std::uint64_t scenes = wished("CRASHRANK_RANKER_SCENES", 6);
  const std::uint64_t first = wished("CRASHRANK_RANKER_SEED", 300);
  const auto most = static_cast<std::int64_t>(wished("CRASHRANK_RANKER_LOOKS", 400));
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
    // Another first one in every scene, so that many scenes see all residues.
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
    // What was cut leaves nothing behind.
    EXPECT_EQ(cut_at(std::numeric_limits<std::int64_t>::max()).hash,
              ranker->rank(plain.candidates).hash);
  }
  std::printf("%lld cuts in %llu scenes\n", static_cast<long long>(cuts),
              static_cast<unsigned long long>(scenes));
}

}  // namespace
}  // namespace crashrank

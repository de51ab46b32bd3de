#include "crashrank/rank/rank.hpp"
#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <string>

namespace crashrank {
namespace {

using scenes::car_and_wall;
using scenes::of;
using scenes::Scene;

/// Forty candidates that hit or miss a parked car before a wall.
Scene many_candidates() {
  Scene scene = car_and_wall();
  scene.add_actor("parked", 0, 30.0, 1.0);
  for (int i = 0; i < 40; ++i) {
    scene.add_candidate("candidate " + std::to_string(i), -0.2 * i, 0.002 * (i % 5));
  }
  return scene;
}

std::size_t known(const RankResult& result) {
  return static_cast<std::size_t>(
      std::count_if(result.ranking.begin(), result.ranking.end(),
                    [](const CandidateResult& c) { return c.score.has_value(); }));
}

TEST(RankProgress, ACancelledRankingHasExactScoresAndBounds) {
  const Scene scene = many_candidates();
  const RankResult whole = scene.ranked();
  ASSERT_EQ(known(whole), 40U);
  for (const unsigned workers : {1U, 3U}) {
    for (const std::size_t enough : {0U, 1U, 7U, 33U}) {
      SCOPED_TRACE(std::to_string(workers) + " workers, " + std::to_string(enough));
      RankOptions options;
      options.workers = workers;
      options.on_progress = [enough](std::size_t evaluated, std::size_t candidates) {
        EXPECT_EQ(candidates, 40U);
        return evaluated < enough;
      };
      const RankResult part = scene.ranked(options);
      ASSERT_EQ(part.ranking.size(), 40U);
      // Other evaluations can end while one is checked.
      EXPECT_GE(known(part), enough);
      EXPECT_LT(known(part), enough + workers);
      EXPECT_FALSE(part.complete);
      for (const CandidateResult& c : part.ranking) {
        const CandidateResult& full = of(whole, part.candidates[c.candidate].name);
        if (c.score) {
          EXPECT_EQ(*c.score, *full.score);
          EXPECT_EQ(c.ego.triangles, full.ego.triangles);
          EXPECT_EQ(c.sample_scores, full.sample_scores);
        } else {
          EXPECT_LE(c.score_interval.lowest, *full.score);
          EXPECT_GE(c.score_interval.highest, *full.score);
          EXPECT_TRUE(std::isfinite(c.score_interval.highest));
        }
      }
      const std::size_t first = whole.ranking.front().candidate;
      EXPECT_NE(std::find(part.in_race.begin(), part.in_race.end(), first), part.in_race.end());
    }
  }
}

TEST(RankProgress, TheCallbackDoesNotChangeTheRanking) {
  const Scene scene = many_candidates();
  const RankResult plain = scene.ranked();
  for (const unsigned workers : {1U, 2U}) {
    std::atomic<std::size_t> most{0};
    RankOptions options;
    options.workers = workers;
    options.on_progress = [&most](std::size_t evaluated, std::size_t /*candidates*/) {
      std::size_t before = most;
      while (before < evaluated && !most.compare_exchange_weak(before, evaluated)) {
      }
      return true;
    };
    const RankResult asked = scene.ranked(options);
    EXPECT_EQ(most, 40U);
    EXPECT_TRUE(asked.complete);
    ASSERT_EQ(asked.ranking.size(), plain.ranking.size());
    for (std::size_t i = 0; i < plain.ranking.size(); ++i) {
      EXPECT_EQ(asked.ranking[i].candidate, plain.ranking[i].candidate);
      EXPECT_EQ(asked.ranking[i].score, plain.ranking[i].score);
    }
  }
}

}  // namespace
}  // namespace crashrank

#include "crashrank/rank/anytime/ranker.hpp"
#include "rank/anytime/ranker_case.hpp"
#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

namespace crashrank {
namespace {

using scenes::congestion;
using scenes::Scene;
using scenes::traffic;

/// The answers to growing amounts of work in which every contact is searched for and not every
/// score known, each given to `check`.
template <class Check> void each_estimated(const Case& c, Measure measure, Check check) {
  Ranker ranker = c.ranker(measure);
  const std::uint64_t all = ranker.rank(c.candidates).effort.work;
  constexpr std::uint64_t cuts = 24;
  for (std::uint64_t cut = 1; cut < cuts; ++cut) {
    RankBudget budget;
    budget.work = std::max<std::uint64_t>(cut, all * cut * cut / (cuts * cuts));
    const RankerAnswer answer = ranker.rank(c.candidates, budget);
    const bool searched =
        std::all_of(answer.ranking.begin(), answer.ranking.end(), [](const RankedCandidate& told) {
          return told.known || told.stage >= RankStage::searched;
        });
    if (searched && !answer.complete) check(answer);
  }
}

TEST(Estimate, OfTheEgosDeltaVIsThatOfTwoPointsThatStickTogether) {
  std::size_t seen = 0;
  for (std::uint64_t seed = 300; seed < 306; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Case c(seed, Measure::delta_v);

    each_estimated(c, Measure::delta_v, [&](const RankerAnswer& answer) {
      for (const RankedCandidate& told : answer.ranking) {
        if (told.known || !told.collides) continue;
        const double own = c.plain.ego.mass_kg;
        const double other = c.plain.actors[told.actor].mass_kg;
        const double share = std::isinf(other) ? 1.0 : other / (own + other);
        const double by_hand = share * told.closing_speed_mps;
        // Contacts that are over may have come to more.
        EXPECT_NEAR(told.estimate, std::clamp(by_hand, told.interval.lowest, told.interval.highest),
                    1e-9 * by_hand);
        ++seen;
      }
    });
  }
  EXPECT_GT(seen, 20U);
}

TEST(Estimate, DecidesTheOrderOfThoseNotKnown) {
  std::size_t seen = 0;
  for (std::uint64_t seed = 320; seed < 324; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    each_estimated(Case(seed, Measure::harm), Measure::harm, [&](const RankerAnswer& answer) {
      for (std::size_t i = 1; i < answer.ranking.size(); ++i) {
        const RankedCandidate& before = answer.ranking[i - 1];
        const RankedCandidate& after = answer.ranking[i];
        if (before.feasible != after.feasible) continue;
        EXPECT_LE(before.estimate, after.estimate);
        ++seen;
      }
    });
  }
  EXPECT_GT(seen, 20U);
}

/// Else the estimate would be no better than what it stands beside.
TEST(Estimate, ChoosesLessHarmThanTheUpperEndsOfTheIntervals) {
  double by_estimate = 0.0;
  double by_upper_end = 0.0;
  std::size_t answers = 0;
  const std::uint64_t seed = first_seed(340);
  const std::uint64_t scenes = scenes_to_try(16);
  for (std::uint64_t i = 0; i < scenes; ++i) {
    const Case c(i % 2 == 0 ? traffic(seed + i) : congestion(seed + i), Measure::harm);
    const double least = c.scores[c.plain.ranking[0].candidate];
    each_estimated(c, Measure::harm, [&](const RankerAnswer& answer) {
      const auto other = std::min_element(answer.ranking.begin(), answer.ranking.end(),
                                          [](const RankedCandidate& a, const RankedCandidate& b) {
                                            return std::pair(!a.feasible, a.interval.highest) <
                                                   std::pair(!b.feasible, b.interval.highest);
                                          });
      by_estimate += c.scores[answer.ranking[0].candidate] - least;
      by_upper_end += c.scores[other->candidate] - least;
      ++answers;
    });
  }
  std::printf(
      "%llu scenes from seed %llu, %zu answers: regret by estimates %.4f persons, by upper "
      "ends %.4f\n",
      static_cast<unsigned long long>(scenes), static_cast<unsigned long long>(seed), answers,
      by_estimate / static_cast<double>(answers), by_upper_end / static_cast<double>(answers));
  ASSERT_GT(answers, 20U);
  EXPECT_LT(by_estimate, by_upper_end);
}

}  // namespace
}  // namespace crashrank

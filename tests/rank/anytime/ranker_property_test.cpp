#include "campaign.hpp"
#include "crashrank/rank/anytime/ranker.hpp"
#include "rank/anytime/ranker_case.hpp"
#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using scenes::Scene;
using scenes::traffic;
using test::wished;

/// Widths of intervals relative to their first width, by fraction of the total work.
struct Widths {
  static constexpr std::array<std::uint64_t, 5> percent{10, 25, 50, 75, 90};
  std::array<std::vector<double>, percent.size()> shares;

  double median(std::size_t i) {
    std::vector<double>& found = shares[i];
    const auto middle = found.begin() + static_cast<std::ptrdiff_t>(found.size() / 2);
    std::nth_element(found.begin(), middle, found.end());
    return *middle;
  }
};

void cut_everywhere(const Case& c, Measure measure, std::uint64_t cuts, Widths& widths) {
  Ranker ranker = c.ranker(measure);
  const std::uint64_t all = ranker.rank(c.candidates).effort.work;
  std::vector<ScoreInterval> last(c.candidates.size(), {0.0, INFINITY});
  std::vector<double> first(c.candidates.size(), 0.0);
  for (std::uint64_t cut = 0; cut <= cuts; ++cut) {
    RankBudget budget;
    // Dense at little work; the width never grows from one budget to the next.
    const std::uint64_t fewest = std::min<std::uint64_t>(cut, 3);
    budget.work = std::max(fewest, all * cut * cut / (cuts * cuts));
    const RankerAnswer answer = ranker.rank(c.candidates, budget);
    bool winner_in_race = false;
    for (const RankedCandidate& told : answer.ranking) {
      const std::size_t i = told.candidate;
      ASSERT_TRUE(std::isfinite(told.interval.highest));
      ASSERT_LE(told.interval.lowest, c.scores[i]) << "candidate " << i << ", cut " << cut;
      ASSERT_GE(told.interval.highest, c.scores[i]) << "candidate " << i << ", cut " << cut;
      ASSERT_GE(told.interval.lowest, last[i].lowest) << "candidate " << i << ", cut " << cut;
      ASSERT_LE(told.interval.highest, last[i].highest) << "candidate " << i << ", cut " << cut;
      ASSERT_TRUE(!told.known || told.score == c.scores[i]);
      ASSERT_TRUE(!told.known || told.estimate == told.score);
      ASSERT_GE(told.estimate, told.interval.lowest) << "candidate " << i << ", cut " << cut;
      ASSERT_LE(told.estimate, told.interval.highest) << "candidate " << i << ", cut " << cut;
      last[i] = told.interval;
      if (cut == 0) first[i] = told.interval.highest - told.interval.lowest;
      if (i == c.plain.ranking[0].candidate) winner_in_race = told.in_race;
    }
    ASSERT_TRUE(winner_in_race) << "cut " << cut;
    ASSERT_TRUE(!answer.proved || answer.ranking[0].candidate == c.plain.ranking[0].candidate);
  }
  for (std::size_t k = 0; k < Widths::percent.size(); ++k) {
    RankBudget part;
    // Rounded up: if a few tests are the total work, no work is not a fraction of it.
    part.work = (all * Widths::percent[k] + 99) / 100;
    for (const RankedCandidate& told : ranker.rank(c.candidates, part).ranking) {
      if (!(first[told.candidate] > 0.0)) continue;
      widths.shares[k].push_back((told.interval.highest - told.interval.lowest) /
                                 first[told.candidate]);
    }
  }
}

TEST(RankerProperty, IntervalsContainTheScoreAndNarrowWithWork) {
  const std::uint64_t seed = first_seed(1000);
  const std::uint64_t cuts = wished("CRASHRANK_RANKER_CUTS", 14);
  Widths widths;
  const std::uint64_t scenes = scenes_to_try(30);
  for (std::uint64_t i = 0; i < scenes; ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed + i));
    cut_everywhere(Case(seed + i, Measure::harm), Measure::harm, cuts, widths);
    if (HasFatalFailure()) return;
  }
  ASSERT_FALSE(widths.shares[0].empty());
  for (std::size_t k = 0; k < Widths::percent.size(); ++k) {
    std::printf(
        "median width at %llu %% of the work: %.4f of the first; %zu candidates, %llu scenes\n",
        static_cast<unsigned long long>(Widths::percent[k]), widths.median(k),
        widths.shares[k].size(), static_cast<unsigned long long>(scenes));
  }
  // A quarter of the work gives the scores of more than half of the candidates; at a tenth most of
  // it is still to be simulated.
  EXPECT_LT(widths.median(1), 0.2);
}

TEST(RankerProperty, IntervalsHoldForChainsOfCrashes) {
  const std::uint64_t seed = first_seed(1500);
  const std::uint64_t cuts = wished("CRASHRANK_RANKER_CUTS", 8);
  const std::uint64_t scenes = scenes_to_try(6);
  Widths widths;
  std::size_t chains = 0;
  std::size_t contacts = 0;
  std::size_t crowded = 0;
  for (std::uint64_t i = 0; i < scenes; ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed + i));
    // All simulated measures in turn.
    const Measure measure = measures[i % 4 == 3 ? 1 + i / 4 % 3 : 0];
    const Case c(scenes::congestion(seed + i), measure);
    for (const CandidateResult& result : c.plain.ranking) {
      chains += result.further.empty() ? 0U : 1U;
      contacts += result.contacts.size() + result.further.size();
      crowded += result.crowded ? 1U : 0U;
    }
    cut_everywhere(c, measure, cuts, widths);
    if (HasFatalFailure()) return;
  }
  std::printf(
      "%llu scenes from seed %llu: %zu candidates with a chain, %zu contacts, %zu crowded\n",
      static_cast<unsigned long long>(scenes), static_cast<unsigned long long>(seed), chains,
      contacts, crowded);
  EXPECT_GT(chains, 2 * scenes);
}

TEST(RankerProperty, IntervalsHoldForUnevaluatedFutures) {
  const std::uint64_t seed = first_seed(1700);
  const std::uint64_t cuts = wished("CRASHRANK_RANKER_CUTS", 8);
  const std::uint64_t scenes = scenes_to_try(4);
  constexpr std::array<const char*, 4> risks{"expected", "cvar:0.8", "worst", "quantile:0.6"};
  Widths widths;
  std::size_t outcomes = 0;
  for (std::uint64_t i = 0; i < scenes; ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed + i));
    oracle::Random random(seed + i);
    Scene scene = i % 2 == 0 ? traffic(seed + i) : scenes::congestion(seed + i);
    scenes::add_predictions(random, scene, 3);
    scene.scenario.risk = *risk_from_name(risks[i % risks.size()]);
    const Case c(std::move(scene), Measure::harm);
    for (const CandidateResult& result : c.plain.ranking) outcomes += result.futures.size();
    cut_everywhere(c, Measure::harm, cuts, widths);
    if (HasFatalFailure()) return;
    // The complete answer, for any number of threads.
    Ranker ranker = c.ranker(Measure::harm, 3);
    const RankerAnswer answer = ranker.rank(c.candidates);
    ASSERT_TRUE(answer.complete);
    for (std::size_t k = 0; k < answer.ranking.size(); ++k) {
      ASSERT_EQ(answer.ranking[k].candidate, c.plain.ranking[k].candidate);
      ASSERT_EQ(answer.ranking[k].score, *c.plain.ranking[k].score);
    }
  }
  std::printf("%llu scenes from seed %llu: %zu outcomes\n", static_cast<unsigned long long>(scenes),
              static_cast<unsigned long long>(seed), outcomes);
}

TEST(RankerProperty, IntervalsHoldForErrorsOfStates) {
  const std::uint64_t seed = first_seed(1800);
  const std::uint64_t cuts = wished("CRASHRANK_RANKER_CUTS", 6);
  const std::uint64_t scenes = scenes_to_try(4);
  constexpr std::array<const char*, 4> risks{"expected", "cvar:0.8", "worst", "quantile:0.6"};
  constexpr std::array<Measure, 4> tried{Measure::harm, Measure::delta_v, Measure::energy,
                                         Measure::polygons};
  Widths widths;
  for (std::uint64_t i = 0; i < scenes; ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed + i));
    oracle::Random random(seed + i);
    Scene scene = i % 2 == 0 ? traffic(seed + i) : scenes::congestion(seed + i);
    if (i % 2 == 0) scenes::add_predictions(random, scene, 2);
    // Errors of the ego only, of the actors only, then of both.
    if (i % 3 != 1) scene.scenario.ego.uncertainty = {0.3, 0.02, 1.0};
    for (ScenarioActor& actor : scene.scenario.actors) {
      if (i % 3 != 0 && actor.model < scenes::pole_model) actor.perception = {0.2, 0.05, 0.5};
    }
    scene.scenario.risk = *risk_from_name(risks[i % risks.size()]);
    const Measure measure = tried[i % tried.size()];
    const Case c(std::move(scene), measure, 6);
    cut_everywhere(c, measure, cuts, widths);
    if (HasFatalFailure()) return;
    for (const unsigned workers : {1U, 3U}) {
      Ranker ranker = c.ranker(measure, workers);
      const RankerAnswer answer = ranker.rank(c.candidates);
      ASSERT_TRUE(answer.complete);
      for (std::size_t k = 0; k < answer.ranking.size(); ++k) {
        const CandidateResult& plain = c.plain.ranking[k];
        ASSERT_EQ(answer.ranking[k].candidate, plain.candidate);
        ASSERT_EQ(answer.ranking[k].score, *plain.score);
        ASSERT_EQ(answer.ranking[k].collision_probability, plain.collision_probability);
      }
    }
  }
}

TEST(RankerProperty, IntervalsHoldForRepeatedContacts) {
  // Two bodies collide at 14.3 m/s, then at 5.8 m/s: only the first collision counts.
  Widths widths;
  cut_everywhere(Case(scenes::congestion(50095), Measure::closing_energy), Measure::closing_energy,
                 16, widths);
}

TEST(RankerProperty, IntervalsHoldForEveryMeasure) {
  Widths widths;
  for (const Measure measure : measures) {
    for (std::uint64_t seed = 5000; seed < 5003; ++seed) {
      SCOPED_TRACE(std::string(measure_name(measure)) + ", seed " + std::to_string(seed));
      cut_everywhere(Case(seed, measure), measure, 8, widths);
      if (HasFatalFailure()) return;
    }
  }
}

}  // namespace
}  // namespace crashrank

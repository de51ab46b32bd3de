#include "crashrank/rank/anytime/ranker.hpp"
#include "rank/anytime/ranker_case.hpp"
#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <utility>

namespace crashrank {
namespace {

using scenes::congestion;
using scenes::Scene;
using scenes::traffic;

/// Calls `check` with the answers for increasing work budgets in which all scores are known or
/// estimated and some are unknown.
template <class Check> void each_estimated(const Case& c, Measure measure, Check check) {
  Ranker ranker = c.ranker(measure);
  const std::uint64_t all = ranker.rank(c.candidates).effort.work;
  constexpr std::uint64_t cuts = 48;
  for (std::uint64_t cut = 1; cut < cuts; ++cut) {
    RankBudget budget;
    budget.work = static_cast<std::uint64_t>(
        std::pow(static_cast<double>(all), static_cast<double>(cut) / cuts));
    const RankerAnswer answer = ranker.rank(c.candidates, budget);
    const bool seen = std::all_of(
        answer.ranking.begin(), answer.ranking.end(),
        [](const RankedCandidate& told) { return told.known || told.stage >= RankStage::near; });
    if (seen && !answer.complete) check(answer);
  }
}

/// Estimate of the only candidate before its simulation.
double estimate_of(const Scene& scene, Measure measure) {
  const Case c(scene, measure);
  double estimate = -1.0;
  each_estimated(c, measure, [&](const RankerAnswer& answer) {
    if (estimate < 0.0) estimate = answer.ranking[0].estimate;
  });
  return estimate;
}

TEST(Estimate, OfDeltaVIsThatOfAPlasticImpact) {
  constexpr double speed_mps = 20.0;
  constexpr double tolerance_mps = 0.02 * speed_mps;
  Scene fixed = scenes::car_and_wall();
  fixed.add_candidate("on", 0.0);
  EXPECT_NEAR(estimate_of(fixed, Measure::delta_v), speed_mps, tolerance_mps);
  // A car of 1500 kg hits one of 500 kg.
  Scene light = scenes::car_and_wall(500.0);
  light.add_candidate("on", 0.0);
  EXPECT_NEAR(estimate_of(light, Measure::delta_v), 0.25 * speed_mps, tolerance_mps);
}

/// Scraping along a barrier takes little of the speed: a collision with a person is worse.
TEST(Estimate, OfAScrapeIsBelowThatOfAPerson) {
  Scene scene;
  scene.scenario.ego.model = scene.add_model(
      "car", scenes::box_mesh({2, 0.9F, 0.7F}, 1, {0, 0, 0.7F}), BodyKind::car, 1500.0);
  scene.scenario.ego.speed_mps = 30.0;
  const std::size_t wall = scene.add_model(
      "wall", scenes::box_mesh({40, 0.2F, 0.5F}, 1, {0, 0, 0.5F}), BodyKind::barrier);
  const std::size_t person = scene.add_model(
      "person", scenes::box_mesh({0.2F, 0.3F, 0.85F}, 1, {0, 0, 0.85F}), BodyKind::pedestrian);
  scene.add_actor("wall", wall, 40.0, 2.0);
  scene.add_actor("person", person, 40.0, -0.5);
  scene.add_candidate("person", 0.0);
  scene.add_candidate("scrape", 0.0, 0.02);
  const Case c(scene, Measure::harm);
  std::size_t seen = 0;
  each_estimated(c, Measure::harm, [&](const RankerAnswer& answer) {
    std::map<std::string, double> estimates;
    for (const RankedCandidate& told : answer.ranking) {
      estimates[c.candidates[told.candidate].name] = told.estimate;
    }
    EXPECT_LT(estimates.at("scrape"), estimates.at("person"));
    ++seen;
  });
  EXPECT_GT(seen, 0U);
  EXPECT_EQ(c.candidates[c.plain.ranking[0].candidate].name, "scrape");
}

/// Without people there is no harm.
TEST(Estimate, OfAnEmptyCarAtAWallIsZero) {
  Scene scene = scenes::car_and_wall();
  scene.scenario.ego.occupants = 0.0;
  scene.add_candidate("on", 0.0);
  EXPECT_EQ(estimate_of(scene, Measure::harm), 0.0);
}

TEST(Estimate, OrdersCandidatesWithUnknownScores) {
  std::size_t seen = 0;
  for (std::uint64_t seed = 320; seed < 324; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    each_estimated(Case(seed, Measure::harm), Measure::harm, [&](const RankerAnswer& answer) {
      // The first place has rules of its own.
      for (std::size_t i = 2; i < answer.ranking.size(); ++i) {
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

/// Without this property estimates would not be better than upper bounds.
TEST(Estimate, ChoosesLessHarmThanUpperBounds) {
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
  // A single scene may decide the mean of a few.
  constexpr std::uint64_t enough_scenes = 12;
  if (scenes >= enough_scenes) {
    EXPECT_LT(by_estimate, by_upper_end);
  }
}

/// The feasible candidate that brakes hardest; of several the one that steers least.
std::size_t hardest_braking(const Case& c) {
  const CandidateResult* hardest = nullptr;
  const auto key = [&c](const CandidateResult& of) {
    const Candidate& candidate = c.candidates[of.candidate];
    return std::pair(candidate.acceleration_mps2, std::abs(candidate.curvature_per_m));
  };
  for (const CandidateResult& each : c.plain.ranking) {
    if (each.feasible && (hardest == nullptr || key(each) < key(*hardest))) hardest = &each;
  }
  return hardest != nullptr ? hardest->candidate : c.plain.ranking[0].candidate;
}

TEST(FirstPlace, IsNeverWorseThanBrakingAndRestsOnWhatItSays) {
  std::array<std::size_t, 4> seen{};
  const std::uint64_t seed = first_seed(360);
  const std::uint64_t scenes = scenes_to_try(10);
  for (std::uint64_t i = 0; i < scenes; ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed + i));
    const Case c(i % 2 == 0 ? traffic(seed + i) : congestion(seed + i), Measure::harm);
    const std::size_t braking = hardest_braking(c);
    Ranker ranker = c.ranker(Measure::harm);
    const std::uint64_t all = ranker.rank(c.candidates).effort.work;
    constexpr std::uint64_t cuts = 12;
    for (std::uint64_t cut = 0; cut <= cuts; ++cut) {
      RankBudget budget;
      budget.work = all * cut * cut / (cuts * cuts);
      const RankerAnswer answer = ranker.rank(c.candidates, budget);
      const RankedCandidate& first = answer.ranking[0];
      EXPECT_LE(c.scores[first.candidate], c.scores[braking]);
      EXPECT_EQ(answer.basis == RankBasis::proved, answer.proved);
      EXPECT_TRUE(answer.basis != RankBasis::simulated || first.known);
      EXPECT_TRUE(answer.basis != RankBasis::coarse || !(first.estimate > 0.0));
      if (answer.basis == RankBasis::braking) {
        EXPECT_EQ(first.candidate, braking);
      }
      ++seen[static_cast<std::size_t>(answer.basis)];
    }
  }
  EXPECT_GT(seen[static_cast<std::size_t>(RankBasis::braking)], 0U);
  EXPECT_GT(seen[static_cast<std::size_t>(RankBasis::simulated)], 0U);
  EXPECT_GT(seen[static_cast<std::size_t>(RankBasis::proved)], 0U);
}

}  // namespace
}  // namespace crashrank

#pragma once

#include "crashrank/rank/rank.hpp"

#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace crashrank::futures {

using scenes::Scene;

inline RankOptions options_with(bool samples) {
  RankOptions options;
  options.measure = Measure::harm;
  options.harm.emplace();
  options.harm->intervals = samples;
  return options;
}

/// One future as a scenario without uncertainty, and its probability.
struct SingleFuture {
  Scenario scenario;
  double probability = 1.0;
};

/// All combinations, expanded actor by actor: independent of how the library lists futures.
inline std::vector<SingleFuture> single_futures(const Scenario& scenario) {
  std::vector<SingleFuture> singles(1);
  singles.front().scenario = scenario;
  singles.front().scenario.actors.clear();
  for (const ScenarioActor& actor : scenario.actors) {
    std::vector<SingleFuture> more;
    for (const SingleFuture& before : singles) {
      const double exists = actor.existence_probability;
      if (exists < 1.0) {
        more.push_back(before);
        more.back().probability *= 1.0 - exists;
      }
      if (exists == 0.0) continue;
      const auto follow = [&](const ActorMotion& motion, double probability) {
        more.push_back(before);
        ScenarioActor certain = actor;
        certain.predictions.clear();
        certain.existence_probability = 1.0;
        static_cast<ActorMotion&>(certain) = motion;
        more.back().scenario.actors.push_back(certain);
        more.back().probability *= exists * probability;
      };
      if (actor.predictions.empty()) follow(actor, 1.0);
      for (const Prediction& prediction : actor.predictions) {
        follow(prediction, prediction.probability);
      }
    }
    singles = std::move(more);
  }
  return singles;
}

/// Scores, by candidate.
inline std::vector<double> scores_of(const RankResult& result) {
  std::vector<double> scores(result.ranking.size());
  for (const CandidateResult& c : result.ranking) scores[c.candidate] = c.score.value_or(-1.0);
  return scores;
}

inline RankResult ranked(const Scenario& scenario, const std::vector<Model>& models,
                         const RankOptions& options) {
  Result<RankResult> result = rank(scenario, models, options);
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message());
  return result.ok() ? std::move(*result) : RankResult{};
}

/// Expects that the outcomes of a candidate are those of `futures` futures, of probability 1 in
/// all.
inline void expect_all_futures(const CandidateResult& candidate, std::size_t futures) {
  double probability = 0.0;
  std::size_t found = 0;
  for (const FutureOutcome& outcome : candidate.futures) {
    probability += outcome.probability;
    found += outcome.futures;
  }
  EXPECT_NEAR(probability, 1.0, 1e-12);
  EXPECT_EQ(found, futures);
}

inline void expect_mean_of_singles(const Scene& scene, const RankOptions& options) {
  const RankResult whole = ranked(scene.scenario, scene.models, options);
  std::vector<double> mean(whole.ranking.size(), 0.0);
  std::vector<double> collides(whole.ranking.size(), 0.0);
  const std::vector<SingleFuture> singles = single_futures(scene.scenario);
  EXPECT_EQ(static_cast<double>(singles.size()), whole.futures.combinations);
  for (const SingleFuture& single : singles) {
    const RankResult part = ranked(single.scenario, scene.models, options);
    ASSERT_EQ(part.ranking.size(), mean.size());
    for (const CandidateResult& c : part.ranking) {
      mean[c.candidate] += single.probability * c.score.value_or(-1e9);
      if (c.collides) collides[c.candidate] += single.probability;
    }
  }
  for (const CandidateResult& c : whole.ranking) {
    const double expected = mean[c.candidate];
    EXPECT_NEAR(c.score.value_or(-1.0), expected, 1e-12 * std::max(1.0, expected))
        << "candidate " << c.candidate;
    EXPECT_NEAR(c.collision_probability, collides[c.candidate], 1e-12);
    expect_all_futures(c, whole.futures.futures);
  }
}

}  // namespace crashrank::futures

#pragma once

#include "crashrank/rank/anytime/ranker.hpp"

#include "campaign.hpp"
#include "rank/random_scene.hpp"
#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace crashrank {

inline constexpr std::array<Measure, 7> measures{
    Measure::harm,     Measure::delta_v, Measure::energy,   Measure::closing_energy,
    Measure::polygons, Measure::area,    Measure::intrusion};

/// Number of scenes of a property, seed of the first, and number of work budgets for each;
/// campaigns set CRASHRANK_RANKER_SCENES, CRASHRANK_RANKER_SEED, CRASHRANK_RANKER_CUTS.
inline std::uint64_t scenes_to_try(std::uint64_t otherwise) {
  return test::wished("CRASHRANK_RANKER_SCENES", otherwise);
}
inline std::uint64_t first_seed(std::uint64_t otherwise) {
  return test::wished("CRASHRANK_RANKER_SEED", otherwise);
}

inline RankOptions options_of(Measure measure, unsigned workers = 1) {
  RankOptions options;
  options.measure = measure;
  options.workers = workers;
  options.harm.emplace();
  options.harm->intervals = false;
  return options;
}

/// A Ranker of a scene, its candidates, and the expected answer.
struct Case {
  scenes::Scene scene;
  RankResult plain;
  std::vector<Candidate> candidates;
  std::vector<double> scores;  ///< by candidate
  std::size_t sampled = 64;    ///< number of drawn futures, if drawn

  Case(std::uint64_t seed, Measure measure) : Case(scenes::traffic(seed), measure) {}
  Case(scenes::Scene ranked_scene, Measure measure, std::size_t sampled_futures = 64)
      : scene(std::move(ranked_scene)), sampled(sampled_futures) {
    RankOptions options = options_of(measure);
    options.sampled_futures = sampled;
    plain = scene.ranked(options);
    candidates = plain.candidates;
    scores.assign(candidates.size(), -1.0);
    for (const CandidateResult& c : plain.ranking) {
      EXPECT_TRUE(c.score.has_value());
      scores[c.candidate] = c.score.value_or(-1.0);
    }
  }

  std::vector<Motion> motions() const {
    std::vector<Motion> all;
    for (const ScenarioActor& actor : scene.scenario.actors) all.push_back(*make_motion(actor));
    return all;
  }

  Ranker ranker(Measure measure, unsigned workers = 1) const {
    RankerOptions options;
    options.rank = options_of(measure, workers);
    options.rank.sampled_futures = sampled;
    options.limits.candidates = 64;
    Result<Ranker> made = Ranker::prepare(scene.scenario, scene.models, options);
    EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().message());
    return std::move(*made);
  }
};

}  // namespace crashrank

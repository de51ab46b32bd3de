#include "crashrank/rank/anytime/ranker.hpp"

#include "rank/anytime/ranker_case.hpp"
#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using scenes::Scene;
using scenes::traffic;

TEST(Ranker, WithoutADeadlineItHasTheBitsOfRank) {
  const std::uint64_t begin = first_seed(1);
  const std::uint64_t scenes = scenes_to_try(4);
  for (std::uint64_t seed = begin; seed < begin + scenes; ++seed) {
    for (const Measure measure : measures) {
      SCOPED_TRACE(std::string(measure_name(measure)) + ", seed " + std::to_string(seed));
      const Case c(seed, measure);
      for (const unsigned workers : {1U, 3U}) {
        Ranker ranker = c.ranker(measure, workers);
        const RankerAnswer answer = ranker.rank(c.candidates);
        ASSERT_TRUE(answer.status);
        ASSERT_EQ(answer.ranking.size(), c.candidates.size());
        EXPECT_TRUE(answer.complete);
        EXPECT_TRUE(answer.proved);
        EXPECT_EQ(answer.in_race, 1U);
        for (std::size_t i = 0; i < answer.ranking.size(); ++i) {
          const RankedCandidate& told = answer.ranking[i];
          ASSERT_EQ(told.candidate, c.plain.ranking[i].candidate);
          ASSERT_TRUE(told.known);
          ASSERT_EQ(std::bit_cast<std::uint64_t>(told.score),
                    std::bit_cast<std::uint64_t>(*c.plain.ranking[i].score));
        }
      }
    }
  }
}

TEST(Ranker, TheFirstPlaceAloneIsCorrectAndTakesNoMoreWork) {
  std::uint64_t all = 0;
  std::uint64_t first = 0;
  for (std::uint64_t seed = 100; seed < 112; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Case c(seed, Measure::harm);
    Ranker ranker = c.ranker(Measure::harm);
    all += ranker.rank(c.candidates).effort.work;
    RankBudget budget;
    budget.first_place_only = true;
    const RankerAnswer answer = ranker.rank(c.candidates, budget);
    EXPECT_TRUE(answer.proved);
    EXPECT_EQ(answer.ranking[0].candidate, c.plain.ranking[0].candidate);
    first += answer.effort.work;
  }
  EXPECT_LT(first, all);
  std::printf("first place proved with %.3f of the work of all places\n",
              static_cast<double>(first) / static_cast<double>(all));
}

TEST(Ranker, MovedAndWeightedPlansKeepTheirErrors) {
  oracle::Random random(1850);
  Scene scene = traffic(1850);
  scenes::add_predictions(random, scene, 2);
  scene.scenario.ego.uncertainty = {0.3, 0.02, 1.0};
  for (ScenarioActor& actor : scene.scenario.actors) {
    if (actor.model < scenes::pole_model) actor.perception = {0.2, 0.05, 0.5};
  }
  const Case before(scene, Measure::harm, 6);
  Ranker ranker = before.ranker(Measure::harm);
  std::vector<double> probabilities;
  for (ScenarioActor& actor : scene.scenario.actors) {
    actor.speed_mps *= 0.9;
    if (actor.predictions.empty()) probabilities.push_back(1.0);
    for (std::size_t k = 0; k < actor.predictions.size(); ++k) {
      Prediction& prediction = actor.predictions[k];
      prediction.speed_mps *= 0.9;
      prediction.probability = 1.0 / static_cast<double>(actor.predictions.size());
      probabilities.push_back(prediction.probability);
    }
  }
  const Case after(scene, Measure::harm, 6);
  const Result<std::vector<Motion>> motions = plan_motions(scene.scenario);
  ASSERT_TRUE(motions.ok());
  ASSERT_EQ(ranker.plans().size(), probabilities.size());
  ASSERT_EQ(motions->size(), probabilities.size());
  ASSERT_TRUE(ranker.move_actors(scene.scenario.ego.pose, *motions));
  ASSERT_TRUE(ranker.weigh_plans(probabilities));
  const RankerAnswer answer = ranker.rank(after.candidates);
  ASSERT_TRUE(answer.complete);
  for (const RankedCandidate& told : answer.ranking) {
    EXPECT_EQ(told.score, after.scores[told.candidate]);
  }
}

TEST(Ranker, WorkBudgetsGiveTheSameAnswerForEveryNumberOfWorkers) {
  for (std::uint64_t seed = 200; seed < 206; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Case c(seed, Measure::harm);
    Ranker one = c.ranker(Measure::harm, 1);
    Ranker three = c.ranker(Measure::harm, 3);
    const std::uint64_t all = one.rank(c.candidates).effort.work;
    for (std::uint64_t part = 0; part <= 8; ++part) {
      RankBudget budget;
      budget.work = all * part / 8;
      const RankerAnswer a = one.rank(c.candidates, budget);
      const RankerAnswer b = three.rank(c.candidates, budget);
      EXPECT_EQ(a.hash, b.hash);
      EXPECT_EQ(a.effort.work, b.effort.work);
      EXPECT_EQ(a.in_race, b.in_race);
    }
  }
}

TEST(Ranker, AnyDeadlineGivesAValidAnswer) {
  const Case c(300, Measure::harm);
  Ranker ranker = c.ranker(Measure::harm, 2);
  for (const double deadline_s : {0.0, -1.0, 1e-5, 1e-4, 1e-3, 3e-3, 1e-2, 1.0}) {
    RankBudget budget;
    budget.deadline_s = deadline_s;
    const RankerAnswer answer = ranker.rank(c.candidates, budget);
    ASSERT_TRUE(answer.status);
    for (const RankedCandidate& told : answer.ranking) {
      EXPECT_LE(told.interval.lowest, c.scores[told.candidate]);
      EXPECT_GE(told.interval.highest, c.scores[told.candidate]);
    }
    Result<RankResult> full = ranker.explain(c.candidates, answer);
    ASSERT_TRUE(full.ok());
    ASSERT_EQ(full->ranking.size(), c.candidates.size());
    for (const CandidateResult& told : full->ranking) {
      EXPECT_EQ(told.score.value_or(c.scores[told.candidate]), c.scores[told.candidate]);
    }
  }
}

TEST(Ranker, ExplainingACompleteAnswerEqualsRank) {
  for (const std::uint64_t seed : {310U, 311U}) {
    const Scene scene = traffic(seed);
    RankerOptions options;
    options.rank.measure = Measure::harm;
    Result<Ranker> ranker = Ranker::prepare(scene.scenario, scene.models, options);
    ASSERT_TRUE(ranker.ok());
    const RankResult plain = scene.ranked(Measure::harm);
    const RankerAnswer answer = ranker->rank(plain.candidates);
    ASSERT_TRUE(answer.complete);
    const Result<RankResult> full = ranker->explain(plain.candidates, answer);
    ASSERT_TRUE(full.ok());
    EXPECT_EQ(full->samples.size(), plain.samples.size());
    ASSERT_EQ(full->ranking.size(), plain.ranking.size());
    for (std::size_t i = 0; i < plain.ranking.size(); ++i) {
      const CandidateResult& p = plain.ranking[i];
      const CandidateResult& q = full->ranking[i];
      EXPECT_EQ(p.candidate, q.candidate);
      EXPECT_EQ(p.place, q.place);
      EXPECT_EQ(p.best_place, q.best_place);
      EXPECT_EQ(p.worst_place, q.worst_place);
      EXPECT_EQ(p.overtaken, q.overtaken);
      EXPECT_EQ(p.separable, q.separable);
      EXPECT_EQ(p.within_numerical_error, q.within_numerical_error);
      EXPECT_EQ(p.sample_scores, q.sample_scores);
    }
    // What time does not suffice for keeps its score and its first contact.
    const Result<RankResult> brief = ranker->explain(plain.candidates, answer, nullptr, 0.0);
    ASSERT_TRUE(brief.ok());
    EXPECT_TRUE(brief->complete);
    bool any = false;
    for (std::size_t i = 0; i < plain.ranking.size(); ++i) {
      const CandidateResult& p = plain.ranking[i];
      const CandidateResult& q = brief->ranking[i];
      EXPECT_EQ(p.score, q.score);
      EXPECT_EQ(p.place, q.place);
      EXPECT_TRUE(q.contacts.empty());
      EXPECT_EQ(p.collides, q.first_touch.has_value());
      any = any || p.collides;
    }
    EXPECT_EQ(brief->samples.empty(), any && !plain.samples.empty());
    // Partial answers are explained without samples.
    RankBudget none;
    none.work = 0;
    const RankerAnswer cut = ranker->rank(plain.candidates, none);
    const Result<RankResult> partial = ranker->explain(plain.candidates, cut);
    ASSERT_TRUE(partial.ok());
    EXPECT_TRUE(partial->complete || partial->samples.empty());
  }
}

TEST(Ranker, WorkersAfterADeadlineReadNoMemoryOfTheCaller) {
  const Case c(301, Measure::harm);
  const std::vector<Motion> motions = c.motions();
  const Pose& start = c.scene.scenario.ego.pose;
  Ranker ranker = c.ranker(Measure::harm, 4);
  const std::uint64_t whole = ranker.rank(c.candidates).hash;
  for (int call = 0; call < 300; ++call) {
    RankBudget budget;
    budget.deadline_s = 1e-5 * call;
    {
      std::vector<Candidate> gone = c.candidates;
      ASSERT_TRUE(ranker.rank(gone, budget).status);
      for (Candidate& candidate : gone) candidate.motion = Motion::at_rest(start);
    }
    // Both change or read data that workers may still read.
    if (call % 3 == 1) {
      ASSERT_TRUE(ranker.move_actors(start, motions));
    }
    if (call % 20 == 2) {
      EXPECT_EQ(ranker.rank(c.candidates).hash, whole);
    }
    if (call % 50 == 3) {
      Ranker ended = c.ranker(Measure::harm, 4);
      ended.rank(c.candidates, budget);
    }
  }
}

TEST(Ranker, MovedActorsAreRankedLikeANewScenario) {
  Scene scene = traffic(400);
  RankerOptions options;
  options.rank = options_of(Measure::harm);
  Result<Ranker> ranker = Ranker::prepare(scene.scenario, scene.models, options);
  ASSERT_TRUE(ranker.ok());
  std::vector<Motion> motions;
  for (ScenarioActor& actor : scene.scenario.actors) {
    actor.pose.translation.x() -= 3.0;
    actor.speed_mps *= 0.5;
    motions.push_back(*make_motion(actor));
  }
  const RankResult plain = scene.ranked(options.rank);
  ASSERT_TRUE(ranker->move_actors(scene.scenario.ego.pose, motions));
  const RankerAnswer answer = ranker->rank(plain.candidates);
  for (std::size_t i = 0; i < plain.ranking.size(); ++i) {
    EXPECT_EQ(answer.ranking[i].candidate, plain.ranking[i].candidate);
    EXPECT_EQ(answer.ranking[i].score, *plain.ranking[i].score);
  }
  motions.pop_back();
  EXPECT_FALSE(ranker->move_actors(scene.scenario.ego.pose, motions));
}

TEST(Ranker, LimitsAreEnforced) {
  const Case c(500, Measure::harm);
  RankerOptions options;
  options.rank = options_of(Measure::harm);
  options.limits.candidates = 3;
  Result<Ranker> ranker = Ranker::prepare(c.scene.scenario, c.scene.models, options);
  ASSERT_TRUE(ranker.ok());
  const RankerAnswer answer = ranker->rank(c.candidates);
  EXPECT_FALSE(answer.status);
  EXPECT_TRUE(answer.ranking.empty());
  EXPECT_TRUE(ranker->rank({c.candidates.data(), 3}).status);
  EXPECT_TRUE(ranker->rank({}).proved);
  options.limits.actors = 0;
  EXPECT_FALSE(Ranker::prepare(c.scene.scenario, c.scene.models, options).ok());
  options.limits = {};
  options.limits.triangles = 5;
  EXPECT_FALSE(Ranker::prepare(c.scene.scenario, c.scene.models, options).ok());
}

}  // namespace
}  // namespace crashrank

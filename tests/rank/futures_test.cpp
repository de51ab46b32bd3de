#include "rank/futures_cases.hpp"

#include "crashrank/rank/anytime/ranker.hpp"

#include "campaign.hpp"
#include "rank/random_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using futures::expect_mean_of_singles;
using futures::options_with;
using futures::ranked;
using futures::scores_of;
using scenes::Scene;
using test::wished;

TEST(Futures, TwoPredictionsOfOneActorAreTheWeightedSumOfTheSingleScenarios) {
  const std::uint64_t seed = wished("CRASHRANK_FUTURES_SEED", 7000);
  const std::uint64_t scenes = wished("CRASHRANK_FUTURES_SCENES", 12);
  for (std::uint64_t i = 0; i < scenes; ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed + i));
    oracle::Random random(seed + i);
    Scene scene = i % 2 == 0 ? scenes::traffic(seed + i) : scenes::congestion(seed + i);
    scenes::add_predictions(random, scene, 1);
    expect_mean_of_singles(scene, options_with(i % 4 == 0));
    if (HasFatalFailure()) return;
  }
}

TEST(Futures, IndependentPredictionsAreTheWeightedSumOfAllCombinations) {
  const std::uint64_t seed = wished("CRASHRANK_FUTURES_SEED", 7100);
  const std::uint64_t scenes = wished("CRASHRANK_FUTURES_SCENES", 8);
  std::size_t outcomes = 0;
  std::size_t futures = 0;
  for (std::uint64_t i = 0; i < scenes; ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed + i));
    oracle::Random random(seed + i);
    Scene scene = i % 2 == 0 ? scenes::traffic(seed + i) : scenes::congestion(seed + i);
    scenes::add_predictions(random, scene, 3);
    expect_mean_of_singles(scene, options_with(false));
    if (HasFatalFailure()) return;
    const RankResult whole = scene.ranked(options_with(false));
    for (const CandidateResult& c : whole.ranking) {
      outcomes += c.futures.size();
      futures += whole.futures.futures;
      // With equal weights and no property harm, harm is the sum of all risks.
      double sum = 0.0;
      for (const PersonRisk& risk : c.people) {
        EXPECT_GE(risk.probability, 0.0);
        EXPECT_LE(risk.probability, 1.0);
        sum += risk.persons * risk.probability;
      }
      EXPECT_NEAR(sum, *c.score, 1e-12 * (1.0 + sum));
    }
  }
  std::printf("%zu outcomes simulated for %zu futures of candidates, seeds from %llu\n", outcomes,
              futures, static_cast<unsigned long long>(seed));
  EXPECT_LT(outcomes, futures);
}

/// Adds an actor with the largest number of predictions at a distance.
void add_far(oracle::Random& random, Scene& scene, const std::string& name, double away_m) {
  const double direction = random.real(-std::numbers::pi, std::numbers::pi);
  ScenarioActor& far = scene.add_actor(name, scenes::car_model, away_m * std::cos(direction),
                                       away_m * std::sin(direction),
                                       random.real(-std::numbers::pi, std::numbers::pi));
  for (std::size_t k = 0; k < scenario_limits::predictions; ++k) {
    Prediction prediction;
    static_cast<ActorMotion&>(prediction) = far;
    prediction.speed_mps = random.real(0, 20);
    prediction.yaw_rate_radps = random.real(-0.3, 0.3);
    prediction.probability = 1.0 / static_cast<double>(scenario_limits::predictions);
    far.predictions.push_back(prediction);
  }
  far.existence_probability = random.real(0.1, 1.0);
}

TEST(Futures, DistantActorsDoNotMultiplyFutures) {
  const std::uint64_t seed = wished("CRASHRANK_FUTURES_SEED", 7600);
  const std::uint64_t scenes = wished("CRASHRANK_FUTURES_SCENES", 4);
  std::size_t most = 0;
  for (std::uint64_t i = 0; i < scenes; ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed + i));
    oracle::Random random(seed + i);
    Scene scene = i % 2 == 0 ? scenes::traffic(seed + i) : scenes::congestion(seed + i);
    scenes::add_predictions(random, scene, 3);
    const RankOptions options = options_with(i % 4 == 0);
    const RankResult near = scene.ranked(options);
    most = std::max(most, near.futures.futures);
    for (int k = 0; k < 5; ++k) {
      add_far(random, scene, "far " + std::to_string(k), random.real(350, 3000));
    }
    const RankResult all = scene.ranked(options);
    ASSERT_EQ(all.futures.futures, near.futures.futures);
    ASSERT_EQ(all.futures.left_out, near.futures.left_out + 5);
    EXPECT_EQ(all.futures.method, FutureMethod::all);
    EXPECT_GT(all.futures.combinations, 1e7);
    const std::vector<double> expected = scores_of(near);
    const std::vector<double> scores = scores_of(all);
    for (std::size_t c = 0; c < scores.size(); ++c) {
      EXPECT_NEAR(scores[c], expected[c], 1e-12 * std::max(1.0, expected[c]));
    }
    const Result<RankResult> within = rank_within(scene.scenario, scene.models, options, {});
    ASSERT_TRUE(within.ok());
    EXPECT_EQ(scores_of(*within), scores);
    EXPECT_EQ(within->futures.futures, all.futures.futures);
  }
  EXPECT_GT(most, 4U);
}

/// The ego, without others, and one candidate that coasts.
Scene coasting_alone(double speed_mps) {
  Scene scene = scenes::traffic(7700);
  scene.scenario.actors.clear();
  scene.scenario.listed.clear();
  scene.scenario.grid.reset();
  scene.scenario.ego.speed_mps = speed_mps;
  scene.add_candidate("coast", 0.0);
  return scene;
}

/// Pushes the car ahead as far as 95 m, more than 50 m beyond where the ego can be at the horizon.
Scene fast_into_the_car_ahead() {
  Scene scene = coasting_alone(60.0);
  scene.scenario.horizon_s = 0.4;
  scene.add_actor("near", scenes::car_model, 10.0, 0.0);
  return scene;
}

TEST(Futures, ActorsReachedAfterTheHorizonAreNotLeftOut) {
  Scene scene = fast_into_the_car_ahead();
  Scenario& scenario = scene.scenario;
  const auto predict = [](ScenarioActor& actor) {
    actor.predictions.resize(2);
    for (Prediction& each : actor.predictions) {
      static_cast<ActorMotion&>(each) = actor;
      each.probability = 0.5;
    }
    actor.predictions.back().yaw_rate_radps = 0.1;
    actor.predictions.back().speed_mps = 8.0;
  };
  predict(scene.add_actor("next", scenes::car_model, 95.0, 0.0));
  const RankResult reached = scene.ranked(options_with(false));
  EXPECT_EQ(reached.futures.left_out, 0U);
  EXPECT_EQ(reached.futures.futures, 2U);
  EXPECT_EQ(reached.ranking.front().futures.size(), 2U);
  expect_mean_of_singles(scene, options_with(false));
  const Result<RankResult> within = rank_within(scenario, scene.models, options_with(false), {});
  ASSERT_TRUE(within.ok());
  EXPECT_TRUE(within->complete);
  EXPECT_EQ(scores_of(*within), scores_of(reached));

  // The crash does not extend to the side.
  scenario.actors.pop_back();
  predict(scene.add_actor("aside", scenes::car_model, 95.0, 150.0));
  const RankResult apart = scene.ranked(options_with(false));
  EXPECT_EQ(apart.futures.left_out, 1U);
  EXPECT_EQ(apart.futures.futures, 1U);
  expect_mean_of_singles(scene, options_with(false));
}

/// Ten cars beside the road that may be there or not allow a thousand times as many combinations,
/// but no candidate comes near them.
TEST(Futures, ActorsBesideTheRoadMakeNoSample) {
  Scene scene = coasting_alone(15.0);
  scene.add_candidate("brake", -4.0);
  scene.add_actor("first", scenes::car_model, 25.0, 0.0).existence_probability = 0.3;
  scene.add_actor("second", scenes::car_model, 32.0, 0.5).existence_probability = 0.1;
  const RankResult alone = scene.ranked(options_with(false));
  ASSERT_EQ(alone.futures.futures, 4U);
  for (int k = 0; k < 10; ++k) {
    scene
        .add_actor("parked " + std::to_string(k), scenes::car_model, 5.0 * k, k % 2 == 0 ? 25 : -25)
        .existence_probability = 0.5;
  }
  const RankResult among = scene.ranked(options_with(false));
  EXPECT_EQ(among.futures.method, FutureMethod::all);
  EXPECT_EQ(among.futures.left_out, 10U);
  const std::vector<double> expected = scores_of(alone);
  const std::vector<double> scores = scores_of(among);
  for (std::size_t c = 0; c < scores.size(); ++c) EXPECT_NEAR(scores[c], expected[c], 1e-12);
  const Result<RankResult> within =
      rank_within(scene.scenario, scene.models, options_with(false), {});
  ASSERT_TRUE(within.ok());
  EXPECT_EQ(scores_of(*within), scores);
}

/// A crash that reaches one of many distant actors includes this one, not all of them.
TEST(Futures, ActorsThatACrashReachesAreIncludedOneByOne) {
  Scene scene = fast_into_the_car_ahead();
  scene.add_actor("next", scenes::car_model, 95.0, 0.0).existence_probability = 0.4;
  const std::vector<double> expected = scores_of(scene.ranked(options_with(false)));
  for (int k = 0; k < 12; ++k) {
    scene.add_actor("aside " + std::to_string(k), scenes::car_model, 95.0, 150.0 + 10.0 * k)
        .existence_probability = 0.5;
  }
  const RankResult among = scene.ranked(options_with(false));
  EXPECT_EQ(among.futures.method, FutureMethod::all);
  EXPECT_EQ(among.futures.left_out, 12U);
  EXPECT_EQ(among.futures.futures, 2U);
  EXPECT_NEAR(scores_of(among)[0], expected[0], 1e-12);
  const Result<RankResult> within =
      rank_within(scene.scenario, scene.models, options_with(false), {});
  ASSERT_TRUE(within.ok());
  EXPECT_EQ(within->futures.left_out, 12U);
  EXPECT_EQ(scores_of(*within), scores_of(among));
}

TEST(Futures, EveryWorkerCountGivesTheSameBits) {
  oracle::Random random(7200);
  Scene scene = scenes::congestion(7200);
  scenes::add_predictions(random, scene, 4);
  for (const bool samples : {false, true}) {
    RankOptions options = options_with(samples);
    const RankResult one = scene.ranked(options);
    options.workers = 3;
    const RankResult three = scene.ranked(options);
    EXPECT_EQ(scores_of(one), scores_of(three));
    for (std::size_t i = 0; i < one.ranking.size(); ++i) {
      EXPECT_EQ(one.ranking[i].sample_scores, three.ranking[i].sample_scores);
      EXPECT_EQ(one.ranking[i].futures.size(), three.ranking[i].futures.size());
    }
  }
}

TEST(Futures, JointFuturesAreTheWeightedSumOfTheSingleScenarios) {
  std::size_t absent = 0;
  for (std::uint64_t seed = 7300; seed < 7306; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    oracle::Random random(seed);
    Scene scene = scenes::traffic(seed);
    Scenario& scenario = scene.scenario;
    std::vector<double> mean;
    double left = 1.0;
    for (int f = 0; f < 3; ++f) {
      JointFuture future;
      future.probability = f == 2 ? left : left * random.real(0.2, 0.8);
      left -= future.probability;
      Scenario single = scenario;
      single.futures.clear();
      for (std::size_t i = 0; i < scenario.actors.size(); ++i) {
        if (scenario.actors[i].model >= scenes::pole_model || random.chance(0.3)) continue;
        if (random.chance(0.3)) {
          future.absent.push_back(i);
          single.actors[i].existence_probability = 0.0;
          ++absent;
          continue;
        }
        ActorMotion motion = scenario.actors[i];
        motion.speed_mps += random.real(-3, 3);
        motion.yaw_rate_radps += random.real(-0.2, 0.2);
        future.motions.push_back({i, motion});
        static_cast<ActorMotion&>(single.actors[i]) = motion;
      }
      scenario.futures.push_back(future);
      const std::vector<double> scores =
          scores_of(ranked(single, scene.models, options_with(false)));
      mean.resize(scores.size(), 0.0);
      for (std::size_t c = 0; c < scores.size(); ++c) mean[c] += future.probability * scores[c];
    }
    const std::vector<double> whole = scores_of(scene.ranked(options_with(false)));
    for (std::size_t c = 0; c < whole.size(); ++c) EXPECT_NEAR(whole[c], mean[c], 1e-12);
    const Result<RankResult> within = rank_within(scenario, scene.models, options_with(false), {});
    ASSERT_TRUE(within.ok());
    EXPECT_EQ(scores_of(*within), whole);
  }
  EXPECT_GT(absent, 6U);
}

TEST(Futures, AbsentActorsHaveNoMotion) {
  Scene scene = scenes::car_and_wall();
  scene.add_candidate("coast", 0.0);
  scene.add_actor("car", 0, 20.0, 0.0);
  Scenario& scenario = scene.scenario;
  const auto place = [&] {
    const Result<RankResult> result = rank(scenario, scene.models);
    return result.ok() ? std::string() : result.error().place;
  };
  scenario.futures.push_back({1.0, {}, {1}});
  EXPECT_EQ(place(), "");
  scenario.futures.front().absent = {1, 1};
  EXPECT_EQ(place(), "futures[0].absent");
  scenario.futures.front().absent = {2};
  EXPECT_EQ(place(), "futures[0].absent");
  scenario.futures.front().absent = {1};
  scenario.futures.front().motions.push_back({1, scenario.actors[1]});
  EXPECT_EQ(place(), "futures[0].absent");
}

}  // namespace
}  // namespace crashrank

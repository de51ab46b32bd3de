#include "rank/futures_cases.hpp"

#include "rank/random_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

namespace crashrank {
namespace {

using futures::options_with;
using futures::scores_of;
using scenes::Scene;

TEST(Futures, RiskMeasuresOfTwoFutures) {
  // The wall exists with a probability; without it there is no contact.
  Scene scene = scenes::car_and_wall();
  scene.scenario.measure = Measure::delta_v;
  scene.add_candidate("coast", 0.0);
  ScenarioActor& wall = scene.scenario.actors.front();
  wall.existence_probability = 0.25;
  const auto score = [&](const char* name) {
    RankOptions options;
    options.risk = *risk_from_name(name);
    return *scene.ranked(options).ranking.front().score;
  };
  wall.existence_probability = 1.0;
  const double hit = score("expected");
  ASSERT_GT(hit, 10.0);
  wall.existence_probability = 0.25;
  EXPECT_NEAR(score("expected"), 0.25 * hit, 1e-12 * hit);
  EXPECT_EQ(score("worst"), hit);
  EXPECT_EQ(score("quantile:0.75"), 0.0);  // not exceeded with 75 %: the lower score
  EXPECT_EQ(score("quantile:0.76"), hit);
  EXPECT_NEAR(score("cvar:0.75"), hit, 1e-12 * hit);
  EXPECT_NEAR(score("cvar:0.9"), hit, 1e-12 * hit);
  // The worst half contains the quarter with the wall and an equal share without.
  EXPECT_NEAR(score("cvar:0.5"), 0.5 * hit, 1e-12 * hit);
  // The mean of a tail never exceeds the worst score, however small the tail is.
  for (const double rare : {5e-13, 9e-13, 1e-9}) {
    wall.existence_probability = rare;
    EXPECT_LE(score("cvar:0.9999999999999"), hit);
  }
}

TEST(Futures, SamplesDoNotDependOnTheOrderOfActors) {
  oracle::Random random(7400);
  Scene scene = scenes::congestion(7402);
  for (ScenarioActor& actor : scene.scenario.actors) {
    if (actor.model >= scenes::pole_model) continue;
    for (const double probability : {0.5, 0.25, 0.25}) {
      Prediction prediction;
      static_cast<ActorMotion&>(prediction) = actor;
      prediction.speed_mps += random.real(-2, 2);
      prediction.probability = probability;
      actor.predictions.push_back(prediction);
    }
  }
  RankOptions options = options_with(false);
  options.sampled_futures = 16;
  const RankResult result = scene.ranked(options);
  ASSERT_EQ(result.futures.method, FutureMethod::sampled);
  EXPECT_EQ(result.futures.sampled, 16U);
  EXPECT_EQ(result.futures.futures, 17U);
  for (const CandidateResult& c : result.ranking) {
    std::set<double> drawn;
    for (const FutureOutcome& outcome : c.futures) {
      if (outcome.probability > 0.0) drawn.insert(outcome.score);
    }
    EXPECT_EQ(c.sampling_error.has_value(), drawn.size() > 1);
    double sum = 0.0;
    for (const FutureOutcome& outcome : c.futures) sum += outcome.probability;
    EXPECT_NEAR(sum, 1.0, 1e-12);
  }
  Scene turned = scene;
  std::reverse(turned.scenario.actors.begin(), turned.scenario.actors.end());
  EXPECT_EQ(scores_of(turned.ranked(options)), scores_of(result));
}

TEST(Futures, SamplingErrorNeedsSpreadAndTail) {
  Scene scene = scenes::car_and_wall();
  scene.add_candidate("coast", 0.0);
  scene.scenario.measure = Measure::delta_v;
  for (int i = 0; i < 11; ++i) {
    // Beside the path, so that their motions have no effect.
    scene.add_actor("beside " + std::to_string(i), 0, 6.0 * i, 3.5).existence_probability = 0.5;
  }
  const auto error = [&](const char* risk, std::size_t sampled) {
    RankOptions options;
    options.risk = *risk_from_name(risk);
    options.sampled_futures = sampled;
    const RankResult result = scene.ranked(options);
    EXPECT_EQ(result.futures.method, FutureMethod::sampled);
    return result.ranking.front().sampling_error;
  };
  EXPECT_FALSE(error("expected", 64).has_value());
  scene.scenario.actors.front().existence_probability = 0.5;
  EXPECT_TRUE(error("expected", 64).has_value());
  EXPECT_TRUE(error("cvar:0.5", 64).has_value());
  EXPECT_FALSE(error("cvar:0.9", 64).has_value());
  EXPECT_FALSE(error("worst", 64).has_value());
}

TEST(Futures, TwoEqualPredictionsEqualOne) {
  for (std::uint64_t seed = 7500; seed < 7504; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Scene scene = scenes::traffic(seed);
    const std::vector<double> certain = scores_of(scene.ranked(options_with(false)));
    ScenarioActor& actor = scene.scenario.actors.front();
    if (actor.model >= scenes::pole_model) continue;
    Prediction half;
    static_cast<ActorMotion&>(half) = actor;
    half.probability = 0.5;
    actor.predictions.assign(2, half);
    EXPECT_EQ(scores_of(scene.ranked(options_with(false))), certain);
  }
}

TEST(Futures, AFixedBodyHasOneMotion) {
  Scene scene = scenes::car_and_wall();
  scene.add_candidate("coast", 0.0);
  Prediction prediction;
  static_cast<ActorMotion&>(prediction) = scene.scenario.actors.front();
  prediction.probability = 0.5;
  scene.scenario.actors.front().predictions.assign(2, prediction);
  const Result<RankResult> result = rank(scene.scenario, scene.models);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, ErrorCode::bad_input);
  EXPECT_EQ(result.error().place, "actors[0] \"wall\"");
}

}  // namespace
}  // namespace crashrank

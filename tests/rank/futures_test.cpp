#include "crashrank/rank/anytime/ranker.hpp"
#include "crashrank/rank/rank.hpp"

#include "campaign.hpp"
#include "rank/random_scene.hpp"
#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using scenes::Scene;
using test::wished;

RankOptions options_with(bool samples) {
  RankOptions options;
  options.measure = Measure::harm;
  options.harm.emplace();
  options.harm->intervals = samples;
  return options;
}

/// One future written as a scenario without uncertainty, and its probability.
struct SingleFuture {
  Scenario scenario;
  double probability = 1.0;
};

/// All combinations, each actor's choices one after another: independent of how the library lists
/// its futures.
std::vector<SingleFuture> single_futures(const Scenario& scenario) {
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

/// Scores by candidate.
std::vector<double> scores_of(const RankResult& result) {
  std::vector<double> scores(result.ranking.size());
  for (const CandidateResult& c : result.ranking) scores[c.candidate] = c.score.value_or(-1.0);
  return scores;
}

RankResult ranked(const Scenario& scenario, const std::vector<Model>& models,
                  const RankOptions& options) {
  Result<RankResult> result = rank(scenario, models, options);
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message());
  return result.ok() ? std::move(*result) : RankResult{};
}

void expect_mean_of_singles(const Scene& scene, const RankOptions& options) {
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
    double sum = 0.0;
    std::size_t futures = 0;
    for (const FutureOutcome& outcome : c.futures) {
      sum += outcome.probability;
      futures += outcome.futures;
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
    EXPECT_EQ(futures, whole.futures.futures);
  }
}

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
      // Everybody counts as one, and damage to property as nothing: harm is the sum of all risks.
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

/// An actor with as many predictions as there may be, so far away.
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

TEST(Futures, WhoIsFarAwayMultipliesNothing) {
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

TEST(Futures, WhoIsReachedByACrashAfterTheHorizonIsNotLeftOut) {
  // The car ahead is pushed into the next one, over 50 m beyond where the ego can have gone when
  // its plans end.
  Scene scene = scenes::traffic(7700);
  Scenario& scenario = scene.scenario;
  scenario.actors.clear();
  scenario.listed.clear();
  scenario.grid.reset();
  scenario.horizon_s = 0.4;
  scenario.ego.speed_mps = 60.0;
  scene.add_candidate("coast", 0.0);
  scene.add_actor("near", scenes::car_model, 10.0, 0.0);
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

  // To the side nothing gets as far.
  scenario.actors.pop_back();
  predict(scene.add_actor("aside", scenes::car_model, 95.0, 150.0));
  const RankResult apart = scene.ranked(options_with(false));
  EXPECT_EQ(apart.futures.left_out, 1U);
  EXPECT_EQ(apart.futures.futures, 1U);
  expect_mean_of_singles(scene, options_with(false));
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

TEST(Futures, WhoIsAbsentHasNoMotion) {
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

TEST(Futures, RiskMeasuresAreThoseOfTheSingleScores) {
  // A car ahead brakes with a probability; behind it there is only the wall.
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
  EXPECT_EQ(score("quantile:0.75"), 0.0);  // not exceeded with 75 %: the lower one
  EXPECT_EQ(score("quantile:0.76"), hit);
  EXPECT_NEAR(score("cvar:0.75"), hit, 1e-12 * hit);
  EXPECT_NEAR(score("cvar:0.9"), hit, 1e-12 * hit);
  // The worst half holds the whole quarter with the wall and as much without.
  EXPECT_NEAR(score("cvar:0.5"), 0.5 * hit, 1e-12 * hit);
  // No mean of a tail exceeds the worst, however little is left of the tail.
  for (const double rare : {5e-13, 9e-13, 1e-9}) {
    wall.existence_probability = rare;
    EXPECT_LE(score("cvar:0.9999999999999"), hit);
  }
}

TEST(Futures, SamplesKeepEveryActorsProbabilitiesAndNoOrderOfActorsChangesThem) {
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

TEST(Futures, ASampleThatShowsNoSpreadOrNoTailStatesNoError) {
  Scene scene = scenes::car_and_wall();
  scene.add_candidate("coast", 0.0);
  scene.scenario.measure = Measure::delta_v;
  for (int i = 0; i < 11; ++i) {
    // Beside the way, so that what they do changes nothing.
    scene.add_actor("beside " + std::to_string(i), 0, 6.0 * i, 30.0).existence_probability = 0.5;
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

TEST(Futures, TwoEqualPredictionsAreOneAndHalvesAreTheWhole) {
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

TEST(Futures, ABodyThatNothingMovesHasOneMotion) {
  Scene scene = scenes::car_and_wall();
  scene.add_candidate("coast", 0.0);
  Prediction prediction;
  static_cast<ActorMotion&>(prediction) = scene.scenario.actors.front();
  prediction.probability = 0.5;
  scene.scenario.actors.front().predictions.assign(2, prediction);
  const Result<RankResult> result = rank(scene.scenario, scene.models);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, ErrorCode::bad_input);
  EXPECT_EQ(result.error().place, "actors.wall");
}

}  // namespace
}  // namespace crashrank

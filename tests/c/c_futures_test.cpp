#include "c/c_objects.hpp"
#include "crashrank/crashrank.hpp"
#include "crashrank/scenario/scenario_models.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <string>
#include <utility>
#include <vector>

using namespace c_objects;

namespace {

const std::string crossing_file = CRASHRANK_SCENARIOS "/pushed_onto_crossing.json";
constexpr double walks_mps = 1.4;

/// The pedestrian at his place at another speed.
crashrank_motion walking(double speed_mps) {
  auto motion = sized<crashrank_motion>();
  const std::array<double, 16> pose{0, -1, 0, 20.4, 1, 0, 0, -1.5, 0, 0, 1, 0, 0, 0, 0, 1};
  std::copy(pose.begin(), pose.end(), motion.pose);
  motion.speed_mps = speed_mps;
  return motion;
}

using NamedScores = std::map<std::string, double>;

NamedScores named_scores_in_c(const Loaded& loaded) {
  const Scores scores = scores_in_c(loaded);
  return {scores.begin(), scores.end()};
}

/// The same in C++, with the pedestrian's predictions.
NamedScores named_scores_in_cpp(const std::vector<std::pair<double, double>>& predictions,
                                const char* risk = "expected") {
  auto scenario = *crashrank::load_scenario_file(crossing_file);
  const auto models = *crashrank::load_scenario_models(scenario);
  crashrank::ScenarioActor& actor = scenario.actors.front();
  for (const auto& [probability, speed] : predictions) {
    crashrank::Prediction prediction;
    static_cast<crashrank::ActorMotion&>(prediction) = actor;
    prediction.pose.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    prediction.speed_mps = speed;
    prediction.probability = probability;
    actor.predictions.push_back(prediction);
  }
  scenario.risk = *crashrank::risk_from_name(risk);
  const auto ranked = *crashrank::rank(scenario, models);
  NamedScores scores;
  for (const auto& each : ranked.ranking) {
    scores[ranked.candidates[each.candidate].name] = *each.score;
  }
  return scores;
}

crashrank_status predict(crashrank_scenario* scenario, double probability, double speed_mps) {
  const crashrank_motion motion = walking(speed_mps);
  return crashrank_scenario_add_prediction(scenario, 0, probability, &motion, nullptr);
}

TEST(CApi, PredictionsScoreAsInCpp) {
  for (const char* risk : {"expected", "worst", "cvar:0.5"}) {
    SCOPED_TRACE(risk);
    const Loaded loaded = load(crossing_file);
    ASSERT_EQ(predict(loaded.scenario.get(), 0.7, walks_mps), CRASHRANK_OK);
    ASSERT_EQ(predict(loaded.scenario.get(), 0.3, 0.0), CRASHRANK_OK);
    ASSERT_EQ(crashrank_scenario_set_risk(loaded.scenario.get(), risk, nullptr), CRASHRANK_OK);
    EXPECT_EQ(named_scores_in_c(loaded), named_scores_in_cpp({{0.7, walks_mps}, {0.3, 0.0}}, risk));
  }
}

TEST(CApi, FuturesAndAbsenceAreTheWeightedSums) {
  const NamedScores walks = named_scores_in_c(load(crossing_file));
  const Loaded absent = load(crossing_file);
  ASSERT_EQ(crashrank_scenario_set_existence(absent.scenario.get(), 0, 0.0, nullptr), CRASHRANK_OK);
  const NamedScores without = named_scores_in_c(absent);
  const Loaded perhaps = load(crossing_file);
  ASSERT_EQ(crashrank_scenario_set_existence(perhaps.scenario.get(), 0, 0.25, nullptr),
            CRASHRANK_OK);
  for (const auto& [name, score] : named_scores_in_c(perhaps)) {
    EXPECT_NEAR(score, 0.25 * walks.at(name) + 0.75 * without.at(name), 1e-12) << name;
  }
  EXPECT_NE(walks, without);

  const Loaded joint = load(crossing_file);
  crashrank_scenario* const scenario = joint.scenario.get();
  ASSERT_EQ(crashrank_scenario_add_future(scenario, 0.4, nullptr), CRASHRANK_OK);
  ASSERT_EQ(crashrank_scenario_add_future(scenario, 0.6, nullptr), CRASHRANK_OK);
  const crashrank_motion stands = walking(0.0);
  ASSERT_EQ(crashrank_scenario_add_future_motion(scenario, 1, 0, &stands, nullptr), CRASHRANK_OK);
  const NamedScores waits = named_scores_in_cpp({{1.0, 0.0}});
  for (const auto& [name, score] : named_scores_in_c(joint)) {
    EXPECT_NEAR(score, 0.4 * walks.at(name) + 0.6 * waits.at(name), 1e-12) << name;
  }

  const Loaded missing = load(crossing_file);
  crashrank_scenario* const other = missing.scenario.get();
  ASSERT_EQ(crashrank_scenario_add_future(other, 0.4, nullptr), CRASHRANK_OK);
  ASSERT_EQ(crashrank_scenario_add_future(other, 0.6, nullptr), CRASHRANK_OK);
  ASSERT_EQ(crashrank_scenario_add_future_absence(other, 1, 0, nullptr), CRASHRANK_OK);
  for (const auto& [name, score] : named_scores_in_c(missing)) {
    EXPECT_NEAR(score, 0.4 * walks.at(name) + 0.6 * without.at(name), 1e-12) << name;
  }
}

TEST(CApi, ARankerWeighsPredictionsAnew) {
  const Loaded loaded = load(crossing_file);
  ASSERT_EQ(predict(loaded.scenario.get(), 0.7, walks_mps), CRASHRANK_OK);
  ASSERT_EQ(predict(loaded.scenario.get(), 0.3, 0.0), CRASHRANK_OK);
  crashrank_error error{};
  crashrank_ranker* made = nullptr;
  ASSERT_EQ(
      crashrank_ranker_create(loaded.scenario.get(), loaded.models.get(), nullptr, &made, &error),
      CRASHRANK_OK)
      << error.message;
  const Ranker ranker(made);
  const Loaded later = load(crossing_file);
  ASSERT_EQ(predict(later.scenario.get(), 0.2, walks_mps), CRASHRANK_OK);
  ASSERT_EQ(predict(later.scenario.get(), 0.8, 0.5), CRASHRANK_OK);
  ASSERT_EQ(crashrank_ranker_update(made, later.scenario.get(), &error), CRASHRANK_OK)
      << error.message;
  auto answer = sized<crashrank_answer>();
  ASSERT_EQ(crashrank_ranker_rank(made, nullptr, &answer, &error), CRASHRANK_OK);
  ASSERT_EQ(answer.complete, 1);
  const NamedScores expected = named_scores_in_cpp({{0.2, walks_mps}, {0.8, 0.5}});
  for (size_t i = 0; i < answer.count; ++i) {
    const crashrank_ranked& ranked = answer.ranking[i];
    EXPECT_EQ(ranked.score, expected.at(crashrank_ranker_candidate_name(made, ranked.candidate)));
    EXPECT_GT(ranked.collision_probability, 0.0);
  }
  EXPECT_EQ(crashrank_ranker_update(made, load(crossing_file).scenario.get(), &error),
            CRASHRANK_USAGE);
}

TEST(CApi, ErrorsOfStatesScoreAsInCpp) {
  const Loaded loaded = load(crossing_file);
  crashrank_scenario* const in_c = loaded.scenario.get();
  ASSERT_EQ(crashrank_scenario_set_ego_uncertainty(in_c, 0.2, 0.01, 0.5, nullptr), CRASHRANK_OK);
  ASSERT_EQ(crashrank_scenario_set_perception(in_c, 0, 0.3, 0.1, 0.0, nullptr), CRASHRANK_OK);
  auto scenario = *crashrank::load_scenario_file(crossing_file);
  scenario.ego.uncertainty = {0.2, 0.01, 0.5};
  scenario.actors.front().perception = {0.3, 0.1, 0.0};
  const auto models = *crashrank::load_scenario_models(scenario);
  const auto ranked = *crashrank::rank(scenario, models);
  EXPECT_EQ(ranked.futures.method, crashrank::FutureMethod::sampled);
  NamedScores expected;
  for (const auto& each : ranked.ranking) {
    expected[ranked.candidates[each.candidate].name] = *each.score;
  }
  EXPECT_EQ(named_scores_in_c(loaded), expected);

  // A ranker takes neither away nor adds any.
  crashrank_error error{};
  crashrank_ranker* made = nullptr;
  ASSERT_EQ(crashrank_ranker_create(in_c, loaded.models.get(), nullptr, &made, &error),
            CRASHRANK_OK)
      << error.message;
  const Ranker ranker(made);
  ASSERT_EQ(crashrank_ranker_update(made, in_c, &error), CRASHRANK_OK) << error.message;
  EXPECT_EQ(crashrank_ranker_update(made, load(crossing_file).scenario.get(), &error),
            CRASHRANK_USAGE);
}

TEST(CApi, BadErrorsOfStatesAreRefused) {
  const Loaded loaded = load(crossing_file);
  crashrank_scenario* const scenario = loaded.scenario.get();
  crashrank_error error{};
  const auto says = [&error](const char* words) {
    return std::strstr(error.message, words) != nullptr;
  };
  EXPECT_EQ(crashrank_scenario_set_ego_uncertainty(nullptr, 0, 0, 0, &error), CRASHRANK_USAGE);
  EXPECT_EQ(crashrank_scenario_set_perception(nullptr, 0, 0, 0, 0, &error), CRASHRANK_USAGE);
  EXPECT_EQ(crashrank_scenario_set_perception(scenario, 99, 0, 0, 0, &error), CRASHRANK_USAGE);
  EXPECT_TRUE(says("no such actor")) << error.message;
  crashrank_ranking* ranking = nullptr;
  const auto rank = [&] {
    return crashrank_rank(scenario, loaded.models.get(), nullptr, &ranking, &error);
  };
  ASSERT_EQ(crashrank_scenario_set_ego_uncertainty(scenario, 11, 0, 0, &error), CRASHRANK_OK);
  EXPECT_EQ(rank(), CRASHRANK_BAD_INPUT);
  EXPECT_TRUE(says("ego.uncertainty.position_m")) << error.message;
  ASSERT_EQ(crashrank_scenario_set_ego_uncertainty(scenario, 0, 0, 0, &error), CRASHRANK_OK);
  ASSERT_EQ(crashrank_scenario_set_perception(scenario, 0, 0, -1, 0, &error), CRASHRANK_OK);
  EXPECT_EQ(rank(), CRASHRANK_BAD_INPUT);
  EXPECT_TRUE(says("actors[0].perception.heading_deg")) << error.message;
}

TEST(CApi, WhatIsNoPredictionIsRefused) {
  const Loaded loaded = load(crossing_file);
  crashrank_scenario* const scenario = loaded.scenario.get();
  crashrank_error error{};
  const crashrank_motion motion = walking(1.0);
  const auto says = [&error](const char* words) {
    return std::strstr(error.message, words) != nullptr;
  };
  EXPECT_EQ(crashrank_scenario_add_prediction(scenario, 99, 1.0, &motion, &error), CRASHRANK_USAGE);
  EXPECT_TRUE(says("no such actor")) << error.message;
  EXPECT_EQ(crashrank_scenario_add_prediction(scenario, 0, 1.0, nullptr, &error), CRASHRANK_USAGE);
  EXPECT_TRUE(says("motion: is NULL")) << error.message;
  crashrank_motion unset = motion;
  unset.size = 0;
  EXPECT_EQ(crashrank_scenario_add_prediction(scenario, 0, 1.0, &unset, &error), CRASHRANK_USAGE);
  EXPECT_TRUE(says("crashrank_motion.size")) << error.message;
  EXPECT_EQ(crashrank_scenario_add_future_motion(scenario, 0, 0, &motion, &error), CRASHRANK_USAGE);
  EXPECT_TRUE(says("no such future")) << error.message;
  EXPECT_EQ(crashrank_scenario_add_future_absence(scenario, 0, 0, &error), CRASHRANK_USAGE);
  EXPECT_TRUE(says("no such future")) << error.message;
  EXPECT_EQ(crashrank_scenario_set_risk(scenario, "median", &error), CRASHRANK_USAGE);
  EXPECT_TRUE(says("'median' is not a risk measure")) << error.message;
  ASSERT_EQ(predict(scenario, 0.5, 1.0), CRASHRANK_OK);
  crashrank_ranking* ranking = nullptr;
  EXPECT_EQ(crashrank_rank(scenario, loaded.models.get(), nullptr, &ranking, &error),
            CRASHRANK_BAD_INPUT);
  EXPECT_TRUE(says("actors[0].predictions: has probabilities that sum to 0.5")) << error.message;
}

}  // namespace

#include "c/c_objects.hpp"
#include "crashrank/crashrank.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

using namespace c_objects;

namespace {

TEST(CApi, ARankerAnswersAsRankDoesAndWithinABudgetSoundly) {
  const std::string file = CRASHRANK_SCENARIOS "/crossing_traffic.json";
  const auto [scenario, models] = load(file);
  crashrank_error error{};
  auto options = sized<crashrank_ranker_options>();
  options.measure = CRASHRANK_MEASURE_CLOSING_ENERGY;
  crashrank_ranker* prepared = nullptr;
  ASSERT_EQ(crashrank_ranker_create(scenario.get(), models.get(), &options, &prepared, &error),
            CRASHRANK_OK)
      << error.message;
  const Ranker ranker(prepared);
  auto full = sized<crashrank_answer>();
  ASSERT_EQ(crashrank_ranker_rank(ranker.get(), nullptr, &full, &error), CRASHRANK_OK);
  EXPECT_EQ(full.complete, 1);
  EXPECT_EQ(full.proved, 1);

  auto same = sized<crashrank_rank_options>();
  same.measure = CRASHRANK_MEASURE_CLOSING_ENERGY;
  crashrank_ranking* answer = nullptr;
  ASSERT_EQ(crashrank_rank(scenario.get(), models.get(), &same, &answer, &error), CRASHRANK_OK);
  const Ranking ranking(answer);
  ASSERT_EQ(full.count, crashrank_ranking_size(ranking.get()));
  std::vector<double> scores(full.count);
  for (size_t place = 0; place < full.count; ++place) {
    auto choice = sized<crashrank_choice>();
    ASSERT_EQ(crashrank_ranking_get(ranking.get(), place, &choice, &error), CRASHRANK_OK);
    const crashrank_ranked& ranked = full.ranking[place];
    EXPECT_STREQ(crashrank_ranker_candidate_name(ranker.get(), ranked.candidate), choice.candidate);
    EXPECT_EQ(ranked.score, choice.score);
    EXPECT_EQ(ranked.contact_without_force, choice.contact_without_force);
    scores.at(ranked.candidate) = ranked.score;
  }

  const uint64_t hash = full.hash;
  auto budget = sized<crashrank_budget>();
  budget.work = 1;
  auto cut = sized<crashrank_answer>();
  ASSERT_EQ(crashrank_ranker_rank(ranker.get(), &budget, &cut, &error), CRASHRANK_OK);
  EXPECT_EQ(cut.complete, 0);
  ASSERT_EQ(cut.count, scores.size());
  for (size_t place = 0; place < cut.count; ++place) {
    const crashrank_ranked& ranked = cut.ranking[place];
    EXPECT_LE(ranked.lowest_score, scores.at(ranked.candidate));
    EXPECT_GE(ranked.highest_score, scores.at(ranked.candidate));
  }

  // A deadline that is over leaves no time, not all of it.
  auto late = sized<crashrank_budget>();
  late.deadline_s = -1e-3;
  auto at_once = sized<crashrank_answer>();
  ASSERT_EQ(crashrank_ranker_rank(ranker.get(), &late, &at_once, &error), CRASHRANK_OK);
  EXPECT_EQ(at_once.complete, 0);
  late.deadline_s = NAN;
  EXPECT_EQ(crashrank_ranker_rank(ranker.get(), &late, &at_once, &error), CRASHRANK_USAGE);

  ASSERT_EQ(crashrank_ranker_update(ranker.get(), scenario.get(), &error), CRASHRANK_OK);
  auto again = sized<crashrank_answer>();
  ASSERT_EQ(crashrank_ranker_rank(ranker.get(), nullptr, &again, &error), CRASHRANK_OK)
      << error.message;
  EXPECT_EQ(again.hash, hash);
  EXPECT_EQ(crashrank_ranker_rank(nullptr, nullptr, &again, &error), CRASHRANK_USAGE);
  EXPECT_EQ(crashrank_ranker_candidate_name(ranker.get(), 1000), nullptr);
}

TEST(CApi, AnUpdateRefusesWhatCreateRefuses) {
  crashrank_error error{};
  const Models models = make_models();
  ASSERT_EQ(add_box(models.get()), CRASHRANK_OK);
  const auto situation = [&](double speed, double yaw_rate) {
    crashrank_scenario* made = nullptr;
    EXPECT_EQ(crashrank_scenario_create("limits", &made, &error), CRASHRANK_OK);
    crashrank_scenario_add_model(made, "car", CRASHRANK_KIND_CAR, 1500.0, &error);
    auto ego = sized<crashrank_ego>();
    std::memcpy(ego.pose, identity, sizeof identity);
    ego.speed_mps = speed;
    crashrank_scenario_set_ego(made, &ego, &error);
    auto actor = sized<crashrank_actor>();
    actor.name = "other";
    std::memcpy(actor.pose, identity, sizeof identity);
    actor.pose[3] = 30.0;
    actor.yaw_rate_radps = yaw_rate;
    crashrank_scenario_add_actor(made, &actor, &error);
    auto straight = sized<crashrank_candidate>();
    straight.name = "straight";
    crashrank_scenario_add_candidate(made, &straight, &error);
    return Scenario(made);
  };
  const Scenario good = situation(10.0, 0.0);
  crashrank_ranker* made = nullptr;
  ASSERT_EQ(crashrank_ranker_create(good.get(), models.get(), nullptr, &made, &error), CRASHRANK_OK)
      << error.message;
  const Ranker ranker(made);
  auto answer = sized<crashrank_answer>();
  ASSERT_EQ(crashrank_ranker_rank(ranker.get(), nullptr, &answer, &error), CRASHRANK_OK);
  const uint64_t hash = answer.hash;
  for (const auto& [speed, yaw_rate] :
       {std::pair(NAN, 0.0F), std::pair(1e30F, 0.0F), std::pair(10.0F, 20.0F)}) {
    const Scenario bad = situation(static_cast<double>(speed), static_cast<double>(yaw_rate));
    crashrank_ranker* none = nullptr;
    EXPECT_EQ(crashrank_ranker_create(bad.get(), models.get(), nullptr, &none, &error),
              CRASHRANK_BAD_INPUT);
    EXPECT_EQ(crashrank_ranker_update(ranker.get(), bad.get(), &error), CRASHRANK_BAD_INPUT);
    EXPECT_NE(std::strstr(error.message, speed == 10.0F ? "yaw_rate" : "speed"), nullptr)
        << error.message;
    ASSERT_EQ(crashrank_ranker_rank(ranker.get(), nullptr, &answer, &error), CRASHRANK_OK);
    EXPECT_EQ(answer.hash, hash);
  }
}

TEST(CApi, AnUpdateChangesMotionsAndNotBodies) {
  crashrank_error error{};
  const Models models = make_models();
  ASSERT_EQ(add_box(models.get()), CRASHRANK_OK);
  ASSERT_EQ(add_box(models.get()), CRASHRANK_OK);
  struct Told {
    double horizon_s = 2.0;
    double mass_kg = 1500.0;
    crashrank_body_kind kind = CRASHRANK_KIND_CAR;
    std::size_t actor_model = 0;
    std::size_t ego_model = 0;
    int actors = 1;
    double grip = 0.8;
    double pedestrian_weight = 1.0;
  };
  const auto situation = [&](const Told& told) {
    crashrank_scenario* made = nullptr;
    EXPECT_EQ(crashrank_scenario_create("bodies", &made, &error), CRASHRANK_OK);
    crashrank_scenario_add_model(made, "first", CRASHRANK_KIND_CAR, 1500.0, &error);
    crashrank_scenario_add_model(made, "second", told.kind, told.mass_kg, &error);
    auto ego = sized<crashrank_ego>();
    ego.model = told.ego_model;
    std::memcpy(ego.pose, identity, sizeof identity);
    ego.speed_mps = 10.0;
    crashrank_scenario_set_ego(made, &ego, &error);
    for (int i = 0; i < told.actors; ++i) {
      const std::string name = "other " + std::to_string(i);
      auto actor = sized<crashrank_actor>();
      actor.name = name.c_str();
      actor.model = told.actor_model;
      std::memcpy(actor.pose, identity, sizeof identity);
      actor.pose[3] = 30.0 + 20.0 * i;
      crashrank_scenario_add_actor(made, &actor, &error);
    }
    auto straight = sized<crashrank_candidate>();
    straight.name = "straight";
    crashrank_scenario_add_candidate(made, &straight, &error);
    EXPECT_EQ(crashrank_scenario_set_horizon(made, told.horizon_s, &error), CRASHRANK_OK);
    EXPECT_EQ(crashrank_scenario_set_grip(made, told.grip, &error), CRASHRANK_OK);
    auto harm = sized<crashrank_harm>();
    EXPECT_EQ(crashrank_scenario_get_harm(made, &harm, &error), CRASHRANK_OK);
    harm.weights_pedestrian = told.pedestrian_weight;
    EXPECT_EQ(crashrank_scenario_set_harm(made, &harm, &error), CRASHRANK_OK);
    return Scenario(made);
  };
  const Scenario good = situation({});
  crashrank_ranker* made = nullptr;
  ASSERT_EQ(crashrank_ranker_create(good.get(), models.get(), nullptr, &made, &error), CRASHRANK_OK)
      << error.message;
  const Ranker ranker(made);
  EXPECT_EQ(crashrank_ranker_update(ranker.get(), good.get(), &error), CRASHRANK_OK);
  const std::vector<std::pair<Told, const char*>> others{
      {{4.0}, "horizon_s"},
      {{2.0, 900.0}, "models"},
      {{2.0, 1500.0, CRASHRANK_KIND_PEDESTRIAN}, "models"},
      {{2.0, 1500.0, CRASHRANK_KIND_CAR, 1}, "actors"},
      {{2.0, 1500.0, CRASHRANK_KIND_CAR, 0, 1}, "ego.model"},
      {{2.0, 1500.0, CRASHRANK_KIND_CAR, 0, 0, 2}, "actors"},
      {{2.0, 1500.0, CRASHRANK_KIND_CAR, 0, 0, 1, 0.4}, "grip"},
      {{2.0, 1500.0, CRASHRANK_KIND_CAR, 0, 0, 1, 0.8, 2.0}, "harm"},
  };
  for (const auto& [told, place] : others) {
    const Scenario other = situation(told);
    EXPECT_EQ(crashrank_ranker_update(ranker.get(), other.get(), &error), CRASHRANK_USAGE) << place;
    EXPECT_NE(std::strstr(error.message, place), nullptr) << error.message;
  }
}

TEST(CApi, ActorsEnterAndLeaveWithUpdates) {
  const std::string file = CRASHRANK_SCENARIOS "/crossing_traffic.json";
  crashrank_error error{};
  constexpr std::size_t lorry = 1;
  constexpr std::size_t pole = 3;
  // Of the lorry and the pole.
  const auto with_existence = [&](double of_lorry, double of_pole) {
    Loaded made = load(file);
    EXPECT_EQ(crashrank_scenario_set_existence(made.scenario.get(), lorry, of_lorry, &error),
              CRASHRANK_OK);
    EXPECT_EQ(crashrank_scenario_set_existence(made.scenario.get(), pole, of_pole, &error),
              CRASHRANK_OK);
    return made;
  };
  const auto create = [&](const Loaded& from) {
    crashrank_ranker* made = nullptr;
    EXPECT_EQ(
        crashrank_ranker_create(from.scenario.get(), from.models.get(), nullptr, &made, &error),
        CRASHRANK_OK)
        << error.message;
    return Ranker(made);
  };
  const auto hash_of = [&](const Ranker& ranker) {
    auto answer = sized<crashrank_answer>();
    EXPECT_EQ(crashrank_ranker_rank(ranker.get(), nullptr, &answer, &error), CRASHRANK_OK);
    return answer.hash;
  };
  const Loaded empty = with_existence(0.0, 0.0);
  const Loaded full = with_existence(1.0, 0.0);
  const Ranker ranker = create(empty);
  const uint64_t without = hash_of(ranker);
  const uint64_t with = hash_of(create(full));
  EXPECT_NE(with, without);
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(crashrank_ranker_update(ranker.get(), full.scenario.get(), &error), CRASHRANK_OK)
        << error.message;
    EXPECT_EQ(hash_of(ranker), with);
    // Only some may be there, and what is fixed stays as it was.
    for (const auto& [of_lorry, of_pole] : {std::pair(0.5, 0.0), std::pair(1.0, 1.0)}) {
      const Loaded other = with_existence(of_lorry, of_pole);
      EXPECT_EQ(crashrank_ranker_update(ranker.get(), other.scenario.get(), &error),
                CRASHRANK_USAGE);
      EXPECT_NE(std::strstr(error.message, "actors"), nullptr) << error.message;
      EXPECT_EQ(hash_of(ranker), with);
    }
    ASSERT_EQ(crashrank_ranker_update(ranker.get(), empty.scenario.get(), &error), CRASHRANK_OK);
    EXPECT_EQ(hash_of(ranker), without);
  }
}

}  // namespace

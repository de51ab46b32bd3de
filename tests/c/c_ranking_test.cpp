#include "c/c_objects.hpp"
#include "crashrank/crashrank.hpp"
#include "crashrank/mesh/import.hpp"
#include "crashrank/model/make_model.hpp"
#include "crashrank/model/model.hpp"

#include <gtest/gtest.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

using namespace c_objects;

namespace {

TEST(CApi, AScenarioThatDoesNotFitIsRefusedByRank) {
  crashrank_error error{};
  crashrank_scenario* made = nullptr;
  ASSERT_EQ(crashrank_scenario_create("empty", &made, &error), CRASHRANK_OK);
  const Scenario scenario(made);
  const Models models = make_models();
  crashrank_ranking* ranking = nullptr;
  EXPECT_EQ(crashrank_rank(scenario.get(), models.get(), nullptr, &ranking, &error),
            CRASHRANK_BAD_INPUT);
  for (const crashrank_body_kind kind : {0, 10, -1, INT32_MIN, INT32_MAX}) {
    EXPECT_EQ(crashrank_scenario_add_model(scenario.get(), "car", kind, 0, &error),
              CRASHRANK_USAGE);
    EXPECT_NE(std::strstr(error.message, "kind: is "), nullptr) << error.message;
  }
  ASSERT_EQ(crashrank_scenario_add_model(scenario.get(), "car", CRASHRANK_KIND_CAR, 0, &error),
            CRASHRANK_OK);
  EXPECT_NE(crashrank_rank(scenario.get(), models.get(), nullptr, &ranking, &error), CRASHRANK_OK);
  auto body = sized<crashrank_body>();
  EXPECT_EQ(crashrank_scenario_set_body(scenario.get(), 1, &body, &error), CRASHRANK_USAGE);
  body.surface = 7;
  EXPECT_EQ(crashrank_scenario_set_body(scenario.get(), 0, &body, &error), CRASHRANK_USAGE);
  const double center_m[3] = {1.3, 0.0, 0.5};
  EXPECT_NE(std::strstr(error.message, "crashrank_body.surface"), nullptr) << error.message;
  body = sized<crashrank_body>();
  body.center_of_mass_m = center_m;
  body.yaw_inertia_kgm2 = 2000.0;
  body.surface = CRASHRANK_SURFACE_RUBBER;
  EXPECT_EQ(crashrank_scenario_set_body(scenario.get(), 0, &body, &error), CRASHRANK_OK);
  EXPECT_EQ(crashrank_scenario_set_ego_occupants(scenario.get(), 0.0, &error), CRASHRANK_OK);
  EXPECT_EQ(crashrank_scenario_set_actor_occupants(scenario.get(), 0, 2.0, &error),
            CRASHRANK_USAGE);
  EXPECT_EQ(crashrank_scenario_set_grid(scenario.get(), 102, 5, &error), CRASHRANK_USAGE);
  auto options = sized<crashrank_rank_options>();
  options.measure = 8;
  EXPECT_EQ(crashrank_rank(scenario.get(), models.get(), &options, &ranking, &error),
            CRASHRANK_USAGE);
  EXPECT_NE(std::strstr(error.message, "crashrank_rank_options.measure"), nullptr) << error.message;
  EXPECT_EQ(ranking, nullptr);
}

TEST(CApi, AScenarioFileIsRankedAsTheLibraryRanksIt) {
  const std::string file = CRASHRANK_SCENARIOS "/crossing_traffic.json";
  const auto [scenario, models] = load(file);
  crashrank_error error{};
  ASSERT_EQ(crashrank_models_size(models.get()), crashrank_scenario_model_count(scenario.get()));
  auto options = sized<crashrank_rank_options>();
  options.measure = CRASHRANK_MEASURE_AREA;
  options.json = 1;
  crashrank_ranking* answer = nullptr;
  ASSERT_EQ(crashrank_rank(scenario.get(), models.get(), &options, &answer, &error), CRASHRANK_OK)
      << error.message;
  const Ranking ranking(answer);

  using namespace crashrank;
  const Result<crashrank::Scenario> read = load_scenario_file(file);
  ASSERT_TRUE(read.ok());
  std::vector<Model> bodies;
  for (const ScenarioModel& wanted : read->models) {
    ImportOptions how;
    how.transform = wanted.transform;
    Result<ImportedMesh> mesh = import_mesh(wanted.path, how);
    ASSERT_TRUE(mesh.ok());
    Result<Model> model = make_model(std::move(mesh->mesh));
    ASSERT_TRUE(model.ok());
    bodies.push_back(std::move(*model));
  }
  RankOptions how;
  how.measure = Measure::area;
  const Result<RankResult> expected = rank(*read, bodies, how);
  ASSERT_TRUE(expected.ok());
  ASSERT_EQ(crashrank_ranking_size(ranking.get()), expected->ranking.size());
  EXPECT_STREQ(crashrank_ranking_unit(ranking.get()), "m2");
  for (size_t place = 0; place < expected->ranking.size(); ++place) {
    const CandidateResult& wanted = expected->ranking[place];
    auto choice = sized<crashrank_choice>();
    ASSERT_EQ(crashrank_ranking_get(ranking.get(), place, &choice, &error), CRASHRANK_OK);
    EXPECT_EQ(choice.candidate, expected->candidates[wanted.candidate].name);
    EXPECT_EQ(choice.score, *wanted.score);
    EXPECT_EQ(choice.contacts, wanted.contacts.size());
    const auto lacks_force = [](const FutureOutcome& each) { return each.contact_without_force; };
    EXPECT_EQ(choice.contact_without_force != 0,
              std::any_of(wanted.futures.begin(), wanted.futures.end(), lacks_force));
    EXPECT_EQ(choice.highest_score, wanted.score_interval.highest);
    size_t shared = 0;
    size_t sharing = 0;
    ASSERT_EQ(crashrank_ranking_place(ranking.get(), place, &shared, &sharing, &error),
              CRASHRANK_OK);
    EXPECT_EQ(shared, wanted.place);
    EXPECT_EQ(sharing, wanted.sharing);
    int32_t separable = 7;
    ASSERT_EQ(crashrank_ranking_separable(ranking.get(), place, &separable, &error), CRASHRANK_OK);
    const bool last = place + 1 == expected->ranking.size();
    EXPECT_EQ(separable, last ? -1 : wanted.separable ? 1 : 0);
    if (wanted.contacts.empty()) {
      EXPECT_EQ(choice.other, nullptr);
      EXPECT_TRUE(std::isnan(choice.time_of_impact_s));
    } else {
      EXPECT_EQ(choice.other, read->actors[wanted.contacts[0].actor].name);
      EXPECT_EQ(choice.time_of_impact_s, wanted.contacts[0].time_of_impact_s);
    }
  }
  auto choice = sized<crashrank_choice>();
  EXPECT_EQ(crashrank_ranking_get(ranking.get(), expected->ranking.size(), &choice, &error),
            CRASHRANK_USAGE);
  size_t shared = 0;
  EXPECT_EQ(crashrank_ranking_place(ranking.get(), 0, &shared, nullptr, nullptr), CRASHRANK_OK);
  EXPECT_EQ(
      crashrank_ranking_place(ranking.get(), expected->ranking.size(), &shared, nullptr, nullptr),
      CRASHRANK_USAGE);
  int32_t separable = 0;
  EXPECT_EQ(
      crashrank_ranking_separable(ranking.get(), expected->ranking.size(), &separable, nullptr),
      CRASHRANK_USAGE);
  // Character for character but for the time taken.
  const auto without_time = [](std::string json) {
    const std::size_t at = json.find("\"elapsed_s\"");
    return json.erase(at, json.find('\n', at) - at);
  };
  EXPECT_EQ(without_time(crashrank_ranking_json(ranking.get())),
            without_time(ranking_json(*read, bodies, *expected)));
}

TEST(CApi, ContactsBetweenOthersAreTheLibrarys) {
  const std::string file = CRASHRANK_SCENARIOS "/pushed_onto_crossing.json";
  const auto [scenario, models] = load(file);
  crashrank_error error{};
  for (const crashrank_measure measure :
       {CRASHRANK_MEASURE_HARM, CRASHRANK_MEASURE_CLOSING_ENERGY}) {
    const bool by_harm = measure == CRASHRANK_MEASURE_HARM;
    auto options = sized<crashrank_rank_options>();
    options.measure = measure;
    options.json = 1;
    crashrank_ranking* answer = nullptr;
    ASSERT_EQ(crashrank_rank(scenario.get(), models.get(), &options, &answer, &error), CRASHRANK_OK)
        << error.message;
    const Ranking ranking(answer);
    const auto json = nlohmann::json::parse(crashrank_ranking_json(ranking.get()));
    size_t all = 0;
    for (size_t place = 0; place < crashrank_ranking_size(ranking.get()); ++place) {
      size_t count = 0;
      for (const auto& wanted : json["ranking"][place]["contacts"]) {
        if (wanted.contains("other")) continue;  // the ego's
        auto contact = sized<crashrank_further_contact>();
        ASSERT_EQ(crashrank_ranking_further(ranking.get(), place, count, &contact, &error),
                  CRASHRANK_OK);
        EXPECT_EQ(wanted["bodies"][0], contact.a);
        EXPECT_EQ(wanted["bodies"][1], contact.b);
        EXPECT_EQ(wanted["time_of_impact_s"], contact.time_s);
        EXPECT_EQ(wanted["closing_speed_mps"], contact.closing_speed_mps);
        EXPECT_EQ(wanted["severity"]["a"]["delta_v_mps"], contact.a_delta_v_mps);
        EXPECT_EQ(wanted["severity"]["b"]["delta_v_mps"], contact.b_delta_v_mps);
        if (by_harm) {
          EXPECT_EQ(wanted["severity"]["harm"], contact.harm);
        } else {
          EXPECT_TRUE(std::isnan(contact.harm));
        }
        ++count;
      }
      EXPECT_EQ(crashrank_ranking_further_count(ranking.get(), place), count);
      auto contact = sized<crashrank_further_contact>();
      EXPECT_EQ(crashrank_ranking_further(ranking.get(), place, count, &contact, &error),
                CRASHRANK_USAGE);
      all += count;
    }
    EXPECT_GT(all, 0U);
    const size_t size = crashrank_ranking_size(ranking.get());
    EXPECT_EQ(crashrank_ranking_further_count(ranking.get(), size), 0U);
    auto contact = sized<crashrank_further_contact>();
    EXPECT_EQ(crashrank_ranking_further(ranking.get(), size, 0, &contact, nullptr),
              CRASHRANK_USAGE);
    EXPECT_EQ(crashrank_ranking_further(ranking.get(), 0, 0, nullptr, nullptr), CRASHRANK_USAGE);
  }
  EXPECT_EQ(crashrank_ranking_further_count(nullptr, 0), 0U);
}

TEST(CApi, MotionsAreTheLibrarysWhereAskedFor) {
  const auto [scenario, models] = load(CRASHRANK_SCENARIOS "/pushed_onto_crossing.json");
  crashrank_error error{};
  auto options = sized<crashrank_rank_options>();
  options.json = 1;
  options.motion = 1;
  crashrank_ranking* answer = nullptr;
  ASSERT_EQ(crashrank_rank(scenario.get(), models.get(), &options, &answer, &error), CRASHRANK_OK)
      << error.message;
  const Ranking ranking(answer);
  const auto json = nlohmann::json::parse(crashrank_ranking_json(answer));
  size_t most = 0;
  for (size_t place = 0; place < crashrank_ranking_size(answer); ++place) {
    const auto& wanted = json["ranking"][place]["motion"];
    const size_t count = crashrank_ranking_motion_count(answer, place);
    ASSERT_EQ(count, wanted.size());
    most = std::max(most, count);
    auto motion = sized<crashrank_body_motion>();
    for (size_t body = 0; body < count; ++body) {
      ASSERT_EQ(crashrank_ranking_motion(answer, place, body, &motion, &error), CRASHRANK_OK);
      EXPECT_EQ(wanted[body]["body"], motion.body);
      const auto expect_equal = [&](const char* key, const double* values, double unit = 1.0) {
        ASSERT_EQ(wanted[body][key].size(), motion.count);
        for (size_t k = 0; k < motion.count; ++k) {
          EXPECT_NEAR(wanted[body][key][k].get<double>(), values[k] * unit, 1e-9) << key;
        }
      };
      constexpr double deg_per_rad = 57.29577951308232;
      expect_equal("t_s", motion.t_s);
      expect_equal("x_m", motion.x_m);
      expect_equal("y_m", motion.y_m);
      expect_equal("yaw_deg", motion.yaw_rad, deg_per_rad);
      expect_equal("vx_mps", motion.vx_mps);
      expect_equal("vy_mps", motion.vy_mps);
      expect_equal("yaw_rate_dps", motion.yaw_rate_radps, deg_per_rad);
      for (size_t k = 0; k < motion.count; ++k) {
        EXPECT_EQ(wanted[body]["pressed"][k].get<bool>(), motion.pressed[k] == 1);
      }
    }
    EXPECT_EQ(crashrank_ranking_motion(answer, place, count, &motion, &error), CRASHRANK_USAGE);
  }
  EXPECT_GE(most, 2U);
  const size_t size = crashrank_ranking_size(answer);
  EXPECT_EQ(crashrank_ranking_motion_count(answer, size), 0U);
  EXPECT_EQ(crashrank_ranking_motion_count(nullptr, 0), 0U);
  EXPECT_EQ(crashrank_ranking_motion(answer, 0, 0, nullptr, nullptr), CRASHRANK_USAGE);
  EXPECT_EQ(crashrank_ranking_motion(nullptr, 0, 0, nullptr, nullptr), CRASHRANK_USAGE);

  options.motion = 0;
  ASSERT_EQ(crashrank_rank(scenario.get(), models.get(), &options, &answer, &error), CRASHRANK_OK);
  const Ranking without(answer);
  EXPECT_EQ(crashrank_ranking_motion_count(answer, 0), 0U);
}

/// The ego, 10 m/s, before a wall that stands still; scores by delta-v, which hangs on its
/// mass. The other stands to the left, so that centre of mass and inertia count, too.
double delta_v_of(double told_kg, double stored_kg, const crashrank::StatedMass& stated = {},
                  const crashrank_body* body = nullptr, const crashrank_body* wall = nullptr) {
  crashrank::TriangleMesh box;
  for (int i = 0; i < 8; ++i) {
    box.vertices.emplace_back((i & 1) != 0 ? 2.0F : -2.0F, (i & 2) != 0 ? 0.9F : -0.9F,
                              (i & 4) != 0 ? 1.4F : 0.2F);
  }
  for (const std::array<std::uint32_t, 4> q : std::vector<std::array<std::uint32_t, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    box.triangles.push_back({q[0], q[1], q[2]});
    box.triangles.push_back({q[0], q[2], q[3]});
  }
  crashrank::StoredModel stored;
  stored.model = *crashrank::make_model(box);
  stored.mass = crashrank::shell_properties(box);
  stored.stated = stated;
  if (stored_kg > 0.0) stored.stated.mass_kg = stored_kg;
  // Tests run side by side.
  const std::string file = testing::TempDir() + "/c_api_mass." + std::to_string(::getpid());
  EXPECT_TRUE(crashrank::save_model(stored, file, true).ok());

  crashrank_error error{};
  crashrank_scenario* made = nullptr;
  EXPECT_EQ(crashrank_scenario_create("mass", &made, &error), CRASHRANK_OK);
  const Scenario scenario(made);
  crashrank_scenario_add_model(scenario.get(), "ego", CRASHRANK_KIND_CAR, told_kg, &error);
  const bool stays = wall != nullptr && wall->breakaway_force_n == 0.0;
  crashrank_scenario_add_model(scenario.get(), "other",
                               wall != nullptr ? CRASHRANK_KIND_BUILDING : CRASHRANK_KIND_CAR,
                               stays ? 0.0 : 1500.0, &error);
  if (wall != nullptr) {
    EXPECT_EQ(crashrank_scenario_set_body(scenario.get(), 1, wall, &error), CRASHRANK_OK);
  }
  if (body != nullptr) {
    // Both shapes are of the one file.
    crashrank_scenario_set_body(scenario.get(), 0, body, &error);
    crashrank_scenario_set_body(scenario.get(), 1, body, &error);
  }
  auto ego = sized<crashrank_ego>();
  std::memcpy(ego.pose, identity, sizeof identity);
  ego.speed_mps = 10.0;
  EXPECT_EQ(crashrank_scenario_set_ego(scenario.get(), &ego, &error), CRASHRANK_OK);
  auto actor = sized<crashrank_actor>();
  actor.name = "stands";
  actor.model = 1;
  std::memcpy(actor.pose, identity, sizeof identity);
  actor.pose[3] = 8.0;
  actor.pose[7] = 0.8;
  EXPECT_EQ(crashrank_scenario_add_actor(scenario.get(), &actor, &error), CRASHRANK_OK);
  auto straight = sized<crashrank_candidate>();
  straight.name = "straight";
  EXPECT_EQ(crashrank_scenario_add_candidate(scenario.get(), &straight, &error), CRASHRANK_OK);
  EXPECT_EQ(crashrank_scenario_set_grid(scenario.get(), 0, 0, &error), CRASHRANK_OK);

  const Models models = make_models();
  EXPECT_EQ(crashrank_models_load(models.get(), file.c_str(), &error), CRASHRANK_OK);
  EXPECT_EQ(crashrank_models_load(models.get(), file.c_str(), &error), CRASHRANK_OK);
  std::remove(file.c_str());
  auto options = sized<crashrank_rank_options>();
  options.measure = CRASHRANK_MEASURE_DELTA_V;
  crashrank_ranking* answer = nullptr;
  EXPECT_EQ(crashrank_rank(scenario.get(), models.get(), &options, &answer, &error), CRASHRANK_OK)
      << error.message;
  const Ranking ranking(answer);
  auto choice = sized<crashrank_choice>();
  EXPECT_EQ(crashrank_ranking_get(ranking.get(), 0, &choice, &error), CRASHRANK_OK);

  auto how = sized<crashrank_ranker_options>();
  how.measure = CRASHRANK_MEASURE_DELTA_V;
  crashrank_ranker* prepared = nullptr;
  EXPECT_EQ(crashrank_ranker_create(scenario.get(), models.get(), &how, &prepared, &error),
            CRASHRANK_OK);
  const Ranker ranker(prepared);
  auto best = sized<crashrank_answer>();
  EXPECT_EQ(crashrank_ranker_rank(ranker.get(), nullptr, &best, &error), CRASHRANK_OK);
  EXPECT_EQ(best.count, 1U);
  EXPECT_EQ(best.ranking[0].lowest_score, choice.score);
  EXPECT_EQ(best.ranking[0].highest_score, choice.score);
  return choice.score;
}

TEST(CApi, TheMassThatAModelFileTellsCountsWhereTheScenarioGivesNone) {
  const double heavy = delta_v_of(0.0, 4000.0);
  EXPECT_EQ(heavy, delta_v_of(4000.0, 0.0));
  EXPECT_EQ(heavy, delta_v_of(4000.0, 900.0));
  EXPECT_GT(delta_v_of(0.0, 900.0), heavy);
}

TEST(CApi, CentreAndInertiaOfAModelFileCountWhereTheScenarioGivesNone) {
  const crashrank::StatedMass of_file{std::nullopt, Eigen::Vector3d(0.5, 0.3, 0.6), 900.0};
  const double center_m[3] = {0.5, 0.3, 0.6};
  auto body = sized<crashrank_body>();
  body.center_of_mass_m = center_m;
  body.yaw_inertia_kgm2 = 900.0;
  const double stated = delta_v_of(1500.0, 0.0, of_file);
  EXPECT_EQ(stated, delta_v_of(1500.0, 0.0, {}, &body));
  const crashrank::StatedMass other{std::nullopt, Eigen::Vector3d(-0.5, 0.0, 0.6), 2000.0};
  EXPECT_EQ(stated, delta_v_of(1500.0, 0.0, other, &body));
  EXPECT_NE(stated, delta_v_of(1500.0, 0.0, other));
  EXPECT_NE(stated, delta_v_of(1500.0, 0.0));
}

TEST(CApi, WhatBreaksAwayOrGivesWayTakesMoreGentlyThanAWall) {
  auto wall = sized<crashrank_body>();
  const double rigid = delta_v_of(1500.0, 0.0, {}, nullptr, &wall);
  wall.breakaway_force_n = 1e9;
  EXPECT_NEAR(delta_v_of(1500.0, 0.0, {}, nullptr, &wall), rigid, 0.01 * rigid);
  wall.breakaway_force_n = 1.0;
  EXPECT_LT(delta_v_of(1500.0, 0.0, {}, nullptr, &wall), 0.7 * rigid);
  wall.breakaway_force_n = 0.0;
  wall.deflection_m = 3.0;
  const double by_default = delta_v_of(1500.0, 0.0, {}, nullptr, &wall);
  EXPECT_LT(by_default, rigid);
  // Gives way so easily that most speed is left at the end of its way.
  wall.deflection_force_n = 1e3;
  const double soft = delta_v_of(1500.0, 0.0, {}, nullptr, &wall);
  EXPECT_LT(soft, rigid);
  EXPECT_GT(soft, by_default);
}

}  // namespace

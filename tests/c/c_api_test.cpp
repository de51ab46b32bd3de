#include "crashrank/crashrank.h"
#include "crashrank/crashrank.hpp"
#include "crashrank/mesh/import.hpp"
#include "crashrank/tree/model_file.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace {

template <auto Free> struct With {
  template <class T> void operator()(T* object) const { Free(object); }
};
using Models = std::unique_ptr<crashrank_models, With<crashrank_models_free>>;
using Query = std::unique_ptr<crashrank_query, With<crashrank_query_free>>;
using Scenario = std::unique_ptr<crashrank_scenario, With<crashrank_scenario_free>>;
using Ranker = std::unique_ptr<crashrank_ranker, With<crashrank_ranker_free>>;
using Ranking = std::unique_ptr<crashrank_ranking, With<crashrank_ranking_free>>;

/// Two crossing triangles and one apart.
const std::vector<float> vertices{0,  0,    0,    1, 0,    0,    0, 1, 0, 0.2F, 0.2F,
                                  -1, 0.2F, 0.2F, 1, 0.3F, 0.4F, 0, 9, 9, 9};
const std::vector<uint32_t> triangles{0, 1, 2, 3, 4, 5, 6, 6, 6};

constexpr double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

Models make_models() {
  crashrank_models* made = nullptr;
  EXPECT_EQ(crashrank_models_create(&made, nullptr), CRASHRANK_OK);
  return Models(made);
}

crashrank_status add(crashrank_models* models, const std::vector<crashrank_part>& parts = {},
                     crashrank_error* error = nullptr) {
  return crashrank_models_add(models, vertices.data(), vertices.size() / 3, triangles.data(),
                              triangles.size() / 3, parts.data(), parts.size(), error);
}

Query make_query() {
  crashrank_query* made = nullptr;
  EXPECT_EQ(crashrank_query_create(&made, nullptr), CRASHRANK_OK);
  return Query(made);
}

TEST(CApi, VersionsAreTheHeaders) {
  EXPECT_EQ(crashrank_abi_version(), CRASHRANK_ABI_VERSION);
  EXPECT_STREQ(crashrank_version(), CRASHRANK_VERSION_STRING);
}

TEST(CApi, PairsAreTheLibrarys) {
  const Models models = make_models();
  ASSERT_EQ(add(models.get()), CRASHRANK_OK);
  ASSERT_EQ(add(models.get()), CRASHRANK_OK);
  EXPECT_EQ(crashrank_models_size(models.get()), 2U);
  EXPECT_EQ(crashrank_models_triangles(models.get(), 1), 3U);
  EXPECT_STREQ(crashrank_models_part_name(models.get(), 0, 0), "body");
  const Query query = make_query();
  const crashrank_pair* pairs = nullptr;
  size_t count = 0;
  ASSERT_EQ(
      crashrank_collide_all(query.get(), models.get(), 0, 1, identity, &pairs, &count, nullptr),
      CRASHRANK_OK);
  // Each triangle touches itself, and the first two each other.
  const std::vector<crashrank::Pair> expected{{0, 0}, {0, 1}, {1, 0}, {1, 1}, {2, 2}};
  ASSERT_EQ(count, expected.size());
  for (size_t i = 0; i < count; ++i) {
    EXPECT_EQ(pairs[i].a, expected[i].a);
    EXPECT_EQ(pairs[i].b, expected[i].b);
  }
  char hash[17];
  ASSERT_EQ(crashrank_pairs_hash(pairs, count, hash, nullptr), CRASHRANK_OK);
  EXPECT_EQ(hash, crashrank::pairs_hash(expected));

  int32_t touching = -1;
  ASSERT_EQ(crashrank_collide_any(query.get(), models.get(), 0, 1, identity, &touching, nullptr),
            CRASHRANK_OK);
  EXPECT_EQ(touching, 1);
  double away[16];
  std::memcpy(away, identity, sizeof away);
  away[3] = 20.0;
  ASSERT_EQ(crashrank_collide_any(query.get(), models.get(), 0, 1, away, &touching, nullptr),
            CRASHRANK_OK);
  EXPECT_EQ(touching, 0);
}

TEST(CApi, PartsHaveToCoverTheTriangles) {
  const Models models = make_models();
  ASSERT_EQ(add(models.get(), {{"front", 1}, {"rear", 2}}), CRASHRANK_OK);
  EXPECT_EQ(crashrank_models_parts(models.get(), 0), 2U);
  EXPECT_STREQ(crashrank_models_part_name(models.get(), 0, 1), "rear");
  EXPECT_EQ(crashrank_models_part_name(models.get(), 0, 2), nullptr);
  crashrank_error error{};
  for (const std::vector<crashrank_part>& parts :
       std::vector<std::vector<crashrank_part>>{{{"front", 2}},
                                                {{"front", 2}, {"rear", 2}},
                                                {{"front", UINT32_MAX}, {"rear", 4}},
                                                {{"same", 1}, {"same", 2}},
                                                {{nullptr, 3}}}) {
    EXPECT_EQ(add(models.get(), parts, &error), CRASHRANK_BAD_INPUT);
    EXPECT_EQ(error.status, CRASHRANK_BAD_INPUT);
  }
  EXPECT_EQ(crashrank_models_size(models.get()), 1U);
}

TEST(CApi, MistakesAreStatusesWithAMessage) {
  crashrank_error error{};
  EXPECT_EQ(crashrank_models_create(nullptr, &error), CRASHRANK_USAGE);
  EXPECT_NE(error.message[0], '\0');
  const Models models = make_models();
  ASSERT_EQ(add(models.get()), CRASHRANK_OK);
  const uint32_t beyond[3] = {0, 1, 7};
  EXPECT_EQ(crashrank_models_add(models.get(), vertices.data(), 7, beyond, 1, nullptr, 0, &error),
            CRASHRANK_BAD_INPUT);
  EXPECT_EQ(crashrank_models_add(models.get(), vertices.data(), 7, beyond, 0, nullptr, 0, &error),
            CRASHRANK_BAD_INPUT);
  const float infinite[9] = {0, 0, 0, 1, 0, 0, 0, std::numeric_limits<float>::infinity(), 0};
  const uint32_t one[3] = {0, 1, 2};
  EXPECT_EQ(crashrank_models_add(models.get(), infinite, 3, one, 1, nullptr, 0, &error),
            CRASHRANK_BAD_INPUT);

  const Query query = make_query();
  int32_t touching = 7;
  double mirror[16];
  std::memcpy(mirror, identity, sizeof mirror);
  mirror[0] = -1.0;
  EXPECT_EQ(crashrank_collide_any(query.get(), models.get(), 0, 0, mirror, &touching, &error),
            CRASHRANK_BAD_INPUT);
  mirror[0] = std::nan("");
  EXPECT_EQ(crashrank_collide_any(query.get(), models.get(), 0, 0, mirror, &touching, &error),
            CRASHRANK_BAD_INPUT);
  EXPECT_EQ(crashrank_collide_any(query.get(), models.get(), 0, 1, identity, &touching, &error),
            CRASHRANK_USAGE);
  EXPECT_EQ(touching, 7);

  crashrank_scenario* none = nullptr;
  EXPECT_EQ(crashrank_scenario_load("no/such/scenario.json", &none, &error), CRASHRANK_NOT_FOUND);
  EXPECT_NE(std::string(error.message).find("scenario.json"), std::string::npos);
  EXPECT_EQ(crashrank_scenario_create_from_text("{", 1, "text\x1b[2J", &none, &error),
            CRASHRANK_BAD_INPUT);
  EXPECT_EQ(std::string(error.message).find('\x1b'), std::string::npos);
  EXPECT_EQ(none, nullptr);
}

TEST(CApi, LongMessagesAreCutBetweenCharacters) {
  crashrank_error error{};
  crashrank_scenario* none = nullptr;
  for (std::size_t letters = 500; letters < 512; ++letters) {
    std::string name(letters, 'x');
    for (int i = 0; i < 20; ++i) name += "\xc3\xa4";
    ASSERT_EQ(crashrank_scenario_create_from_text("{", 1, name.c_str(), &none, &error),
              CRASHRANK_BAD_INPUT);
    const std::string message = error.message;
    EXPECT_GE(message.size(), sizeof error.message - 2);
    const std::size_t last = message.find_last_not_of("\xc3\xa4");
    ASSERT_NE(last, std::string::npos);
    EXPECT_EQ((message.size() - 1 - last) % 2, 0U) << message;
  }
}

TEST(CApi, FreeingNothingDoesNothing) {
  crashrank_models_free(nullptr);
  crashrank_query_free(nullptr);
  crashrank_scenario_free(nullptr);
  crashrank_ranking_free(nullptr);
  EXPECT_EQ(crashrank_ranking_size(nullptr), 0U);
  EXPECT_EQ(crashrank_ranking_json(nullptr), nullptr);
  EXPECT_EQ(crashrank_scenario_model_name(nullptr, 0), nullptr);
}

TEST(CApi, AScenarioThatDoesNotFitIsRefusedByRank) {
  crashrank_error error{};
  crashrank_scenario* made = nullptr;
  ASSERT_EQ(crashrank_scenario_create("empty", &made, &error), CRASHRANK_OK);
  const Scenario scenario(made);
  const Models models = make_models();
  crashrank_ranking* ranking = nullptr;
  EXPECT_EQ(crashrank_rank(scenario.get(), models.get(), nullptr, &ranking, &error),
            CRASHRANK_BAD_INPUT);
  EXPECT_EQ(crashrank_scenario_add_model(scenario.get(), "car", "spaceship", 0, &error),
            CRASHRANK_USAGE);
  ASSERT_EQ(crashrank_scenario_add_model(scenario.get(), "car", "car", 0, &error), CRASHRANK_OK);
  EXPECT_NE(crashrank_rank(scenario.get(), models.get(), nullptr, &ranking, &error), CRASHRANK_OK);
  EXPECT_EQ(crashrank_scenario_set_grid(scenario.get(), 102, 5, &error), CRASHRANK_USAGE);
  crashrank_rank_options options{};
  options.measure = "beauty";
  EXPECT_EQ(crashrank_rank(scenario.get(), models.get(), &options, &ranking, &error),
            CRASHRANK_USAGE);
  EXPECT_EQ(ranking, nullptr);
}

TEST(CApi, AScenarioFileIsRankedAsTheLibraryRanksIt) {
  const std::string file = CRASHRANK_SCENARIOS "/crossing_traffic.json";
  crashrank_error error{};
  crashrank_scenario* made = nullptr;
  ASSERT_EQ(crashrank_scenario_load(file.c_str(), &made, &error), CRASHRANK_OK) << error.message;
  const Scenario scenario(made);
  const Models models = make_models();
  ASSERT_EQ(crashrank_models_import_scenario(models.get(), scenario.get(), &error), CRASHRANK_OK)
      << error.message;
  ASSERT_EQ(crashrank_models_size(models.get()), crashrank_scenario_model_count(scenario.get()));
  crashrank_rank_options options{};
  options.measure = "area";
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
    crashrank_choice choice{};
    ASSERT_EQ(crashrank_ranking_get(ranking.get(), place, &choice, &error), CRASHRANK_OK);
    EXPECT_EQ(choice.candidate, expected->candidates[wanted.candidate].name);
    EXPECT_EQ(choice.score, *wanted.score);
    EXPECT_EQ(choice.contacts, wanted.contacts.size());
    if (wanted.contacts.empty()) {
      EXPECT_EQ(choice.other, nullptr);
      EXPECT_TRUE(std::isnan(choice.time_of_impact_s));
    } else {
      EXPECT_EQ(choice.other, read->actors[wanted.contacts[0].actor].name);
      EXPECT_EQ(choice.time_of_impact_s, wanted.contacts[0].time_of_impact_s);
    }
  }
  crashrank_choice choice{};
  EXPECT_EQ(crashrank_ranking_get(ranking.get(), expected->ranking.size(), &choice, &error),
            CRASHRANK_USAGE);
  // Character for character but for the time taken.
  const auto without_time = [](std::string json) {
    const std::size_t at = json.find("\"elapsed_s\"");
    return json.erase(at, json.find('\n', at) - at);
  };
  EXPECT_EQ(without_time(crashrank_ranking_json(ranking.get())),
            without_time(ranking_json(*read, bodies, *expected)));
}

TEST(CApi, ARankerAnswersAsRankDoesAndWithinABudgetSoundly) {
  const std::string file = CRASHRANK_SCENARIOS "/crossing_traffic.json";
  crashrank_error error{};
  crashrank_scenario* made = nullptr;
  ASSERT_EQ(crashrank_scenario_load(file.c_str(), &made, &error), CRASHRANK_OK) << error.message;
  const Scenario scenario(made);
  const Models models = make_models();
  ASSERT_EQ(crashrank_models_import_scenario(models.get(), scenario.get(), &error), CRASHRANK_OK)
      << error.message;
  crashrank_ranker_options options{};
  options.measure = "closing-energy";
  crashrank_ranker* prepared = nullptr;
  ASSERT_EQ(crashrank_ranker_create(scenario.get(), models.get(), &options, &prepared, &error),
            CRASHRANK_OK)
      << error.message;
  const Ranker ranker(prepared);
  crashrank_answer full{};
  ASSERT_EQ(crashrank_ranker_rank(ranker.get(), nullptr, &full, &error), CRASHRANK_OK);
  EXPECT_EQ(full.complete, 1);
  EXPECT_EQ(full.proved, 1);

  crashrank_rank_options same{};
  same.measure = "closing-energy";
  crashrank_ranking* answer = nullptr;
  ASSERT_EQ(crashrank_rank(scenario.get(), models.get(), &same, &answer, &error), CRASHRANK_OK);
  const Ranking ranking(answer);
  ASSERT_EQ(full.size, crashrank_ranking_size(ranking.get()));
  std::vector<double> scores(full.size);
  for (size_t place = 0; place < full.size; ++place) {
    crashrank_choice choice{};
    ASSERT_EQ(crashrank_ranking_get(ranking.get(), place, &choice, &error), CRASHRANK_OK);
    const crashrank_ranked& ranked = full.ranking[place];
    EXPECT_STREQ(crashrank_ranker_candidate_name(ranker.get(), ranked.candidate), choice.candidate);
    EXPECT_EQ(ranked.score, choice.score);
    scores.at(ranked.candidate) = ranked.score;
  }

  const uint64_t hash = full.hash;
  crashrank_budget budget{};
  budget.work = 1;
  crashrank_answer cut{};
  ASSERT_EQ(crashrank_ranker_rank(ranker.get(), &budget, &cut, &error), CRASHRANK_OK);
  EXPECT_EQ(cut.complete, 0);
  ASSERT_EQ(cut.size, scores.size());
  for (size_t place = 0; place < cut.size; ++place) {
    const crashrank_ranked& ranked = cut.ranking[place];
    EXPECT_LE(ranked.lowest_score, scores.at(ranked.candidate));
    EXPECT_GE(ranked.highest_score, scores.at(ranked.candidate));
  }

  // A deadline that is over leaves no time, not all of it.
  crashrank_budget late{};
  late.deadline_s = -1e-3;
  crashrank_answer at_once{};
  ASSERT_EQ(crashrank_ranker_rank(ranker.get(), &late, &at_once, &error), CRASHRANK_OK);
  EXPECT_EQ(at_once.complete, 0);
  late.deadline_s = NAN;
  EXPECT_EQ(crashrank_ranker_rank(ranker.get(), &late, &at_once, &error), CRASHRANK_USAGE);

  ASSERT_EQ(crashrank_ranker_update(ranker.get(), scenario.get(), &error), CRASHRANK_OK);
  crashrank_answer again{};
  ASSERT_EQ(crashrank_ranker_rank(ranker.get(), nullptr, &again, &error), CRASHRANK_OK);
  EXPECT_EQ(again.hash, hash);
  EXPECT_EQ(crashrank_ranker_rank(nullptr, nullptr, &again, &error), CRASHRANK_USAGE);
  EXPECT_EQ(crashrank_ranker_candidate_name(ranker.get(), 1000), nullptr);
}

TEST(CApi, AModelFileLoadsAsTheModelItWasSavedFrom) {
  const crashrank::Result<crashrank::ImportedMesh> imported =
      crashrank::import_mesh(CRASHRANK_SCENARIOS "/../models/pole.obj");
  ASSERT_TRUE(imported.ok());
  crashrank::Result<crashrank::Model> model = crashrank::make_model(imported->mesh);
  ASSERT_TRUE(model.ok());
  crashrank::StoredModel stored;
  stored.model = *model;
  stored.mass = crashrank::shell_properties(model->mesh);
  const std::string file = testing::TempDir() + "/c_api_pole.crm";
  ASSERT_TRUE(crashrank::save_model(stored, file, true).ok());
  const Models models = make_models();
  crashrank_error error{};
  ASSERT_EQ(crashrank_models_load(models.get(), file.c_str(), &error), CRASHRANK_OK)
      << error.message;
  EXPECT_EQ(crashrank_models_import(models.get(), file.c_str(), &error), CRASHRANK_OK)
      << error.message;
  ASSERT_EQ(crashrank_models_size(models.get()), 2U);
  EXPECT_EQ(crashrank_models_triangles(models.get(), 0), model->mesh.size());
  EXPECT_EQ(crashrank_models_triangles(models.get(), 1), model->mesh.size());
  EXPECT_EQ(crashrank_models_load(models.get(), "no/such/model.crm", &error), CRASHRANK_NOT_FOUND);
  std::remove(file.c_str());
}

/// The ego, 10 m/s, before a wall that stands still; scores by delta-v, which hangs on its mass.
double delta_v_of(double told_kg, double stored_kg) {
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
  stored.mass.mass_kg = stored_kg;
  const std::string file = testing::TempDir() + "/c_api_mass.crm";
  EXPECT_TRUE(crashrank::save_model(stored, file, true).ok());

  crashrank_error error{};
  crashrank_scenario* made = nullptr;
  EXPECT_EQ(crashrank_scenario_create("mass", &made, &error), CRASHRANK_OK);
  const Scenario scenario(made);
  crashrank_scenario_add_model(scenario.get(), "ego", "car", told_kg, &error);
  crashrank_scenario_add_model(scenario.get(), "other", "car", 1500.0, &error);
  crashrank_ego ego{};
  std::memcpy(ego.pose, identity, sizeof identity);
  ego.speed_mps = 10.0;
  EXPECT_EQ(crashrank_scenario_set_ego(scenario.get(), &ego, &error), CRASHRANK_OK);
  crashrank_actor actor{};
  actor.name = "stands";
  actor.model = 1;
  std::memcpy(actor.pose, identity, sizeof identity);
  actor.pose[3] = 8.0;
  EXPECT_EQ(crashrank_scenario_add_actor(scenario.get(), &actor, &error), CRASHRANK_OK);
  crashrank_candidate straight{};
  straight.name = "straight";
  EXPECT_EQ(crashrank_scenario_add_candidate(scenario.get(), &straight, &error), CRASHRANK_OK);
  EXPECT_EQ(crashrank_scenario_set_grid(scenario.get(), 0, 0, &error), CRASHRANK_OK);

  const Models models = make_models();
  EXPECT_EQ(crashrank_models_load(models.get(), file.c_str(), &error), CRASHRANK_OK);
  EXPECT_EQ(crashrank_models_load(models.get(), file.c_str(), &error), CRASHRANK_OK);
  std::remove(file.c_str());
  crashrank_rank_options options{};
  options.measure = "delta-v";
  crashrank_ranking* answer = nullptr;
  EXPECT_EQ(crashrank_rank(scenario.get(), models.get(), &options, &answer, &error), CRASHRANK_OK)
      << error.message;
  const Ranking ranking(answer);
  crashrank_choice choice{};
  EXPECT_EQ(crashrank_ranking_get(ranking.get(), 0, &choice, &error), CRASHRANK_OK);

  crashrank_ranker_options how{};
  how.measure = "delta-v";
  crashrank_ranker* prepared = nullptr;
  EXPECT_EQ(crashrank_ranker_create(scenario.get(), models.get(), &how, &prepared, &error),
            CRASHRANK_OK);
  const Ranker ranker(prepared);
  crashrank_answer best{};
  EXPECT_EQ(crashrank_ranker_rank(ranker.get(), nullptr, &best, &error), CRASHRANK_OK);
  EXPECT_EQ(best.size, 1U);
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

TEST(CApi, AnUpdateRefusesWhatCreateRefuses) {
  crashrank_error error{};
  const Models models = make_models();
  ASSERT_EQ(add(models.get()), CRASHRANK_OK);
  const auto situation = [&](double speed, double yaw_rate) {
    crashrank_scenario* made = nullptr;
    EXPECT_EQ(crashrank_scenario_create("limits", &made, &error), CRASHRANK_OK);
    crashrank_scenario_add_model(made, "car", "car", 1500.0, &error);
    crashrank_ego ego{};
    std::memcpy(ego.pose, identity, sizeof identity);
    ego.speed_mps = speed;
    crashrank_scenario_set_ego(made, &ego, &error);
    crashrank_actor actor{};
    actor.name = "other";
    std::memcpy(actor.pose, identity, sizeof identity);
    actor.pose[3] = 30.0;
    actor.yaw_rate_radps = yaw_rate;
    crashrank_scenario_add_actor(made, &actor, &error);
    crashrank_candidate straight{};
    straight.name = "straight";
    crashrank_scenario_add_candidate(made, &straight, &error);
    return Scenario(made);
  };
  const Scenario good = situation(10.0, 0.0);
  crashrank_ranker* made = nullptr;
  ASSERT_EQ(crashrank_ranker_create(good.get(), models.get(), nullptr, &made, &error), CRASHRANK_OK)
      << error.message;
  const Ranker ranker(made);
  crashrank_answer answer{};
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

}  // namespace

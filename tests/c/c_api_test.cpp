#include "c/c_objects.hpp"
#include "crashrank/crashrank.hpp"
#include "crashrank/mesh/import.hpp"
#include "crashrank/model/make_model.hpp"
#include "crashrank/model/model.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

using namespace c_objects;

namespace {

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
  crashrank_body_state state = -1;
  ASSERT_EQ(crashrank_collide_state(query.get(), models.get(), 0, 1, away, &state, nullptr),
            CRASHRANK_OK);
  EXPECT_EQ(state, CRASHRANK_SEPARATE);
  ASSERT_EQ(crashrank_collide_state(query.get(), models.get(), 0, 1, identity, &state, nullptr),
            CRASHRANK_OK);
  EXPECT_EQ(state, CRASHRANK_INTERSECTING);
}

TEST(CApi, StatesAreTheLibrarys) {
  // A tetrahedron with corners at 0 and 8 on the axes, and one of a sixteenth of its size.
  const Models models = make_models();
  for (const float size : {8.0F, 0.5F}) {
    const float corners[12] = {0, 0, 0, size, 0, 0, 0, size, 0, 0, 0, size};
    const uint32_t faces[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    ASSERT_EQ(crashrank_models_add(models.get(), corners, 4, faces, 4, nullptr, 0, nullptr),
              CRASHRANK_OK);
    ASSERT_EQ(crashrank_models_add(models.get(), corners, 4, faces, 3, nullptr, 0, nullptr),
              CRASHRANK_OK);  // without its fourth face
  }
  const Query query = make_query();
  const double inside[16] = {1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 0, 1};
  const auto state = [&](size_t a, size_t b) {
    crashrank_body_state found = -1;
    EXPECT_EQ(crashrank_collide_state(query.get(), models.get(), a, b, inside, &found, nullptr),
              CRASHRANK_OK);
    return found;
  };
  EXPECT_EQ(state(0, 2), CRASHRANK_B_INSIDE_A);
  EXPECT_EQ(state(0, 3), CRASHRANK_B_INSIDE_A);
  EXPECT_EQ(state(1, 2), CRASHRANK_UNKNOWN_OPEN);
  EXPECT_EQ(crashrank_collide_state(query.get(), models.get(), 0, 1, inside, nullptr, nullptr),
            CRASHRANK_USAGE);
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

}  // namespace

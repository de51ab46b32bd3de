#include "crashrank/report/ranking.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

/// One triangle, its part named as asked.
Model flat_body(const std::string& part) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  mesh.parts = {{part, 0, 1}};
  Result<Model> model = make_model(std::move(mesh));
  EXPECT_TRUE(model.ok());
  return std::move(*model);
}

/// Three candidates as a deadline may leave them: one misses, one hits two bodies, one is known by
/// its interval alone.
struct Told {
  Told() {
    models.push_back(flat_body("hood"));
    models.push_back(flat_body("\x1b[31mdoor"));
    scenario.name = "told \"<b>\x1b[2J";
    scenario.models.resize(2);
    scenario.models[0].name = "car";
    scenario.models[1].name = "wall";
    scenario.models[1].kind = BodyKind::building;
    scenario.ego.model = 0;
    for (const char* name : {"wall", "second"}) {
      ScenarioActor actor;
      actor.name = name;
      actor.model = 1;
      scenario.actors.push_back(actor);
    }
    for (const char* name : {"miss", "hit", "unknown"}) {
      Candidate candidate;
      candidate.name = name;
      result.candidates.push_back(candidate);
    }
    CandidateResult miss;
    miss.candidate = 0;
    miss.score = 0.0;
    miss.grazes.push_back({1, 0.25});
    CandidateResult hit;
    hit.candidate = 1;
    hit.score = 3.0;
    hit.score_interval = {3.0, 3.0};
    hit.collides = true;
    for (const std::size_t actor : {0U, 1U}) {
      Contact contact;
      contact.actor = actor;
      contact.time_of_impact_s = 0.5 + static_cast<double>(actor);
      contact.closing_speed_mps = 10.0;
      contact.ego.triangles = {0};
      contact.ego.parts = {0};
      contact.other = contact.ego;
      contact.other.area_m2 = 0.5;
      hit.contacts.push_back(contact);
    }
    hit.ego = hit.contacts.front().ego;
    CandidateResult unknown;
    unknown.candidate = 2;
    unknown.score_interval = {1.0, 8.0};
    unknown.collides = true;
    result.ranking = {miss, hit, unknown};
    result.complete = false;
    result.in_race = {0, 2};
    result.ego = {0, 1500.0, false};
    const double fixed = std::numeric_limits<double>::infinity();
    result.actors = {{1, fixed, true}, {1, fixed, true}};
  }

  Scenario scenario;
  std::vector<Model> models;
  RankResult result;
};

TEST(RankingJson, SumsWhatIsHitAndLeavesOutWhatIsNotKnown) {
  const Told told;
  const std::string text = ranking_json(told.scenario, told.models, told.result);
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
  const auto answer = nlohmann::json::parse(text);
  EXPECT_EQ(answer["scenario"], told.scenario.name);
  EXPECT_EQ(answer["complete"], false);
  EXPECT_EQ(answer["in_race"], nlohmann::json::array({"miss", "unknown"}));
  EXPECT_TRUE(answer["actors"][0]["mass_kg"].is_null());  // does not move
  EXPECT_EQ(answer["ego"]["mass_kg"], 1500.0);

  const auto& miss = answer["ranking"][0];
  EXPECT_EQ(miss["score"], 0.0);
  EXPECT_TRUE(miss["other"].is_null());
  EXPECT_EQ(miss["damaged_parts"]["other"], nlohmann::json::array());
  EXPECT_EQ(miss["grazes"][0]["other"], "second");

  const auto& hit = answer["ranking"][1];
  EXPECT_EQ(hit["rank"], 2);
  EXPECT_EQ(hit["other"], "wall");
  EXPECT_EQ(hit["time_of_impact_s"], 0.5);
  EXPECT_EQ(hit["contacts"].size(), 2U);
  EXPECT_EQ(hit["contacts"][1]["other"], "second");
  EXPECT_EQ(hit["damaged_triangles"]["ego"], 1);
  EXPECT_EQ(hit["damaged_triangles"]["other"], 2);
  EXPECT_EQ(hit["damaged_area_m2"]["other"], 1.0);
  EXPECT_EQ(hit["damaged_parts"]["other"], nlohmann::json::array({"\x1b[31mdoor"}));

  const auto& unknown = answer["ranking"][2];
  EXPECT_TRUE(unknown["score"].is_null());
  EXPECT_EQ(unknown["score_interval"], nlohmann::json::array({1.0, 8.0}));
}

TEST(RankingText, IsSafeForATerminalAndSaysThatItIsPartial) {
  const Told told;
  const std::string text = ranking_text(told.scenario, told.models, told.result);
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
  for (const char* word : {"miss", "nothing (grazes)", "wall +1", "1 to 8", "the answer is partial",
                           "hood", "1 of 3 touch nothing"}) {
    EXPECT_NE(text.find(word), std::string::npos) << word << "\n" << text;
  }
  RankingTextOptions options;
  options.top = 1;
  const std::string short_text = ranking_text(told.scenario, told.models, told.result, options);
  EXPECT_EQ(short_text.find("wall"), std::string::npos);
  EXPECT_NE(short_text.find("and 2 more"), std::string::npos);
}

}  // namespace
}  // namespace crashrank

#include "crashrank/report/ranking.hpp"

#include "told_ranking.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>

namespace crashrank {
namespace {

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

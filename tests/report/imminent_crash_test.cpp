#include "crashrank/report/ranking.hpp"

#include "told_ranking.hpp"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace crashrank {
namespace {

/// Two candidates without contact; the second is 0.17 s before a crash with the second actor.
struct Imminent : Told {
  Imminent() {
    result.ranking[0].grazes.clear();
    result.ranking[0].least_distance_m = 1.25;
    result.ranking[0].nearest = 0;
    result.ranking[1] = result.ranking[0];
    result.ranking[1].candidate = 1;
    result.ranking[1].place = 2;
    result.ranking[1].least_distance_m = 4.5;
    set_time(1, 0.171);
    scenario.actors[1].name = "lorry <b>";
    scenario.horizon_s = 4.0;
  }
  void set_time(std::size_t place, double time_s) {
    result.ranking[place].time_to_collision_s = time_s;
    result.ranking[place].imminent = 1;
  }
  std::string text() const { return ranking_text(scenario, models, result); }
  std::string page() const { return html_report(scenario, models, result); }
};

void expect_part(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text.substr(0, 4000);
}

TEST(ImminentCrash, IsInTheRowOfItsCandidate) {
  const Imminent told;
  const std::string text = told.text();
  expect_part(text, "hit [0.17 s before a crash]");
  expect_part(text, "nothing, 4.50 m from wall, 0.17 s before a crash with lorry <b>");
  EXPECT_EQ(text.find("miss ["), std::string::npos);
  const std::string page = told.page();
  expect_part(page, "<em>0.17 s before a crash</em>");
  expect_part(page, "It is 0.17 s from a crash with lorry &lt;b&gt; at the horizon");
}

TEST(ImminentCrash, IsTheReasonOfAnOrderThatItDecides) {
  Imminent told;
  expect_part(
      told.page(),
      "because it is not 0.17 s from a crash with lorry &lt;b&gt; at the end of the horizon");
  told.set_time(0, 0.9);
  expect_part(told.page(),
              "because it is further from a crash at the end of the horizon, 0.90 s from a crash "
              "with lorry &lt;b&gt; against 0.17 s from a crash with lorry &lt;b&gt;");
  // Less than 10 ms does not decide.
  told.set_time(0, 0.172);
  told.result.ranking[0].least_distance_m = 4.75;
  expect_part(told.page(), "because it stays further from all others");
}

TEST(ImminentCrash, IsInTheJsonRow) {
  const Imminent told;
  const auto rows =
      nlohmann::json::parse(ranking_json(told.scenario, told.models, told.result))["ranking"];
  EXPECT_TRUE(rows[0]["time_to_collision_s"].is_null());
  EXPECT_TRUE(rows[0]["imminent"].is_null());
  EXPECT_EQ(rows[1]["time_to_collision_s"], 0.171);
  EXPECT_EQ(rows[1]["imminent"], "lorry <b>");
}

TEST(ImminentCrash, IsOneDoubtOfTheRanking) {
  Imminent told;
  const auto told_doubts = [&] {
    std::vector<std::string> all;
    for (const std::string& doubt : ranking_doubts(told.scenario, told.models, told.result)) {
      if (doubt.find("the horizon (4 s)") != std::string::npos) all.push_back(doubt);
    }
    return all;
  };
  ASSERT_EQ(told_doubts().size(), 1U);
  EXPECT_EQ(told_doubts()[0],
            "1 candidate reaches the horizon (4 s) without contact but close to a crash, which no "
            "score counts: 'hit', in place 2, 0.17 s before a crash with 'lorry <b>'; state a "
            "longer horizon_s");
  told.set_time(0, 0.9);
  ASSERT_EQ(told_doubts().size(), 1U);
  expect_part(told_doubts()[0], "2 candidates reach the horizon");
  expect_part(told_doubts()[0],
              "'miss', in place 1, 0.90 s before a crash with 'lorry <b>'; 'hit'");
  for (CandidateResult& each : told.result.ranking) {
    each.time_to_collision_s.reset();
    each.imminent.reset();
  }
  EXPECT_TRUE(told_doubts().empty());
}

}  // namespace
}  // namespace crashrank

#include "crashrank/report/ranking.hpp"

#include "told_ranking.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

const char* const evil = "</script><img src=x onerror=alert(1)>'\"&";

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

// What the page says, without its data and script.
std::string own_words(const std::string& page) { return page.substr(0, page.find("<script")); }

// What the page's script reads.
nlohmann::json data_of(const std::string& page) {
  const std::string opening = "<script type='application/json' id='page-data'>";
  const std::size_t from = page.find(opening) + opening.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script", from) - from));
}

TEST(HtmlReport, LetsNoNameOutOfItsPlace) {
  Told told;
  told.scenario.name = evil;
  told.scenario.description = evil;
  told.push_into(evil);
  told.scenario.actors[0].name = evil;
  told.result.candidates[1].name = evil;
  told.models[0].mesh.parts[0].name = evil;
  const std::string page = html_report(told.scenario, told.models, told.result);
  EXPECT_EQ(count(page, "<img"), count(page, "<img src='data:image/png;base64,"));
  EXPECT_EQ(page.find('\x1b'), std::string::npos);
  EXPECT_EQ(count(page, "<script"), count(page, "</script"));
  EXPECT_GE(count(page, "&lt;img src=x"), 4U);
}

TEST(HtmlReport, ListsAndMarksContactsBetweenOthers) {
  Told told;
  told.result.measure = Measure::harm;
  told.push_into("third");
  const std::string page = html_report(told.scenario, told.models, told.result);
  for (const char* words :
       {"<td>our car / wall</td><td class='n'>0.500</td>",
        "<td>wall / third</td><td class='n'>0.750</td><td class='n'>18</td>"
        "<td class='n'>22</td>",
        "<circle class='further'", "<title>wall / third, 0.750 s</title>",
        "others</h3>\n<ul><li>hit: wall is pushed into third", "; then second, wall / third"}) {
    EXPECT_NE(page.find(words), std::string::npos) << words;
  }
  EXPECT_LT(page.find("<td>our car / wall</td>"), page.find("<td>wall / third</td>"));
  EXPECT_LT(page.find("<td>wall / third</td>"), page.find("<td>our car / second</td>"));
  EXPECT_EQ(count(page, "<caption>wall</caption>"), 1U);
  EXPECT_EQ(count(page, "<caption>third</caption>"), 1U);
}

TEST(HtmlReport, AsksNothingOfTheNetwork) {
  const Told told;
  const std::string page = html_report(told.scenario, told.models, told.result);
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
  const std::string words = own_words(page);
  EXPECT_EQ(count(words, "src="), count(words, "src='data:image/png;base64,"));
  EXPECT_EQ(words.find("url("), std::string::npos);
  EXPECT_EQ(words.find("<link"), std::string::npos);
  EXPECT_EQ(count(words, "href="), count(words, "href='#c"));
}

TEST(HtmlReport, ListsEveryCandidateAndSaysThatThePlaceIsNotProved) {
  Told told;
  told.result.proved = false;
  HtmlReportOptions options;
  options.drawn = 1;
  const std::string page = html_report(told.scenario, told.models, told.result, options);
  EXPECT_EQ(data_of(page)["rows"].size(), 3U);
  EXPECT_EQ(count(page, "<tr data-row="), 2U);  // without its script the page shows the drawn ones
  EXPECT_EQ(count(page, "<section class='candidate'"), 2U);  // the best and the worst
  for (const char* word : {"the answer is partial", "still in the race: miss, unknown",
                           "nothing, but grazes", "Best guess so far: miss"}) {
    EXPECT_NE(page.find(word), std::string::npos) << word;
  }
}

TEST(HtmlReport, CarriesTheDamageThatWasTold) {
  Told told;
  told.push_into("third");
  const auto data = data_of(html_report(told.scenario, told.models, told.result));
  ASSERT_EQ(data["candidates"].size(), 3U);
  EXPECT_TRUE(data["candidates"][0]["bodies"].empty());  // the best one hits nothing
  const auto& bodies = data["candidates"][1]["bodies"];
  ASSERT_EQ(bodies.size(), 4U);  // the wall, hit twice, is in it once
  for (const auto& body : bodies) EXPECT_EQ(body["damage"], "AAE=");  // 0 intact, 1 damaged
  EXPECT_EQ(data["candidates"][1]["contacts"].size(), 3U);
  EXPECT_EQ(data["models"][0]["mesh"]["indices"], "AAABAAIA");  // 0, 1, 2
}

TEST(HtmlReport, PlaysTheSimulatedMotionFromWhereThePlanEnds) {
  Told told;
  told.scenario.horizon_s = 2.0;
  Pose start;
  start.translation = {-2.0, 0.0, 0.0};
  ArcMotion plan;
  plan.start = start;
  plan.speed_mps = 4.0;
  told.result.candidates[1].motion = plan;
  BodyMotion motion;
  // The centre of mass is 1 m before the origin, which is at 0 when the contact begins.
  motion.t_s = {0.5, 1.0, 1.5};
  motion.x_m = {1.0, 2.0, 2.0};
  motion.y_m = {0.0, 0.0, 0.0};
  motion.yaw_rad = {0.0, 0.0, 3.0};
  motion.vx_mps = {4.0, 0.0, 0.0};
  motion.vy_mps = {0.0, 0.0, 0.0};
  motion.yaw_rate_radps = {0.0, 0.0, 0.0};
  motion.pressed = {0, 1, 1};
  told.result.ranking[1].motion = {motion};
  const auto body =
      data_of(html_report(told.scenario, told.models, told.result))["candidates"][1]["bodies"][0];
  EXPECT_EQ(body["motion"]["t"], (std::vector<int>{500, 1000, 1500}));
  EXPECT_EQ(body["motion"]["x"], (std::vector<int>{0, 1000, 2990}));
  EXPECT_EQ(body["motion"]["a"], (std::vector<int>{0, 0, 30000}));
  EXPECT_EQ(body["exposure"]["v"], (std::vector<int>{0, 0}));
}

TEST(HtmlReport, SaysWhatIsToBeDoneInOneSentence) {
  Told told;
  told.result.measure = Measure::harm;
  told.result.ranking[0].grazes.clear();
  const auto sentence = [&told] {
    const std::string page = html_report(told.scenario, told.models, told.result);
    const std::size_t from = page.find("<h2>") + 4;
    return page.substr(from, page.find("</h2>") - from);
  };
  EXPECT_EQ(sentence(), "No crash needed: miss touches nothing.");
  told.result.ranking[0].least_distance_m = 1.234;
  told.result.ranking[0].nearest = 1;
  EXPECT_EQ(sentence(), "No crash needed: miss touches nothing and stays 1.2 m away from second.");
  std::swap(told.result.ranking[0], told.result.ranking[1]);
  told.result.ranking[0].people = {{ego_body, 1.0, 0.1, 3.0, 0.0, 0.5},
                                   {0, 2.0, 0.05, 3.0, 0.0, 0.5}};
  EXPECT_EQ(sentence(), "Hit: about 19 in 100 that somebody is seriously hurt.");
  // A bar is as long as the chance.
  const std::string page = html_report(told.scenario, told.models, told.result);
  EXPECT_NE(page.find("<span style='width:18.8%'>"), std::string::npos);
}

TEST(HtmlReport, TellsABrushFromAHit) {
  Told told;
  Contact& contact = told.result.ranking[1].contacts[0];
  contact.closing_speed_mps = 20.0;
  contact.severity.ego.delta_v_mps = 1.0;
  contact.severity.other.delta_v_mps = 2.0;
  const std::string brush =
      "<td data-title=''>glances off wall after 0.50 s at 72 km/h, changes its "
      "velocity by 7 km/h; then second</td>";
  const std::string page = html_report(told.scenario, told.models, told.result);
  EXPECT_NE(page.find(brush), std::string::npos);
  EXPECT_NE(page.find("<p>It glances off wall after 0.50 s at 72 km/h and hits second"),
            std::string::npos);
  EXPECT_EQ(page.find("It hits wall"), std::string::npos);
  contact.severity.ego.delta_v_mps = 8.0;
  const std::string hit = "<td data-title='hits '>wall after 0.50 s at 72 km/h; then second</td>";
  EXPECT_NE(html_report(told.scenario, told.models, told.result).find(hit), std::string::npos);
}

TEST(HtmlReport, SaysThatTheFirstStillCrashes) {
  Told told;
  told.result.ranking[0].grazes.clear();
  const auto page = [&told] { return html_report(told.scenario, told.models, told.result); };
  EXPECT_EQ(page().find("It still"), std::string::npos);
  std::swap(told.result.ranking[0], told.result.ranking[1]);
  Contact& contact = told.result.ranking[0].contacts[0];
  contact.closing_speed_mps = 20.0;
  contact.severity.ego.delta_v_mps = 10.0;
  EXPECT_NE(page().find("<li>It still crashes into wall at 72 km/h, then hits second.</li>"),
            std::string::npos);
  contact.severity.ego.delta_v_mps = 2.0;
  EXPECT_NE(page().find("<li>It still glances off wall at 72 km/h, then hits second.</li>"),
            std::string::npos);
}

TEST(HtmlReport, SaysWhatIsNearlyAsGoodAndWhatBrakesStraightOn) {
  Told told;
  told.result.ranking[0].separable = false;
  const auto page = [&told] { return html_report(told.scenario, told.models, told.result); };
  EXPECT_NE(page().find("<li>Nearly as good: hit, "), std::string::npos);
  EXPECT_EQ(page().find("best braking straight on"), std::string::npos);
  told.result.ranking[0].separable = true;
  EXPECT_EQ(page().find("Nearly as good"), std::string::npos);
  // Between the next best and the worst.
  CandidateResult last = told.result.ranking[2];
  told.result.candidates[last.candidate].acceleration_mps2 = -5.0;
  told.result.candidates.emplace_back().name = "last";
  last.candidate = 3;
  told.result.ranking.push_back(last);
  EXPECT_NE(page().find("best braking straight on</span>unknown"), std::string::npos);
}

}  // namespace
}  // namespace crashrank

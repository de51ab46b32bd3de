#include "crashrank/report/ranking.hpp"

#include "told_ranking.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>

namespace crashrank {
namespace {

const char* const evil = "</script><img src=x onerror=alert(1)>'\"&";

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

// What the page says, without the library that it carries.
std::string own_words(const std::string& page) { return page.substr(0, page.find("<script>")); }

TEST(HtmlReport, LetsNoNameOutOfItsPlace) {
  Told told;
  told.scenario.name = evil;
  told.scenario.description = evil;
  told.push_into(evil);
  told.scenario.actors[0].name = evil;
  told.result.candidates[1].name = evil;
  told.models[0].mesh.parts[0].name = evil;
  const std::string page = html_report(told.scenario, told.models, told.result);
  EXPECT_EQ(count(page, "<img"), count(page, "<img alt='' src='data:image/png;base64,"));
  EXPECT_EQ(page.find('\x1b'), std::string::npos);
  EXPECT_EQ(count(page, "<script"), count(page, "</script"));
  EXPECT_GE(count(page, "&lt;img src=x"), 4U);
}

TEST(HtmlReport, ListsAndMarksContactsBetweenOthers) {
  Told told;
  told.result.measure = Measure::harm;
  told.push_into("third");
  const std::string page = html_report(told.scenario, told.models, told.result);
  for (const char* words : {"<td>ego / wall</td><td class='n'>0.500</td>",
                            "<td>wall / third</td><td class='n'>0.750</td><td class='n'>5.0</td>"
                            "<td class='n'>6.2</td>",
                            "<circle class='further'", "<title>wall / third, 0.750 s</title>",
                            "Hurt by a contact between others:<br>hit: wall is pushed into third",
                            "wall, second, wall / third"}) {
    EXPECT_NE(page.find(words), std::string::npos) << words;
  }
  EXPECT_LT(page.find("<td>ego / wall</td>"), page.find("<td>wall / third</td>"));
  EXPECT_LT(page.find("<td>wall / third</td>"), page.find("<td>ego / second</td>"));
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
  EXPECT_EQ(count(page, "<tr data-place="), 3U);
  EXPECT_EQ(count(page, "<section class='candidate'"), 2U);  // the best and the worst
  for (const char* word : {"the answer is partial", "still in the race: miss, unknown",
                           "nothing, but grazes", "Best guess so far: miss"}) {
    EXPECT_NE(page.find(word), std::string::npos) << word;
  }
}

TEST(HtmlReport, CarriesTheDamageThatWasTold) {
  Told told;
  told.push_into("third");
  const std::string page = html_report(told.scenario, told.models, told.result);
  const std::string opening = "<script type='application/json' id='view-data'>";
  const std::size_t begin = page.find(opening);
  if (begin == std::string::npos) {
    EXPECT_NE(page.find("built without three.js"), std::string::npos);
    return;
  }
  const std::size_t from = begin + opening.size();
  const auto data = nlohmann::json::parse(page.substr(from, page.find("</script", from) - from));
  ASSERT_EQ(data["scenes"].size(), 2U);  // of three candidates one hits; the best one does not
  for (const auto& body : data["scenes"]["1"]["bodies"]) EXPECT_EQ(body["damaged"], "AA==");
  const auto& bodies = data["scenes"]["2"]["bodies"];
  ASSERT_EQ(bodies.size(), 4U);  // the wall, hit twice, stands in it once
  for (const auto& body : bodies) EXPECT_EQ(body["damaged"], "AQ==");  // the first triangle
  EXPECT_EQ(data["models"]["0"]["indices"], "AAAAAAEAAAACAAAA");       // 0, 1, 2
}

}  // namespace
}  // namespace crashrank

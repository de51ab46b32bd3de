#include "crashrank/report/ranking.hpp"
#include "crashrank/internal/report/escape.hpp"

#include "told_ranking.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

TEST(RankingJson, SumsWhatIsHitAndLeavesOutWhatIsNotKnown) {
  Told told;
  told.result.ranking[1].contacts[0].severity.ego.crush_m = 0.12;
  told.result.ranking[1].contacts[0].travel_m = 0.34;
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
  EXPECT_EQ(hit["contacts"][0]["crush_m"], 0.12);
  EXPECT_EQ(hit["contacts"][0]["travel_m"], 0.34);
  EXPECT_EQ(hit["contacts"][1]["other"], "second");
  EXPECT_EQ(hit["damaged_triangles"]["ego"], 1);
  EXPECT_EQ(hit["damaged_triangles"]["other"], 2);
  EXPECT_EQ(hit["damaged_area_m2"]["other"], 1.0);
  EXPECT_EQ(hit["damaged_parts"]["other"], nlohmann::json::array({"\x1b[31mdoor"}));

  const auto& unknown = answer["ranking"][2];
  EXPECT_TRUE(unknown["score"].is_null());
  EXPECT_EQ(unknown["score_interval"], nlohmann::json::array({1.0, 8.0}));
  EXPECT_EQ(unknown["score_estimate"], 2.5);
  EXPECT_TRUE(hit["score_estimate"].is_null());
}

TEST(RankingText, IsSafeForATerminalAndSaysThatItIsPartial) {
  const Told told;
  const std::string text = ranking_text(told.scenario, told.models, told.result);
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
  for (const char* word :
       {"miss", "nothing, but grazes", "wall +1", "1 to 8", "not every score is known", "hood",
        "1 of 3 are known to touch nothing", "not known yet"}) {
    EXPECT_NE(text.find(word), std::string::npos) << word << "\n" << text;
  }
  RankingTextOptions options;
  options.top = 1;
  const std::string short_text = ranking_text(told.scenario, told.models, told.result, options);
  EXPECT_EQ(short_text.find("wall"), std::string::npos);
  EXPECT_NE(short_text.find("and 2 more"), std::string::npos);
}

/// The same ranking by harm, with what is not known.
Told by_harm() {
  Told told;
  RankResult& result = told.result;
  result.measure = Measure::harm;
  result.complete = true;
  result.samples.resize(129 + numerical_samples);
  for (std::size_t i = 129; i < result.samples.size(); ++i) result.samples[i].numerical = true;
  result.harm.weights.cyclist = 0.75;
  result.harm.weights.people_in_bus = 31.0;
  CandidateResult& hit = result.ranking[1];
  hit.score = 0.2174;
  hit.score_interval = {0.1634, 0.3512};
  hit.best_place = 1;
  hit.worst_place = 2;
  hit.overtaken = 0.38;
  hit.separable = false;
  hit.numerical_interval = {0.2, 0.22};
  CandidateResult& last = result.ranking[2];
  last.score = 4321.987;
  last.score_interval = {4000.0, 4999.0};
  return told;
}

TEST(RankingText, TellsNoDigitThatTheIntervalLeavesOpen) {
  const Told told = by_harm();
  const std::string text = ranking_text(told.scenario, told.models, told.result);
  for (const char* word :
       {"0.2 ", "0.1 to 0.4", "4300", "4000 to 5000", "2-3", "not separable", "38 %", "129 samples",
        "cyclist 0.75", "31 in a bus", "MAIS3+", "choice", "Friction", "restitution"}) {
    EXPECT_NE(text.find(word), std::string::npos) << word << "\n" << text;
  }
  EXPECT_NE(text.find("rank 2 and 3 not separable"), std::string::npos) << text;
  Told close = by_harm();
  close.result.ranking[1].overtaken = 0.0;
  close.result.ranking[1].within_numerical_error = true;
  const std::string aside = ranking_text(close.scenario, close.models, close.result);
  EXPECT_NE(aside.find("not separable (longer steps or 1 mm aside may turn their order)"),
            std::string::npos)
      << aside;
  EXPECT_EQ(text.find("0.21"), std::string::npos) << text;
  EXPECT_EQ(text.find("4321"), std::string::npos) << text;
  // Without ranges everything is told, and nothing about stability.
  Told plain = by_harm();
  plain.result.ranking[1].score_interval = {0.2174, 0.2174};
  plain.result.ranking[1].separable = true;
  const std::string exact = ranking_text(plain.scenario, plain.models, plain.result);
  EXPECT_NE(exact.find("0.2174"), std::string::npos) << exact;
  EXPECT_EQ(exact.find("separable"), std::string::npos) << exact;
}

TEST(RankingText, NeighboursInARowHaveOneLineForEachReason) {
  Told told = by_harm();
  std::vector<CandidateResult>& ranking = told.result.ranking;
  const CandidateResult hit = ranking[1];
  ranking.assign(6, hit);
  const std::vector<double> overtaken{0.1, 0.38, 0.2, 0.0, 0.3, 0.0};
  for (std::size_t i = 0; i < ranking.size(); ++i) {
    ranking[i].place = i + 1;
    ranking[i].score = 0.01 * static_cast<double>(i + 1);
    ranking[i].overtaken = overtaken[i];
  }
  const std::string text = ranking_text(told.scenario, told.models, told.result);
  EXPECT_NE(
      text.find("rank 1 to 4 not separable from the next (the order reverses in 10 to 38 % of "
                "129 samples)\n"
                "rank 4 and 5 not separable (longer steps or 1 mm aside may turn their order)\n"
                "rank 5 and 6 not separable (the order reverses in 30 % of 129 samples)\n"),
      std::string::npos)
      << text;
}

TEST(RankingText, LinesFitATerminal) {
  Told told = by_harm();
  for (Candidate& candidate : told.result.candidates) {
    candidate.name += " with a name that says all that the manoeuvre does";
  }
  const std::string whole = ranking_text(told.scenario, told.models, told.result);
  RankingTextOptions options;
  for (const std::size_t width : {80U, 100U, 140U, 1000U}) {
    options.width = width;
    const std::string text = ranking_text(told.scenario, told.models, told.result, options);
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      EXPECT_LE(display_width(line), width) << line;
      EXPECT_TRUE(line.empty() || line.back() != ' ') << line;
    }
    EXPECT_EQ(text == whole, width == 1000U);
    for (const char* word : {"hit with a name", "harm", "0.2 ", "2-3", "exposure"}) {
      EXPECT_NE(text.find(word), std::string::npos) << word << '\n' << text;
    }
  }
}

/// Three candidates by harm, the second and third tied.
Told with_a_tie() {
  Told told = by_harm();
  RankResult& result = told.result;
  result.candidates[2].name = "as \x1b[1mhit";
  CandidateResult& hit = result.ranking[1];
  hit.overtaken = 0.0;
  hit.sharing = 2;
  result.ranking[2] = hit;
  result.ranking[2].candidate = 2;
  return told;
}

TEST(RankingText, TiesShareAPlaceAndAreNamed) {
  const Told told = with_a_tie();
  const std::string text = ranking_text(told.scenario, told.models, told.result);
  EXPECT_NE(text.find("rank 2: 2 candidates are tied (hit, as "), std::string::npos) << text;
  EXPECT_NE(text.find("2 tied"), text.rfind("2 tied")) << text;
  EXPECT_EQ(text.find("not separable"), std::string::npos) << text;
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
}

TEST(RankingJson, TiesShareARankAndNameEachOther) {
  const Told told = with_a_tie();
  const auto answer = nlohmann::json::parse(ranking_json(told.scenario, told.models, told.result));
  const auto& rows = answer["ranking"];
  EXPECT_EQ(rows[0]["rank"], 1);
  EXPECT_EQ(rows[0]["tied_with"], nlohmann::json::array());
  EXPECT_EQ(rows[1]["rank"], 2);
  EXPECT_EQ(rows[1]["tied_with"], nlohmann::json::array({"as \x1b[1mhit"}));
  EXPECT_EQ(rows[2]["rank"], 2);
  EXPECT_EQ(rows[2]["tied_with"], nlohmann::json::array({"hit"}));
  EXPECT_EQ(rows[1]["separable_from_next"], false);
  EXPECT_TRUE(answer["stability"]["not_separable"].empty());
}

TEST(RankingJson, TellsStabilityAndEveryWeight) {
  const Told told = by_harm();
  const auto answer = nlohmann::json::parse(ranking_json(told.scenario, told.models, told.result));
  EXPECT_EQ(answer["stability"]["samples"], 129);
  EXPECT_EQ(answer["stability"]["numerical_samples"], 3);
  EXPECT_EQ(answer["stability"]["not_separable"][0]["within_numerical_error"], false);
  EXPECT_EQ(answer["ranking"][1]["numerical_interval"], nlohmann::json::array({0.2, 0.22}));
  ASSERT_EQ(answer["stability"]["not_separable"].size(), 1U);
  EXPECT_EQ(answer["stability"]["not_separable"][0]["ranks"], nlohmann::json::array({2, 3}));
  EXPECT_EQ(answer["ranking"][1]["places"], nlohmann::json::array({2, 3}));
  EXPECT_EQ(answer["ranking"][1]["separable_from_next"], false);
  EXPECT_EQ(answer["ranking"][1]["overtaken_share"], 0.38);
  for (const char* weight :
       {"ego_occupant", "other_occupant", "pedestrian", "cyclist", "motorcyclist",
        "property_per_mj", "people_in_ego", "people_in_car", "people_in_truck", "people_in_bus"}) {
    EXPECT_TRUE(answer["harm"]["weights"][weight].is_number()) << weight;
  }
  EXPECT_EQ(answer["harm"]["weights"]["cyclist"], 0.75);
  EXPECT_TRUE(answer["harm"]["least_struck_share"].is_number());
  EXPECT_EQ(answer["harm"]["after_contact"], "brakes");
}

TEST(RankingJson, ListsContactsBetweenOthersInTheOrderOfTime) {
  Told told = by_harm();
  told.push_into("third");
  told.result.ranking[1].contacts[0].severity.ego.delta_v_mps = 2.5;
  told.result.ranking[1].contacts[0].severity.other.delta_v_mps = 7.5;
  told.result.ranking[1].crowded = true;
  const auto answer = nlohmann::json::parse(ranking_json(told.scenario, told.models, told.result));
  const auto& hit = answer["ranking"][1];
  ASSERT_EQ(hit["contacts"].size(), 3U);
  const std::vector<std::vector<std::string>> bodies{
      {"ego", "wall"}, {"wall", "third"}, {"ego", "second"}};
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto& contact = hit["contacts"][i];
    EXPECT_EQ(contact["bodies"], nlohmann::json(bodies[i]));
    EXPECT_EQ(contact.contains("other"), i != 1);
    EXPECT_EQ(contact["severity"].contains("ego"), i != 1);
    EXPECT_EQ(contact["damaged_triangles"].contains("ego"), i != 1);
    EXPECT_EQ(contact["damaged_triangles"].contains("a"), i == 1);
  }
  const auto& own = hit["contacts"][0]["severity"];
  EXPECT_EQ(own["a"], own["ego"]);
  EXPECT_EQ(own["b"], own["other"]);
  EXPECT_EQ(own["a"]["delta_v_mps"], 2.5);
  EXPECT_EQ(own["b"]["delta_v_mps"], 7.5);
  const auto& pushed = hit["contacts"][1];
  EXPECT_EQ(pushed["time_of_impact_s"], 0.75);
  EXPECT_EQ(pushed["closing_speed_mps"], 5.0);
  EXPECT_EQ(pushed["severity"]["a"]["delta_v_mps"], 1.5);
  EXPECT_EQ(pushed["severity"]["b"]["delta_v_mps"], 3.5);
  EXPECT_EQ(pushed["severity"]["harm"], 0.31);
  EXPECT_EQ(pushed["damaged_parts"]["b"], nlohmann::json::array({"\x1b[31mdoor"}));
  // Three bodies of one damaged triangle each; that of the wall is hit twice.
  EXPECT_EQ(hit["damaged_triangles"]["other"], 3);
  EXPECT_EQ(hit["damaged_area_m2"]["other"], 1.5);
  EXPECT_EQ(hit["crowded"], true);
  EXPECT_EQ(answer["ranking"][0]["crowded"], false);
}

TEST(RankingText, ShowsTheExposureAndTheDeepestCrush) {
  Told told = by_harm();
  std::vector<Contact>& contacts = told.result.ranking[1].contacts;
  contacts[0].severity.ego.delta_v_mps = contacts[1].severity.ego.delta_v_mps = 11.1;
  contacts[0].severity.ego.exposure_mps = contacts[1].severity.ego.exposure_mps = 17.25;
  contacts[0].severity.ego.crush_m = 0.12;
  contacts[1].severity.ego.crush_m = 0.34;
  const std::string text = ranking_text(told.scenario, told.models, told.result);
  const std::size_t row = text.find("wall +1");
  ASSERT_NE(row, std::string::npos) << text;
  const std::string line = text.substr(row, text.find('\n', row) - row);
  EXPECT_NE(line.find(" 17.2 "), std::string::npos) << line;
  EXPECT_NE(line.find(" 0.34 "), std::string::npos) << line;
  EXPECT_NE(text.find("exposure m/s"), std::string::npos) << text;
}

TEST(RankingText, SaysWhomACandidateHitsInAFutureThatIsNotTheLikeliest) {
  Told told = by_harm();
  told.result.futures.method = FutureMethod::all;
  told.result.complete = true;
  CandidateResult& miss = told.result.ranking.front();
  ASSERT_FALSE(miss.collides);
  miss.collision_probability = 0.304;
  miss.futures.resize(4);
  miss.futures[0].probability = 0.696;
  miss.futures[0].is_likeliest = true;
  // The wall is the most probable single collision, but the second body is hit more probably.
  constexpr std::array<double, 4> probabilities{0.696, 0.1, 0.124, 0.08};
  for (const std::size_t k : {1U, 2U, 3U}) {
    miss.futures[k].probability = probabilities[k];
    miss.futures[k].collides = true;
    miss.futures[k].actor = k == 2 ? 0 : 1;
    miss.futures[k].time_of_impact_s = k == 1 ? 1.25 : 1.75;
    miss.futures[k].closing_speed_mps = 19.72;
  }
  const std::string text = ranking_text(told.scenario, told.models, told.result);
  EXPECT_NE(
      text.find("collides with a probability of 30 %; most probably with second (18 %), likeliest "
                "after 1.250 s, closing with 19.7 m/s."),
      std::string::npos)
      << text;
  EXPECT_EQ(text.find("most probably with wall"), std::string::npos) << text;
}

TEST(RankingText, SaysWhoIsHurtByAContactBetweenOthers) {
  Told told = by_harm();
  told.push_into("third \x1b[2J");
  const std::string text = ranking_text(told.scenario, told.models, told.result);
  EXPECT_NE(text.find("wall +2"), std::string::npos) << text;
  EXPECT_NE(text.find("\nhit: wall is pushed into third "), std::string::npos) << text;
  EXPECT_NE(text.find(" at 0.75 s (harm 0.31)\n"), std::string::npos) << text;
  EXPECT_EQ(text.find('\x1b'), std::string::npos);

  // One line a pair, with all its harm.
  FurtherContact again = told.result.ranking[1].further.front();
  again.time_s = 1.0;
  again.harm = 0.11;
  std::swap(again.a, again.b);
  told.result.ranking[1].further.push_back(again);
  const std::string twice = ranking_text(told.scenario, told.models, told.result);
  EXPECT_NE(twice.find(" at 0.75 s (harm 0.42)\n"), std::string::npos) << twice;
  EXPECT_EQ(twice.find("hit: "), twice.rfind("hit: ")) << twice;

  // Most of the closing speed is the third body's own: it is not run into.
  told.scenario.actors[2].pose.rotation = Eigen::Matrix3d::Identity();
  told.scenario.actors[2].speed_mps = -5.0;
  const std::string meets = ranking_text(told.scenario, told.models, told.result);
  EXPECT_NE(meets.find("hit: wall and third "), std::string::npos) << meets;

  told.result.measure = Measure::polygons;
  EXPECT_EQ(ranking_text(told.scenario, told.models, told.result).find("hit: "), std::string::npos);
}

}  // namespace
}  // namespace crashrank

#include "cli/program.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

namespace {

using cli_test::Json;
using cli_test::Outcome;
using cli_test::Workplace;

Outcome run_rank(const Workplace& place, const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"rank", "scenario.json", "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return place.crashrank(arguments);
}

std::map<std::string, double> scores(const Json& answer) {
  std::map<std::string, double> found;
  for (const Json& one : answer.at("ranking")) {
    if (!one.at("score").is_null()) found[one.at("candidate")] = one.at("score");
  }
  return found;
}

TEST(RankDeadline, WithoutWorkOnlyIntervalsAreKnownAndTheCodeIsThatOfABudget) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  const std::map<std::string, double> all = scores(run_rank(place, {}).json());
  const std::vector<std::vector<std::string>> budgets{{"--work-budget", "0"},
                                                      {"--deadline-ms", "0"}};
  for (const std::vector<std::string>& none : budgets) {
    const Outcome run = run_rank(place, none);
    EXPECT_EQ(run.code, 4);
    const Json answer = run.json();
    EXPECT_EQ(answer.at("complete"), false);
    EXPECT_EQ(answer.at("proved"), false);
    EXPECT_EQ(answer.at("in_race").size(), all.size());
    ASSERT_EQ(answer.at("ranking").size(), all.size());
    for (const Json& one : answer.at("ranking")) {
      EXPECT_TRUE(one.at("score").is_null());
      const std::vector<double> interval = one.at("score_interval");
      EXPECT_LE(interval.at(0), all.at(one.at("candidate")));
      EXPECT_GE(interval.at(1), all.at(one.at("candidate")));
      for (const char* key : {"separable_from_next", "overtaken_share", "damaged_triangles"}) {
        EXPECT_TRUE(one.at(key).is_null()) << key;
      }
    }
    // Where the full answer puts somebody the intervals have to allow.
    const Json full = run_rank(place, {"--deadline-ms", "100000"}).json();
    for (std::size_t at = 0; at < full.at("ranking").size(); ++at) {
      for (const Json& one : answer.at("ranking")) {
        if (one.at("candidate") != full.at("ranking")[at].at("candidate")) continue;
        const std::vector<std::size_t> places = one.at("places");
        EXPECT_LE(places.at(0), at + 1);
        EXPECT_GE(places.at(1), at + 1);
      }
    }
  }
}

TEST(RankDeadline, APartialAnswerAndOptionsWithoutPartAreToldOnStandardError) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  const Outcome cut = run_rank(place, {"--work-budget", "0"});
  EXPECT_NE(cut.err.find("a partial answer, its first place not proved"), std::string::npos)
      << cut.err;
  EXPECT_TRUE(cli_test::is_one_message(cut.err)) << cut.err;
  ASSERT_EQ(cut.json().at("warnings").size(), 1U);
  EXPECT_NE(cut.err.find(cut.json().at("warnings")[0].get<std::string>()), std::string::npos);
  EXPECT_EQ(run_rank(place, {"--deadline-ms", "100000"}).err, "");
  const Outcome idle = run_rank(place, {"--deadline-ms", "100000", "--policy", "random"});
  EXPECT_EQ(idle.code, 0);
  EXPECT_NE(idle.err.find("--policy and --depth have no part"), std::string::npos) << idle.err;
}

TEST(RankDeadline, TimeEnoughGivesThePlainScores) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  for (const std::string measure : {"harm", "polygons"}) {
    const Json plain = run_rank(place, {"--measure", measure}).json();
    const Outcome run = run_rank(place, {"--measure", measure, "--deadline-ms", "100000"});
    EXPECT_EQ(run.code, 0);
    EXPECT_EQ(scores(run.json()), scores(plain));
    EXPECT_EQ(run.json().at("effort").at("left_early"), 0);
    EXPECT_FALSE(plain.contains("effort"));
  }
}

TEST(RankDeadline, WhatIsNoTimeAndAReportThatCannotBeWrittenAreRefusedBeforeTheWork) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  for (const char* text : {"nan", "inf", "-1", "soon"}) {
    EXPECT_EQ(run_rank(place, {"--deadline-ms", text}).code, 2) << text;
  }
  const Outcome run = run_rank(place, {"--report", "no/such/folder/page.html"});
  EXPECT_EQ(run.code, 3);
  EXPECT_NE(run.err.find("no/such/folder/page.html"), std::string::npos) << run.err;
}

TEST(RankDeadline, ABudgetOfWorkCutsTheSameEveryTime) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  for (const char* work : {"50", "500", "5000", "50000"}) {
    Json one = run_rank(place, {"--measure", "harm", "--work-budget", work}).json();
    Json two =
        run_rank(place, {"--measure", "harm", "--work-budget", work, "--workers", "3"}).json();
    EXPECT_EQ(one.at("ranking"), two.at("ranking")) << work;
    EXPECT_EQ(one.at("in_race"), two.at("in_race")) << work;
    EXPECT_EQ(one.at("effort").at("work"), two.at("effort").at("work")) << work;
  }
}

TEST(RankDeadline, TheFirstPlaceIsEnoughWhereItIsAskedFor) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  const Json plain = run_rank(place, {"--measure", "harm"}).json();
  const Outcome run = run_rank(place, {"--measure", "harm", "--first-place"});
  EXPECT_EQ(run.code, 0);
  EXPECT_EQ(run.json().at("proved"), true);
  EXPECT_EQ(run.json().at("ranking").at(0).at("candidate"),
            plain.at("ranking").at(0).at("candidate"));
}

TEST(RankDeadline, BudgetsThatAreNoneAreRefused) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  EXPECT_EQ(run_rank(place, {"--deadline-ms", "-1"}).code, 2);
  EXPECT_EQ(run_rank(place, {"--deadline-ms", "soon"}).code, 2);
  EXPECT_EQ(run_rank(place, {"--work-budget", "-3"}).code, 2);
}

}  // namespace

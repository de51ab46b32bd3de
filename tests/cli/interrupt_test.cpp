#include "cli/program.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

// When a signal meets the program depends on the machine: what is asserted holds at any time before
// its end. The work is made so long that it cannot end before.

namespace {

using cli_test::Json;
using cli_test::Outcome;
using cli_test::Workplace;

/// Interrupts the program, as Ctrl-C does, after some seconds.
Outcome interrupted(const Workplace& place, const std::string& seconds, const std::string& line) {
  return place.shell("timeout --preserve-status -s INT -k 60 " + seconds +
                     " '" CRASHRANK_PROGRAM "' " + line);
}

void expect_interrupted(const Outcome& run) {
  EXPECT_EQ(run.code, 4) << run.err;
  const std::size_t last = run.err.rfind("crashrank: interrupted: ");
  ASSERT_NE(last, std::string::npos) << run.err;
  EXPECT_TRUE(cli_test::is_one_message(run.err.substr(last))) << run.err;
}

/// So many candidates in so many futures that their ranking takes minutes.
void write_long_scenario(const Workplace& place) {
  cli_test::write_box_scenario(place);
  std::string text = place.read("scenario.json");
  const std::string grid = "\"grid\": false";
  text.replace(text.find(grid), grid.size(), R"("grid": {"accelerations": 101, "steerings": 101})");
  const std::string version = R"("scenario_version": 1)";
  text.replace(text.find(version), version.size(), R"("scenario_version": 2)");
  std::string stones;
  for (int i = 0; i < 9; ++i) {
    const std::string place_x = std::to_string(10 + 2 * i);
    stones += std::string(i > 0 ? ", " : "") + R"({"name": "stone )" + std::to_string(i) +
              R"(", "model": "block", "existence_probability": 0.5, "pose": {"x_m": )" + place_x +
              "}}";
  }
  const std::size_t actors = text.find("\"actors\": [") + 11;
  text.replace(actors, text.find("],", actors) - actors, stones);
  place.write("scenario.json", text);
}

std::string poses(std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += "1 0 0 0.5 0 1 0 0.5 0 0 1 0.5 0 0 0 1\n";
  return text;
}

TEST(Interrupt, ARankingLeavesBoundsOnEveryCandidate) {
  const Workplace place;
  write_long_scenario(place);
  const Outcome run = interrupted(place, "4", "rank scenario.json --json");
  expect_interrupted(run);
  if (run.out.empty()) {
    EXPECT_NE(run.err.find("nothing is known yet"), std::string::npos) << run.err;
    return;
  }
  const Json answer = run.json();
  EXPECT_EQ(answer.at("complete"), false);
  constexpr std::size_t candidates = 101U * 101U + 3U;
  ASSERT_EQ(answer.at("ranking").size(), candidates);
  std::size_t evaluated = 0;
  for (const Json& one : answer.at("ranking")) {
    EXPECT_LE(one.at("score_interval")[0], one.at("score_interval")[1]);
    if (!one.at("score").is_null()) ++evaluated;
  }
  const std::string told =
      std::to_string(evaluated) + " of " + std::to_string(candidates) + " candidates are evaluated";
  EXPECT_NE(run.err.find(told), std::string::npos) << run.err;
  const Json& warnings = answer.at("warnings");
  EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [&told](const Json& warning) {
    return warning.get<std::string>().find(told) != std::string::npos;
  })) << warnings;
}

TEST(Interrupt, CollisionsLeaveTheQueriesThatAreAnsweredAndNoHalfList) {
  const Workplace place;
  place.write("a.obj", cli_test::box_obj("a", 0, 0, 0, 1, 1, 1));
  place.write("poses.txt", poses(1000));
  const Outcome run = interrupted(
      place, "2", "collide a.obj a.obj --poses poses.txt --repeat 100000 --json --pairs out.csv");
  expect_interrupted(run);
  if (!run.out.empty()) {
    EXPECT_GE(run.json().at("queries").size(), 1U);
    EXPECT_LT(run.json().at("queries").size(), 1000U);
  }
  EXPECT_EQ(place.shell("test -e out.csv").code, 1);
}

TEST(Interrupt, ASweepSaysHowFarItCame) {
  const Workplace place;
  place.write("a.obj", cli_test::box_obj("a", 0, 0, 0, 1, 1, 1));
  place.write("poses.txt", poses(1000));
  const Outcome run =
      interrupted(place, "1", "sweep a.obj a.obj --poses poses.txt --repeat 10000 --plot out.svg");
  expect_interrupted(run);
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(place.shell("test -e out.svg").code, 1);
}

TEST(Interrupt, AValidationLeavesTheRowsThatAreComplete) {
  const Workplace place;
  std::istringstream table(
      place.shell("cat '" CRASHRANK_SOURCE_DATA "/validation/car_to_car.csv'").out);
  std::string header;
  std::string row;
  while (std::getline(table, header) && header.rfind('#', 0) == 0) {
  }
  std::getline(table, row);
  std::string rows = header + "\n";
  for (int i = 0; i < 2000; ++i) rows += std::to_string(i) + row.substr(row.find(',')) + "\n";
  place.write("rows.csv", rows);
  const Outcome run = interrupted(place, "3",
                                  "validate rows.csv --boxes --json --car '" CRASHRANK_SOURCE_DATA
                                  "/models/sedan.obj'");
  expect_interrupted(run);
  if (!run.out.empty()) {
    EXPECT_LT(run.json().at("rows").size(), 2000U);
  }
}

TEST(Interrupt, NoFileIsLeftThatIsNotComplete) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  for (const std::string seconds : {"0.1", "0.3", "0.5", "1", "2"}) {
    SCOPED_TRACE(seconds);
    interrupted(place, seconds,
                "rank scenario.json --damage out --measure closing-energy --report r.html");
    interrupted(place, seconds,
                "compile '" CRASHRANK_SOURCE_DATA "/models/sedan.obj' -o car.crm --force");
    for (const std::string& file : place.list(".")) {
      EXPECT_EQ(file.find(".crm."), std::string::npos) << file;
    }
    if (place.shell("test -e car.crm").code == 0) {
      EXPECT_EQ(place.crashrank({"inspect", "car.crm"}).code, 0);
    }
    if (place.shell("test -e out").code != 0) continue;
    for (const std::string& file : place.list("out")) {
      const std::string bytes = place.read("out/" + file);
      if (file.find(".png") != std::string::npos) {
        EXPECT_NE(bytes.find("IEND"), std::string::npos) << file;
      } else if (file.find(".glb") != std::string::npos) {
        std::uint32_t length = 0;
        ASSERT_GE(bytes.size(), 12U) << file;
        std::memcpy(&length, bytes.data() + 8, sizeof length);
        EXPECT_EQ(length, bytes.size()) << file;
      }
    }
  }
}

TEST(Interrupt, SignalsThatTheCallerIgnoresAreIgnored) {
  const Workplace place;
  place.write("a.obj", cli_test::box_obj("a", 0, 0, 0, 1, 1, 1));
  place.write("poses.txt", poses(20));
  // A shell without job control lets what it puts into the background ignore them.
  const Outcome run = place.shell("'" CRASHRANK_PROGRAM
                                  "' collide a.obj a.obj --poses poses.txt --repeat 20000 & "
                                  "pid=$!; sleep 0.2; kill -INT $pid; wait $pid");
  EXPECT_EQ(run.code, 0) << run.err;
}

}  // namespace

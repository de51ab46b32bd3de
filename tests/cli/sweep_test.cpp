#include "cli/program.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

using cli_test::Json;
using cli_test::Outcome;
using cli_test::Workplace;

const std::set<std::string> contract{"depth",
                                     "policy",
                                     "jobs",
                                     "seconds",
                                     "serial_seconds",
                                     "speedup",
                                     "status",
                                     "replayed_speedup",
                                     "relative_transfer",
                                     "transferred_bytes",
                                     "peak_part_bytes"};

/// OBJ text of a ball without its poles: 2·rings·segments triangles.
std::string ball_obj(int rings, int segments, double radius) {
  std::ostringstream text;
  const double pi = std::acos(-1.0);
  text << "o ball\n";
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < segments; ++j) {
      const double polar = pi * (0.02 + 0.96 * i / rings);
      const double around = 2.0 * pi * j / segments;
      text << "v " << radius * std::sin(polar) * std::cos(around) << ' '
           << radius * std::sin(polar) * std::sin(around) << ' ' << radius * std::cos(polar)
           << '\n';
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < segments; ++j) {
      const int here = i * segments + j + 1;
      const int beside = i * segments + (j + 1) % segments + 1;
      text << "f " << here << ' ' << here + segments << ' ' << beside << '\n';
      text << "f " << beside << ' ' << here + segments << ' ' << beside + segments << '\n';
    }
  }
  return text.str();
}

struct Balls {
  Workplace place;

  Balls() {
    place.write("ball.obj", ball_obj(20, 30, 1.0));
    place.write("poses.txt",
                "1 0 0 1.6 0 1 0 0 0 0 1 0 0 0 0 1\n"
                "1 0 0 0 0 1 0 1.7 0 0 1 0.1 0 0 0 1\n");
  }
  Outcome sweep(std::vector<std::string> more) const {
    std::vector<std::string> arguments{"sweep",     "ball.obj", "ball.obj", "--poses",
                                       "poses.txt", "--repeat", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return place.crashrank(arguments);
  }
};

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> list;
  std::istringstream in(line + ",");
  for (std::string cell; std::getline(in, cell, ',');) list.push_back(cell);
  return list;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; ++at) ++n;
  return n;
}

TEST(Sweep, ByDefaultAllDepthsAndPoliciesOfFourWorkersWithStoresOfTheirOwn) {
  const Balls balls;
  const Outcome run = balls.sweep({"--json"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.err, "");
  const Json answer = run.json();
  EXPECT_EQ(answer["workers"], 4);
  EXPECT_EQ(answer["buffer"], 8);
  EXPECT_EQ(answer["store"], "private");
  EXPECT_EQ(answer["kernel"], "scalar");
  EXPECT_EQ(answer["batch"], false);
  const std::vector<std::string> policies{"best-match", "random", "lowest", "best-match-load",
                                          "late-match"};
  ASSERT_EQ(answer["rows"].size(), 16 * policies.size());
  double jobs = 0.0;
  for (std::size_t i = 0; i < answer["rows"].size(); ++i) {
    const Json& row = answer["rows"][i];
    for (const std::string& field : contract) EXPECT_TRUE(row.contains(field)) << field;
    EXPECT_EQ(row["depth"], i / policies.size() + 1);
    EXPECT_EQ(row["policy"], policies[i % policies.size()]);
    EXPECT_EQ(row["status"], "ok");
    for (const char* field : {"seconds", "serial_seconds", "speedup", "replayed_speedup",
                              "relative_transfer", "transferred_bytes", "peak_part_bytes"}) {
      EXPECT_GT(row[field].get<double>(), 0.0) << field;
    }
    EXPECT_LE(row["peak_part_bytes"], row["transferred_bytes"]);
    if (i % policies.size() == 0) {
      EXPECT_GE(row["jobs"].get<double>(), jobs) << "deeper cuts make more jobs";
      jobs = row["jobs"].get<double>();
    }
    // Late Match alone leaves small nodes whole.
    const bool late = row["policy"] == "late-match";
    EXPECT_TRUE(late ? row["jobs"].get<double>() <= jobs : row["jobs"].get<double>() == jobs);
  }
}

TEST(Sweep, TheCsvHasTheSameColumnsAndRows) {
  const Balls balls;
  const Outcome run =
      balls.sweep({"--csv", "--depths", "2,5:6", "--policies", "lowest,random", "--batch"});
  ASSERT_EQ(run.code, 0) << run.err;
  std::istringstream lines(run.out);
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  const std::vector<std::string> header = cells(line);
  const std::set<std::string> names(header.begin(), header.end());
  for (const std::string& field : contract) EXPECT_TRUE(names.count(field) == 1) << field;
  ASSERT_EQ(header[0], "depth");
  ASSERT_EQ(header[1], "policy");
  ASSERT_EQ(header.back(), "status");
  std::vector<std::string> rows;
  while (std::getline(lines, line)) {
    const std::vector<std::string> row = cells(line);
    ASSERT_EQ(row.size(), header.size()) << line;
    rows.push_back(row[0] + row[1] + row.back());
  }
  EXPECT_EQ(rows, (std::vector<std::string>{"2lowestok", "2randomok", "5lowestok", "5randomok",
                                            "6lowestok", "6randomok"}));
}

TEST(Sweep, ABudgetTrimsLinesAndIsNoFailure) {
  const Balls balls;
  const std::vector<std::string> tight{"--depths", "1,7",        "--memory",
                                       "40000",    "--policies", "lowest"};
  std::vector<std::string> json = tight;
  json.insert(json.end(), {"--json", "--plot", "out.svg"});
  const Outcome run = balls.sweep(json);
  ASSERT_EQ(run.code, 0) << run.err;
  const Json answer = run.json();
  ASSERT_EQ(answer["rows"].size(), 2U);
  EXPECT_EQ(answer["rows"][0]["status"], "out_of_memory");
  EXPECT_TRUE(answer["rows"][0]["speedup"].is_null());
  EXPECT_GT(answer["rows"][0]["jobs"], 0.0);
  EXPECT_LE(answer["rows"][0]["peak_part_bytes"], 40000.0);
  EXPECT_EQ(answer["rows"][1]["status"], "ok");
  const std::string svg = balls.place.read("out.svg");
  EXPECT_EQ(count(svg, "<circle"), 2U) << "one depth left, two panels";

  std::vector<std::string> csv = tight;
  csv.emplace_back("--csv");
  EXPECT_NE(balls.sweep(csv).out.find(",out_of_memory\n"), std::string::npos);
}

TEST(Sweep, SharedStoresCountTheSameBytesOnOneCore) {
  const Balls balls;
  std::vector<double> bytes;
  for (const char* store : {"private", "shared"}) {
    const Outcome run = balls.sweep({"--json", "--depths", "4", "--policies", "best-match",
                                     "--workers", "1", "--store", store});
    ASSERT_EQ(run.code, 0) << run.err;
    bytes.push_back(run.json()["rows"][0]["transferred_bytes"].get<double>());
  }
  EXPECT_GT(bytes[0], 0.0);
  EXPECT_EQ(bytes[0], bytes[1]);
}

TEST(Sweep, TheFastKernelSharesItsTrees) {
  const Balls balls;
  const Outcome run =
      balls.sweep({"--json", "--depths", "3", "--kernel", "fast", "--store", "shared"});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json told = run.json();
  for (const Json& row : told["rows"]) EXPECT_EQ(row["status"], "ok");
}

TEST(Sweep, ThePlotIsSvgWithEscapedNames) {
  const Balls balls;
  balls.place.write("a&b<c>.obj", ball_obj(6, 8, 1.0));
  const Outcome run =
      balls.place.crashrank({"sweep", "a&b<c>.obj", "ball.obj", "--poses", "poses.txt", "--repeat",
                             "1", "--depths", "2:3", "--plot", "out.svg"});
  ASSERT_EQ(run.code, 0) << run.err;
  const std::string svg = balls.place.read("out.svg");
  EXPECT_EQ(svg.rfind("<svg ", 0), 0U);
  EXPECT_NE(svg.find("a&amp;b&lt;c&gt;.obj"), std::string::npos);
  EXPECT_EQ(svg.find("<c>"), std::string::npos);
  EXPECT_EQ(count(svg, "stroke='#555555' stroke-dasharray='4 4'"), 2U) << "a line at 1 a panel";
  for (const char* policy : {"best-match", "random", "lowest", "best-match-load", "late-match"}) {
    EXPECT_NE(svg.find(std::string(">") + policy + "<"), std::string::npos) << policy;
  }
}

TEST(Sweep, WithoutJobsThereIsNoSpeedupAndAnExcessHasAReason) {
  const Balls balls;
  balls.place.write("poses.txt", "1 0 0 50 0 1 0 0 0 0 1 0 0 0 0 1\n");  // far apart
  const std::vector<std::string> few{"--depths", "1:4", "--workers", "1"};
  std::vector<std::string> json = few;
  json.emplace_back("--json");
  const Outcome run = balls.sweep(json);
  ASSERT_EQ(run.code, 0) << run.err;
  const Json told = run.json();
  for (const Json& row : told["rows"]) {
    EXPECT_EQ(row["jobs"], 0.0);
    EXPECT_GT(row["serial_seconds"].get<double>(), 0.0);
    EXPECT_TRUE(row["speedup"].is_null());
    EXPECT_TRUE(row["replayed_speedup"].is_null());
    EXPECT_TRUE(row["speedup_note"].is_null());
  }
  // A second body of its own scale: half as large, a pose that only touches at full size.
  balls.place.write("poses.txt", "1 0 0 1.8 0 1 0 0 0 0 1 0 0 0 0 1\n");
  for (const std::string scale : {"1", "0.5"}) {
    const Outcome scaled = balls.sweep({"--json", "--depths", "3", "--scale-b", scale});
    ASSERT_EQ(scaled.code, 0) << scaled.err;
    const Json answer = scaled.json();
    for (const Json& row : answer["rows"]) {
      EXPECT_EQ(row["speedup"].is_null(), row["jobs"] == 0.0);
      if (!row["speedup"].is_number()) continue;
      const double cores = std::min(5.0, answer["processors"].get<double>());
      EXPECT_EQ(row["speedup_note"].is_string(), row["speedup"].get<double>() > cores ||
                                                     row["replayed_speedup"].get<double>() > 5.0);
    }
  }
}

TEST(Sweep, BadInputIsExitThreeAndOneLine) {
  const Balls balls;
  balls.place.write("few.txt", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0\n");
  balls.place.write("bent.txt", "1 0 0 0 0 2 0 0 0 0 1 0 0 0 0 1\n");
  balls.place.write("none.txt", "");
  balls.place.write("torn.obj", "v 0 0\nf 1 2 3\n");
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"ball.obj", "ball.obj", "--poses", "missing.txt"},
                                             {"ball.obj", "ball.obj", "--poses", "few.txt"},
                                             {"ball.obj", "ball.obj", "--poses", "bent.txt"},
                                             {"ball.obj", "ball.obj", "--poses", "none.txt"},
                                             {"ball.obj", "missing.obj", "--poses", "poses.txt"},
                                             {"torn.obj", "ball.obj", "--poses", "poses.txt"}}) {
    SCOPED_TRACE(testing::PrintToString(arguments));
    std::vector<std::string> whole{"sweep"};
    whole.insert(whole.end(), arguments.begin(), arguments.end());
    const Outcome run = balls.place.crashrank(whole);
    EXPECT_EQ(run.code, 3) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_TRUE(cli_test::is_one_message(run.err)) << run.err;
  }
}

}  // namespace

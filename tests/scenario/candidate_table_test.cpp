#include "crashrank/base/pose.hpp"
#include "crashrank/scenario/candidate.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

namespace crashrank {
namespace {

namespace fs = std::filesystem;

constexpr const char* header = "candidate,t_s,x_m,y_m,yaw_deg\n";

/// A scenario beside a table of its candidates, in a folder of their own.
class CandidateTable : public testing::Test {
protected:
  void SetUp() override {
    folder_ = fs::canonical(testing::TempDir()) / ("crashrank-table-" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "own");
  }
  void TearDown() override { fs::remove_all(folder_); }

  static std::string scenario(const std::string& candidates, int version = 2) {
    return R"({"scenario_version": )" + std::to_string(version) +
           R"(, "models": {"car": {"mesh": "car.obj", "kind": "car"}},
               "ego": {"model": "car", "speed_mps": 10},
               "candidates": )" +
           candidates + "}";
  }

  Result<Scenario> load(const std::string& table,
                        const std::string& candidates = R"({"table": "plans.csv"})",
                        int version = 2) {
    std::ofstream(folder_ / "own/plans.csv", std::ios::binary) << table;
    return load_scenario(scenario(candidates, version), (folder_ / "own/s.json").string());
  }

  /// Place and reason of the refusal.
  std::string refusal(const std::string& table) {
    const Result<Scenario> read = load(table);
    if (read) return "accepted";
    EXPECT_EQ(read.error().file, (folder_ / "own/plans.csv").string());
    EXPECT_FALSE(read.error().remedy.empty());
    return read.error().place + ": " + read.error().reason;
  }

  fs::path folder_;
};

TEST_F(CandidateTable, HoldsWhatTheScenariosOwnListHolds) {
  const Result<Scenario> listed = load("", R"({"listed": [
      {"name": "keep", "acceleration_mps2": 0},
      {"name": "left, then \"straight\"", "poses": [{"t_s": 0}, {"t_s": 0.1, "x_m": 1.01, "y_m": 0.03, "yaw_deg": 2.5}]},
      {"name": "climb", "poses": [{"t_s": 0}, {"t_s": 2, "x_m": 20, "z_m": 1e-1, "pitch_deg": -1, "roll_deg": 3}]}]})");
  const Result<Scenario> read = load(
      "\xef\xbb\xbf"
      "t_s,yaw_deg,candidate,y_m,x_m,roll_deg,pitch_deg,z_m\r\n"
      "0,0,\"left, then \"\"straight\"\"\",0,0,0,0,0\r\n"
      "0.1,2.5,\"left, then \"\"straight\"\"\",0.03, 1.01 ,0,0,0\r\n"
      "\r\n"
      "0,0,climb,0,0,0,0,0\r\n"
      "2,0,climb,0,20,3,-1,1e-1",
      R"({"table": "plans.csv", "listed": [{"name": "keep", "acceleration_mps2": 0}]})");
  ASSERT_TRUE(listed.ok()) << listed.error().message();
  ASSERT_TRUE(read.ok()) << read.error().message();
  EXPECT_FALSE(read->grid.has_value());
  ASSERT_EQ(read->listed.size(), listed->listed.size());
  for (std::size_t i = 0; i < read->listed.size(); ++i) {
    EXPECT_EQ(read->listed[i].name, listed->listed[i].name);
    ASSERT_EQ(read->listed[i].poses.size(), listed->listed[i].poses.size());
    for (std::size_t k = 0; k < read->listed[i].poses.size(); ++k) {
      const TimedPose& pose = read->listed[i].poses[k];
      const TimedPose& wanted = listed->listed[i].poses[k];
      EXPECT_EQ(pose.time_s, wanted.time_s);
      EXPECT_EQ(pose.pose.translation, wanted.pose.translation);
      EXPECT_EQ(pose.pose.rotation, wanted.pose.rotation);
    }
  }
  EXPECT_TRUE(make_candidates(*read, 4.5).ok());
}

TEST_F(CandidateTable, TheGuidesTableIsRead) {
  const Result<Scenario> read =
      load_scenario_file((fs::path(CRASHRANK_SCENARIO_DATA) / "plans.json").string());
  ASSERT_TRUE(read.ok()) << read.error().message();
  ASSERT_EQ(read->listed.size(), 2U);
  EXPECT_EQ(read->listed[1].name, "pass on the left");
  EXPECT_EQ(read->listed[1].poses.back().pose.translation, Eigen::Vector3d(19.8, 2.1, 0.0));
}

TEST_F(CandidateTable, RefusalsNameLineAndColumn) {
  const std::string start = std::string(header) + "a,0,0,0,0\n";
  EXPECT_EQ(refusal("candidate,t_s,x_m,y_m\n"), "line 1, yaw_deg: is missing");
  EXPECT_EQ(refusal("candidate,t_s,x_m,y_m,t_s\n"), "line 1: 't_s' is named twice");
  EXPECT_EQ(refusal("candidate,time\n"), "line 1: 'time' is no column of a table of candidates");
  EXPECT_EQ(refusal(""), "line 1: '' is no column of a table of candidates");
  EXPECT_EQ(refusal(header), "line 1, candidate: holds no pose");
  EXPECT_EQ(refusal(start + "a,1,2,3\n"), "line 3: has fewer fields than the first line");
  EXPECT_EQ(refusal(start + "a,1,2,3,4,5\n"), "line 3: has more fields than the first line");
  EXPECT_EQ(refusal(start + "a,1,,3,4\n"), "line 3, x_m: '' is not a number");
  EXPECT_EQ(refusal(start + "a,1,2m,3,4\n"), "line 3, x_m: '2m' is not a number");
  EXPECT_EQ(refusal(start + "a,1,nan,3,4\n"), "line 3, x_m: is nan, out of range");
  EXPECT_EQ(refusal(start + "a,1,1e6,3,4\n"), "line 3, x_m: is 1000000, out of range");
  EXPECT_EQ(refusal(start + "a,61,0,0,0\n"), "line 3, t_s: is 61, out of range");
  EXPECT_EQ(refusal(start + "a,0,0,0,0\n"), "line 3, t_s: does not rise");
  EXPECT_EQ(refusal(start + "b,1,0,0,0\n"), "line 3, t_s: the first pose is not at time 0");
  EXPECT_EQ(refusal(start + "b,0,0,0,0\na,1,9,0,0\n"), "line 4, candidate: 'a' was there before");
  EXPECT_EQ(refusal(start + ",0,0,0,0\n"), "line 3, candidate: is empty");
  EXPECT_EQ(refusal(start + "\"b,0,0,0,0\n"), "line 3: a quoted field does not end");
  EXPECT_EQ(refusal(start + "\"b\"b,0,0,0,0\n"), "line 3: a quoted field does not end");
  EXPECT_EQ(refusal(start + "\xff,0,0,0,0\n"), "line 3, candidate: is not UTF-8");
  EXPECT_EQ(refusal(start + "b\t,0,0,0,0\n"), "line 3, candidate: holds a control character");
}

TEST_F(CandidateTable, NamesDifferFromThoseOfTheList) {
  const Result<Scenario> read = load(std::string(header) + "keep,0,0,0,0\n",
                                     R"({"table": "plans.csv", "listed": [{"name": "keep"}]})");
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.error().place, "line 2, candidate");
}

TEST_F(CandidateTable, LiesWhereMeshesMayLie) {
  std::ofstream(folder_ / "plans.csv") << header << "a,0,0,0,0\n";
  const Result<Scenario> outside = load("", R"({"table": "../plans.csv"})");
  ASSERT_FALSE(outside.ok());
  EXPECT_EQ(outside.error().place, "candidates.table");
  EXPECT_NE(outside.error().reason.find("outside the scenario's folder"), std::string::npos);
  const Result<Scenario> missing = load("", R"({"table": "no.csv"})");
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().code, ErrorCode::not_found);
  const Result<Scenario> older = load("", R"({"table": "plans.csv"})", 1);
  ASSERT_FALSE(older.ok());
  EXPECT_EQ(older.error().place, "candidates.table");
}

TEST_F(CandidateTable, TextAloneReadsNoTable) {
  const Result<Scenario> parsed = parse_scenario(scenario(R"({"table": "plans.csv"})"), "s.json");
  ASSERT_FALSE(parsed.ok());
  EXPECT_EQ(parsed.error().place, "candidates.table");
}

TEST_F(CandidateTable, HoldsTenThousandCandidatesAndNoMore) {
  std::string table = header;
  for (std::size_t i = 0; i < scenario_limits::listed_candidates; ++i) {
    table += std::to_string(i) + ",0,0,0,0\n" + std::to_string(i) + ",4,40,0,0\n";
  }
  const Result<Scenario> all = load(table);
  ASSERT_TRUE(all.ok()) << all.error().message();
  EXPECT_EQ(all->listed.size(), scenario_limits::listed_candidates);
  const Result<Scenario> more = load(table + "one more,0,0,0,0\n");
  ASSERT_FALSE(more.ok());
  EXPECT_EQ(more.error().code, ErrorCode::limit_exceeded);
  EXPECT_EQ(more.error().place, "line 20002, candidate");
}

/// Whatever the text: candidates in range with names that can be printed, or an error in words.
TEST_F(CandidateTable, AnyTextIsReadOrRefused) {
  const std::string sound = std::string(header) + "a,0,0,0,0\na,1,10,0.5,3\n\"b\"\"\",0,0,0,0\n" +
                            "\"b\"\"\",0.5,5,0,0\n";
  const std::string telling = ",\n\r\"ab0159.-e \xff\x01";
  std::size_t accepted = 0;
  for (unsigned seed = 1; seed <= 2000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    std::string text = sound;
    for (std::uint64_t changes = 1 + random() % 2; changes > 0; --changes) {
      const std::size_t at = random() % text.size();
      if (random() % 3 == 0) {
        text.erase(at, 1 + random() % 3);
      } else {
        text.insert(at, 1, telling[random() % telling.size()]);
      }
      if (text.empty()) text = "a";
    }
    const Result<Scenario> read = load(text);
    if (!read) {
      EXPECT_FALSE(read.error().reason.empty());
      EXPECT_EQ(read.error().message().find('\xff'), std::string::npos);
      continue;
    }
    ++accepted;
    for (const ListedCandidate& candidate : read->listed) {
      EXPECT_FALSE(candidate.name.empty());
      ASSERT_FALSE(candidate.poses.empty());
      for (const TimedPose& pose : candidate.poses) {
        EXPECT_LE(pose.pose.translation.cwiseAbs().maxCoeff(), scenario_limits::position_m);
      }
    }
  }
  EXPECT_GT(accepted, 100U);
  EXPECT_LT(accepted, 1900U);
}

}  // namespace
}  // namespace crashrank

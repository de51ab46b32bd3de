#include "cli/program.hpp"

#include "oracle/triangle_oracle.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace {

using cli_test::Json;
using cli_test::Outcome;
using cli_test::Workplace;

using PairList = std::vector<std::pair<int, int>>;

/// The triangles of an OBJ text, faces in order, moved by (x, y, z).
std::vector<oracle::Triangle> triangles_of(const std::string& obj, double x, double y, double z) {
  std::vector<oracle::Point> points;
  std::vector<oracle::Triangle> triangles;
  std::istringstream in(obj);
  std::string kind;
  while (in >> kind) {
    if (kind == "v") {
      std::array<float, 3> p{};
      in >> p[0] >> p[1] >> p[2];
      points.push_back({static_cast<double>(p[0]) + x, static_cast<double>(p[1]) + y,
                        static_cast<double>(p[2]) + z});
    } else if (kind == "f") {
      std::array<std::size_t, 3> f{};
      in >> f[0] >> f[1] >> f[2];
      triangles.push_back({points[f[0] - 1], points[f[1] - 1], points[f[2] - 1]});
    } else {
      in >> kind;
    }
  }
  return triangles;
}

PairList exact_pairs(const std::vector<oracle::Triangle>& a,
                     const std::vector<oracle::Triangle>& b) {
  PairList pairs;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      if (oracle::rational_intersects(a[i], b[j])) pairs.emplace_back(i, j);
    }
  }
  return pairs;
}

PairList pairs_in_csv(const std::string& csv, int query) {
  PairList pairs;
  std::istringstream in(csv);
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "query,a,b");
  while (std::getline(in, line)) {
    std::array<int, 3> n{};
    char comma = ' ';
    std::istringstream cells(line);
    cells >> n[0] >> comma >> n[1] >> comma >> n[2];
    if (n[0] == query) pairs.emplace_back(n[1], n[2]);
  }
  return pairs;
}

/// The hash as the contract words it, by coreutils instead of by us.
std::string hash_by_sha256sum(const Workplace& place, const PairList& pairs) {
  std::string bytes;
  for (const auto& [a, b] : pairs) {
    for (const int index : {a, b}) {
      for (unsigned shift = 0; shift < 32; shift += 8) {
        bytes += static_cast<char>((static_cast<unsigned>(index) >> shift) & 0xffU);
      }
    }
  }
  return place.shell("sha256sum", bytes).out.substr(0, 16);
}

struct Boxes {
  Boxes() {
    place.write("a.obj", a);
    place.write("b.obj", b);
  }
  Workplace place;
  std::string a = cli_test::box_obj("a", 0, 0, 0, 2, 1, 1);
  std::string b = cli_test::box_obj("b", -0.5, -0.25, -0.125, 0.5, 0.25, 0.125);
};

const std::string half_in = "2,0.5,0.5,0,0,0";

TEST(Collide, JsonHasTheContractsShape) {
  const Boxes boxes;
  const Outcome run = boxes.place.crashrank({"collide", "a.obj", "b.obj", "--json", "--pose",
                                             half_in, "--pose", "9,0,0,45,10,5", "--repeat", "3"});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json answer = run.json();
  ASSERT_EQ(answer.at("queries").size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const Json& query = answer["queries"][i];
    EXPECT_EQ(query.at("index"), i);
    EXPECT_TRUE(query.at("intersecting").is_boolean());
    for (const char* count : {"pairs", "bv_tests", "primitive_tests"}) {
      EXPECT_TRUE(query.at(count).is_number_unsigned()) << count;
    }
    EXPECT_GT(query.at("seconds").get<double>(), 0.0);
    EXPECT_GE(query.at("sort_seconds").get<double>(), 0.0);
    EXPECT_EQ(query.at("hash").get<std::string>().size(), 16U);
  }
  EXPECT_EQ(answer["queries"][0]["intersecting"], true);
  EXPECT_EQ(answer["queries"][0]["state"], "intersecting");
  EXPECT_EQ(answer["queries"][1]["intersecting"], false);
  EXPECT_EQ(answer["queries"][1]["state"], "separate");
  EXPECT_EQ(answer["queries"][1]["pairs"], 0);
  EXPECT_EQ(answer["queries"][1]["hash"], "e3b0c44298fc1c14");  // of no bytes
  // Queries of a hundred nanoseconds may not tell the two costs apart; one of them is then all.
  const double cb_s = answer.at("cost").at("Cb_s").get<double>();
  const double cp_s = answer.at("cost").at("Cp_s").get<double>();
  EXPECT_GE(cb_s, 0.0);
  EXPECT_GE(cp_s, 0.0);
  EXPECT_GT(cb_s + cp_s, 0.0);
}

TEST(Collide, PairsAreThoseOfExactArithmeticAndHashedAsSaid) {
  const Boxes boxes;
  const PairList expected =
      exact_pairs(triangles_of(boxes.a, 0, 0, 0), triangles_of(boxes.b, 2, 0.5, 0.5));
  ASSERT_FALSE(expected.empty());
  for (const std::string& split :
       std::vector<std::string>{"min-relative-segment", "paper", "sah", "median"}) {
    for (const std::string& frame : std::vector<std::string>{"world", "gaussian"}) {
      SCOPED_TRACE(split + " " + frame);
      const Outcome run =
          boxes.place.crashrank({"collide", "a.obj", "b.obj", "--json", "--pose", half_in,
                                 "--pairs", "pairs.csv", "--split", split, "--frame", frame});
      ASSERT_EQ(run.code, 0) << run.err;
      EXPECT_EQ(pairs_in_csv(boxes.place.read("pairs.csv"), 0), expected);
      EXPECT_EQ(run.json()["queries"][0]["pairs"], expected.size());
      EXPECT_EQ(run.json()["queries"][0]["hash"], hash_by_sha256sum(boxes.place, expected));
    }
  }
}

TEST(Collide, EnginesWorkersAndPoliciesGiveTheSameAnswer) {
  const Boxes boxes;
  const std::vector<std::string> plain{"collide", "a.obj", "b.obj",   "--json",
                                       "--pose",  half_in, "--pairs", "pairs.csv"};
  const Outcome reference = boxes.place.crashrank(plain);
  ASSERT_EQ(reference.code, 0) << reference.err;
  const std::string pairs = boxes.place.read("pairs.csv");
  std::vector<std::vector<std::string>> ways{{"--kernel", "scalar"}, {"--workers", "2"}};
  for (const char* policy : {"best-match", "random", "lowest", "best-match-load", "late-match"}) {
    for (const char* kernel : {"fast", "scalar"}) {
      ways.push_back({"--workers", "3", "--depth", "2", "--policy", policy, "--kernel", kernel});
    }
  }
  for (const std::vector<std::string>& way : ways) {
    SCOPED_TRACE(testing::PrintToString(way));
    std::vector<std::string> arguments = plain;
    arguments.insert(arguments.end(), way.begin(), way.end());
    const Outcome run = boxes.place.crashrank(arguments);
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(boxes.place.read("pairs.csv"), pairs);
    EXPECT_EQ(run.json()["queries"][0]["hash"], reference.json()["queries"][0]["hash"]);
  }
}

TEST(Collide, WithoutAPoseFilesStandAsTheyAre) {
  const Boxes boxes;
  const Outcome run = boxes.place.crashrank({"collide", "a.obj", "b.obj", "--pairs", "-"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(pairs_in_csv(run.out, 0),
            exact_pairs(triangles_of(boxes.a, 0, 0, 0), triangles_of(boxes.b, 0, 0, 0)));
}

TEST(Collide, AnyStopsAtOnePairAndHashesNothing) {
  const Boxes boxes;
  for (const std::vector<std::string>& more :
       std::vector<std::vector<std::string>>{{}, {"--workers", "2", "--depth", "3"}}) {
    std::vector<std::string> arguments{"collide", "a.obj",  "b.obj", "--json",
                                       "--any",   "--pose", half_in};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome run = boxes.place.crashrank(arguments);
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(run.json()["queries"][0]["intersecting"], true);
    EXPECT_EQ(run.json()["queries"][0]["pairs"], 1);
    EXPECT_TRUE(run.json()["queries"][0]["hash"].is_null());
  }
}

TEST(Collide, PosesComeFromAFileAStreamAndTheCommandLine) {
  const Boxes boxes;
  const std::string matrices =
      "# B in A\n1 0 0 2  0 1 0 0.5  0 0 1 0.5  0 0 0 1\n\n"
      "1,0,0,9, 0,1,0,0, 0,0,1,0, 0,0,0,1\r\n";
  boxes.place.write("poses.txt", matrices);
  const Outcome file = boxes.place.crashrank(
      {"collide", "a.obj", "b.obj", "--json", "--pose", half_in, "--poses", "poses.txt"});
  ASSERT_EQ(file.code, 0) << file.err;
  ASSERT_EQ(file.json()["queries"].size(), 3U);
  EXPECT_EQ(file.json()["queries"][0]["hash"], file.json()["queries"][1]["hash"]);
  EXPECT_EQ(file.json()["queries"][2]["intersecting"], false);
  const Outcome stream =
      boxes.place.crashrank({"collide", "a.obj", "b.obj", "--json", "--poses", "-"}, matrices);
  ASSERT_EQ(stream.code, 0) << stream.err;
  EXPECT_EQ(stream.json()["queries"][0]["hash"], file.json()["queries"][1]["hash"]);
}

TEST(Collide, AnglesTurnAsTheConventionSays) {
  const Boxes boxes;
  const Outcome angles = boxes.place.crashrank(
      {"collide", "a.obj", "b.obj", "--pairs", "angles.csv", "--pose", "1.9,0.4,0.3,90,0,0"});
  ASSERT_EQ(angles.code, 0) << angles.err;
  const Outcome matrix =
      boxes.place.crashrank({"collide", "a.obj", "b.obj", "--pairs", "matrix.csv", "--poses", "-"},
                            "0 -1 0 1.9 1 0 0 0.4 0 0 1 0.3 0 0 0 1\n");
  ASSERT_EQ(matrix.code, 0) << matrix.err;
  EXPECT_EQ(boxes.place.read("angles.csv"), boxes.place.read("matrix.csv"));
}

TEST(Collide, EveryBadPoseFileIsExitThreeAndNamesItsLine) {
  const Boxes boxes;
  const std::string good = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n";
  for (const std::string& bad : std::vector<std::string>{
           "1 2 3\n", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 one\n",
           "1.00001 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n",  // stretched
           "-1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n",       // mirrored
           "1 0 0 nan 0 1 0 0 0 0 1 0 0 0 0 1\n",      // nowhere
           "1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1\n"}) {     // translation in the wrong place
    SCOPED_TRACE(bad);
    boxes.place.write("poses.txt", good + bad);
    const Outcome run =
        boxes.place.crashrank({"collide", "a.obj", "b.obj", "--poses", "poses.txt", "--json"});
    EXPECT_EQ(run.code, 3);
    EXPECT_EQ(run.out, "");
    EXPECT_TRUE(cli_test::is_one_message(run.err)) << run.err;
    EXPECT_NE(run.err.find("poses.txt: line 2"), std::string::npos) << run.err;
  }
  boxes.place.write("poses.txt", "# nothing\n");
  EXPECT_EQ(boxes.place.crashrank({"collide", "a.obj", "b.obj", "--poses", "poses.txt"}).code, 3);
  EXPECT_EQ(boxes.place.crashrank({"collide", "a.obj", "b.obj", "--poses", "gone.txt"}).code, 3);
  EXPECT_EQ(boxes.place.crashrank({"collide", "a.obj", "gone.obj"}).code, 3);
  EXPECT_EQ(boxes.place.crashrank({"collide", "a.obj", "b.obj", "--pairs", "no/pairs.csv"}).code,
            3);
}

TEST(Collide, TheTableTellsTheModelledTimeBesideTheMeasuredOne) {
  const Boxes boxes;
  const Outcome run = boxes.place.crashrank({"collide", "a.obj", "b.obj", "--pose", half_in});
  ASSERT_EQ(run.code, 0) << run.err;
  for (const char* word : {"measured us", "Nb Cb + Np Cp us", "Cb =", "Cp =", "intersecting"}) {
    EXPECT_NE(run.out.find(word), std::string::npos) << word << "\n" << run.out;
  }
  EXPECT_EQ(run.out.find('\x1b'), std::string::npos);  // no terminal, no colours
}

TEST(Collide, TheSecondBodyMayHaveAxesAndAScaleOfItsOwn) {
  const Workplace place;
  place.write("metres.obj", cli_test::box_obj("a", -1, -0.9, 0, 3, 0.9, 1.5));
  // The same body in millimetres, y up and z forward.
  place.write("turned.obj", cli_test::box_obj("a", -900, 0, -1000, 900, 1500, 3000));
  const std::vector<std::string> own{"--scale-b", "0.001", "--up-b", "y", "--forward-b", "+z"};
  for (const std::string pose : {"3.9,0,0,0,0,0", "4.1,0,0,0,0,0", "1,1.7,0,20,0,0"}) {
    const Json alike =
        place.crashrank({"collide", "metres.obj", "metres.obj", "--pose", pose, "--json"}).json();
    std::vector<std::string> arguments{"collide", "metres.obj", "turned.obj",
                                       "--pose",  pose,         "--json"};
    arguments.insert(arguments.end(), own.begin(), own.end());
    const Outcome run = place.crashrank(arguments);
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(run.json()["queries"][0]["intersecting"], alike["queries"][0]["intersecting"])
        << pose;
  }
  // What is not given is as for the first body.
  const std::vector<std::string> poses{"--pose", "3.9,0,0,0,0,0", "--json"};
  std::vector<std::string> both{"collide", "turned.obj", "turned.obj", "--scale", "0.001",
                                "--up",    "+y",         "--forward",  "+z"};
  both.insert(both.end(), poses.begin(), poses.end());
  const Outcome first = place.crashrank(both);
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_EQ(first.json()["queries"][0]["intersecting"], true);
  // Options for the second body alone leave a model file for the first one.
  ASSERT_EQ(place.crashrank({"compile", "metres.obj", "-o", "a.crm"}).code, 0);
  std::vector<std::string> mixed{"collide", "a.crm", "turned.obj"};
  mixed.insert(mixed.end(), own.begin(), own.end());
  mixed.insert(mixed.end(), poses.begin(), poses.end());
  const Outcome model = place.crashrank(mixed);
  EXPECT_EQ(model.code, 0) << model.err;
}

}  // namespace

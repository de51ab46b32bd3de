#include "cli/program.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace {

using cli_test::Json;
using cli_test::Outcome;
using cli_test::Workplace;

namespace fs = std::filesystem;

constexpr const char* one_pose = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n";

/// Each command that writes a file, into OUT.
const std::vector<std::vector<std::string>> writers{
    {"collide", "ego.obj", "block.obj", "--pairs", "OUT"},
    {"rank", "scenario.json", "--report", "OUT"},
    {"sweep", "ego.obj", "block.obj", "--poses", "poses", "--depths", "1", "--policies", "lowest",
     "--workers", "1", "--repeat", "1", "--plot", "OUT"},
    {"compile", "ego.obj", "--force", "-o", "OUT"}};

std::vector<std::string> into(std::vector<std::string> arguments, const std::string& file) {
  arguments.back() = file;
  return arguments;
}

void write_inputs(const Workplace& place) {
  cli_test::write_box_scenario(place);
  place.write("poses", one_pose);
}

void expect_refused(const Outcome& run, const std::string& told) {
  EXPECT_EQ(run.code, 2) << run.err;
  EXPECT_EQ(run.out, "");
  EXPECT_TRUE(cli_test::is_one_message(run.err)) << run.err;
  EXPECT_NE(run.err.find(told), std::string::npos) << run.err;
}

TEST(Output, AFileOfAnotherKindIsNeverReplaced) {
  const Workplace place;
  write_inputs(place);
  // Such as the buffer beside a glTF file, which no list of inputs holds.
  for (const std::string& content :
       {std::string(100, '\0'), std::string("v 0 0 0\n"), std::string("q")}) {
    place.write("car.bin", content);
    place.shell("ln -sf car.bin link");
    for (const std::vector<std::string>& writer : writers) {
      for (const char* file : {"car.bin", "link"}) {
        SCOPED_TRACE(testing::PrintToString(into(writer, file)));
        expect_refused(place.crashrank(into(writer, file)),
                       "remove it first, or name another file");
        EXPECT_EQ(place.read("car.bin"), content);
      }
    }
  }
}

TEST(Output, APictureOfAnotherProgramIsKeptAndTheRuleSaid) {
  const Workplace place;
  write_inputs(place);
  const std::string picture =
      "<?xml version=\"1.0\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\"/>\n";
  place.write("drawing.svg", picture);
  expect_refused(place.crashrank({"inspect", "ego.obj", "--profile", "drawing.svg"}),
                 "drawing.svg: is kept, as it does not begin like an SVG picture that crashrank "
                 "writes; remove it first, or name another file");
  EXPECT_EQ(place.read("drawing.svg"), picture);
}

TEST(Output, AFileOfItsKindAnEmptyOneAndAPipeAreWritten) {
  const Workplace place;
  write_inputs(place);
  for (std::size_t i = 0; i < writers.size(); ++i) {
    SCOPED_TRACE(writers[i].front());
    const Outcome fresh = place.crashrank(into(writers[i], "fresh"));
    ASSERT_EQ(fresh.code, 0) << fresh.err;
    const std::string head = place.read("fresh").substr(0, 8);
    place.write("empty", "");
    for (const char* file : {"fresh", "empty"}) {
      const Outcome again = place.crashrank(into(writers[i], file));
      EXPECT_EQ(again.code, 0) << again.err;
      EXPECT_EQ(place.read(file).substr(0, 8), head);
    }
    fs::remove(place.path("fresh"));
    if (writers[i].front() == "compile") continue;
    const std::string command = [&] {
      std::string line = CRASHRANK_PROGRAM;
      for (const std::string& word : into(writers[i], "pipe")) line += " " + word;
      return line;
    }();
    const Outcome piped =
        place.shell("rm -f pipe; mkfifo pipe; cat pipe >got & " + command + " >table; wait");
    EXPECT_EQ(piped.code, 0) << piped.err;
    EXPECT_EQ(place.read("got").substr(0, 8), head);
    const Outcome device = place.crashrank(into(writers[i], "/dev/stdout"));
    EXPECT_EQ(device.code, 0) << device.err;
    expect_refused(place.crashrank(into(writers[i], ".")), "is a folder");
  }
}

TEST(Output, AModelReplacesNoPipeDeviceOrFolder) {
  const Workplace place;
  write_inputs(place);
  place.shell("mkfifo pipe; mkdir folder; ln -s /dev/null null");
  for (const char* file : {"pipe", "folder", "null"}) {
    SCOPED_TRACE(file);
    const fs::file_type before = fs::symlink_status(place.path(file)).type();
    expect_refused(place.crashrank({"compile", "ego.obj", "-o", file, "--force"}), file);
    EXPECT_EQ(fs::symlink_status(place.path(file)).type(), before);
  }
}

/// One of the files that --damage writes.
std::string damage_file(const Workplace& place) {
  const Outcome run = place.crashrank({"rank", "scenario.json", "--json"});
  EXPECT_EQ(run.code, 0) << run.err;
  const Json answer = run.json();
  for (const Json& one : answer.at("ranking")) {
    if (one.at("candidate") == "straight")
      return "00" + one.at("rank").dump() + "-straight-ego.glb";
  }
  ADD_FAILURE() << "no candidate 'straight'";
  return {};
}

TEST(Output, DamageReplacesNoInput) {
  const Workplace place;
  write_inputs(place);
  const std::string name = damage_file(place);
  // A mesh of the very kind that is written there, read by another name.
  ASSERT_EQ(place.crashrank({"rank", "scenario.json", "--damage", "tried"}).code, 0);
  const std::string glb = place.read("tried/" + name);
  ASSERT_FALSE(glb.empty());
  place.shell("mkdir out");
  place.write("mesh.glb", glb);
  fs::create_hard_link(place.path("mesh.glb"), place.path("out/" + name));
  std::string text = place.read("scenario.json");
  text.replace(text.find("\"ego.obj\""), 9, "\"mesh.glb\", \"up\": \"+y\", \"forward\": \"+z\"");
  place.write("scenario.json", text);
  const Outcome run = place.crashrank({"rank", "scenario.json", "--damage", "out"});
  expect_refused(run, "over what is read");
  EXPECT_NE(run.err.find(name), std::string::npos) << run.err;
  EXPECT_EQ(place.read("mesh.glb"), glb);
  EXPECT_EQ(place.list("out"), std::vector<std::string>{name}) << "something was written before";
}

TEST(Output, DamageReplacesNoFileOfAnotherKind) {
  const Workplace place;
  write_inputs(place);
  const std::string name = damage_file(place);
  place.shell("mkdir out");
  place.write("out/" + name, "notes");
  expect_refused(place.crashrank({"rank", "scenario.json", "--damage", "out"}), name);
  EXPECT_EQ(place.read("out/" + name), "notes");
  EXPECT_EQ(place.list("out").size(), 1U);
}

TEST(Output, AReportMayLieAmongTheDamageButBeNoneOfIt) {
  const Workplace place;
  write_inputs(place);
  const std::string name = damage_file(place);
  expect_refused(place.crashrank({"rank", "scenario.json", "--damage", "out", "--report",
                                  "./out/../out/" + name}),
                 "--report");
  expect_refused(place.crashrank({"rank", "scenario.json", "--damage", "out", "--report", "out/"}),
                 "--damage");
  EXPECT_FALSE(fs::exists(place.path("out")));
  for (int round = 0; round < 2; ++round) {  // the second one replaces the files of the first
    const Outcome run = place.crashrank(
        {"rank", "scenario.json", "--damage", "new/out", "--report", "new/report.html"});
    EXPECT_EQ(run.code, 0) << run.err;
  }
  EXPECT_EQ(place.read("new/report.html").rfind("<!DOCTYPE html>", 0), 0U);
  EXPECT_TRUE(fs::exists(place.path("new/out/" + name)));
}

TEST(Output, NoFolderIsMadeForWhatIsRefused) {
  const Workplace place;
  write_inputs(place);
  for (const char* report : {"block.obj", "no/such/page.html"}) {
    const Outcome run =
        place.crashrank({"rank", "scenario.json", "--damage", "out", "--report", report});
    EXPECT_NE(run.code, 0);
    EXPECT_FALSE(fs::exists(place.path("out"))) << report;
  }
  const Outcome taken = place.crashrank({"rank", "scenario.json", "--damage", "block.obj/out"});
  EXPECT_EQ(taken.code, 3);
  EXPECT_TRUE(cli_test::is_one_message(taken.err)) << taken.err;
}

TEST(Output, NumbersTooSmallForADoubleAreZeroAndTooLargeOnesAreRefused) {
  const Workplace place;
  write_inputs(place);
  const std::string zeros(400, '0');
  const auto collide = [&](const std::string& x) {
    return place.crashrank(
        {"collide", "ego.obj", "block.obj", "--json", "--pose", x + ",0,0,0,0,0"});
  };
  for (const std::string& x : {"0." + zeros + "1", "-0." + zeros + "1", "." + zeros + "5",
                               "+0." + zeros + "1", std::string("1e-999"), "0" + zeros + ".0"}) {
    SCOPED_TRACE(x);
    const Outcome run = collide(x);
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(run.json()["queries"][0]["hash"], collide("0").json()["queries"][0]["hash"]);
  }
  for (const std::string& x : {"1" + zeros, "-1" + zeros, std::string("-1e999"), "1" + zeros + ".5",
                               "0.1x" + zeros, std::string("0x10")}) {
    SCOPED_TRACE(x);
    EXPECT_EQ(collide(x).code, 2);
  }
}

}  // namespace

#include "crashrank/scenario/scenario.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace crashrank {
namespace {

namespace fs = std::filesystem;

// project/scenarios/s.json beside project/models/car.obj, and a stranger's file above.
class ScenarioPathsTest : public testing::Test {
protected:
  void SetUp() override {
    top_ = fs::canonical(testing::TempDir()) / ("crashrank-paths-" + std::to_string(::getpid()));
    fs::remove_all(top_);
    fs::create_directories(top_ / "project/scenarios/deep");
    fs::create_directories(top_ / "project/models");
    fs::create_directories(top_ / "project-2");
    for (const char* file : {"project/models/car.obj", "project/scenarios/deep/car.obj",
                             "secret.obj", "project-2/car.obj"}) {
      std::ofstream(top_ / file) << "v 0 0 0\n";
    }
    scenario_ = (top_ / "project/scenarios/s.json").string();
  }
  void TearDown() override { fs::remove_all(top_); }

  bool reaches(const std::string& mesh, const ScenarioPaths& paths = {}) const {
    return resolve_mesh_path(scenario_, mesh, paths).ok();
  }

  fs::path top_;
  std::string scenario_;
};

TEST_F(ScenarioPathsTest, AScenarioReachesItsOwnFolderOnly) {
  EXPECT_EQ(*resolve_mesh_path(scenario_, "deep/car.obj"),
            (top_ / "project/scenarios/deep/car.obj").string());
  EXPECT_TRUE(reaches("deep/../deep/car.obj"));
  EXPECT_TRUE(reaches((top_ / "project/scenarios/deep/car.obj").string()));
  EXPECT_FALSE(reaches("../models/car.obj"));
  EXPECT_FALSE(reaches("../../secret.obj"));
  EXPECT_FALSE(reaches("/etc/passwd"));
}

TEST_F(ScenarioPathsTest, AMarkedFolderAboveWidensIt) {
  std::ofstream(top_ / "project/crashrank.root");
  EXPECT_EQ(*resolve_mesh_path(scenario_, "../models/car.obj"),
            (top_ / "project/models/car.obj").string());
  EXPECT_FALSE(reaches("../../secret.obj"));
  EXPECT_FALSE(reaches("../../project-2/car.obj"));
}

TEST_F(ScenarioPathsTest, AMarkWhereEverybodyMayWriteIsNobodysWord) {
  std::ofstream(top_ / "project/crashrank.root");
  fs::permissions(top_ / "project", fs::perms::others_write, fs::perm_options::add);
  EXPECT_FALSE(reaches("../models/car.obj"));
  fs::permissions(top_ / "project", fs::perms::others_write, fs::perm_options::remove);
  EXPECT_TRUE(reaches("../models/car.obj"));
}

TEST_F(ScenarioPathsTest, TheCallerWidensItToo) {
  EXPECT_TRUE(reaches("../models/car.obj", {{(top_ / "project/models").string()}}));
  EXPECT_TRUE(reaches("../models/car.obj", {{(top_ / "project/models").string() + "/"}}));
  EXPECT_TRUE(reaches("../../secret.obj", {{"/"}}));
  EXPECT_FALSE(reaches("../../secret.obj", {{(top_ / "project").string()}}));
  EXPECT_FALSE(reaches("../../project-2/car.obj", {{(top_ / "project").string()}}));
}

TEST_F(ScenarioPathsTest, ALinkDoesNotLeadOut) {
  fs::create_symlink(top_ / "secret.obj", top_ / "project/scenarios/link.obj");
  fs::create_directory_symlink(top_, top_ / "project/scenarios/up");
  EXPECT_FALSE(reaches("link.obj"));
  EXPECT_FALSE(reaches("up/secret.obj"));
}

TEST_F(ScenarioPathsTest, LoadingNamesTheModelWhoseMeshIsOutside) {
  const std::string text =
      R"({"scenario_version":1,"models":{"spy":{"mesh":"../../secret.obj","kind":"car"}},)"
      R"("ego":{"model":"spy","speed_mps":1}})";
  std::ofstream(scenario_) << text;
  const Result<Scenario> outside = load_scenario_file(scenario_);
  ASSERT_FALSE(outside.ok());
  EXPECT_EQ(outside.error().place, "models.spy.mesh");
  EXPECT_EQ(outside.error().code, ErrorCode::bad_input);
  const Result<Scenario> inside = load_scenario_file(scenario_, {{top_.string()}});
  ASSERT_TRUE(inside.ok()) << inside.error().message();
  EXPECT_EQ(inside->models[0].path, (top_ / "secret.obj").string());
}

TEST_F(ScenarioPathsTest, WhatIsNoFileIsNotRead) {
  EXPECT_EQ(load_scenario_file((top_ / "absent.json").string()).error().code, ErrorCode::not_found);
  EXPECT_EQ(load_scenario_file(top_.string()).error().code, ErrorCode::not_found);
  EXPECT_EQ(load_scenario_file("/dev/zero").error().code, ErrorCode::not_found);
}

}  // namespace
}  // namespace crashrank

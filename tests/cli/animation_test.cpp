#include "cli/program.hpp"

#include <assimp/scene.h>
#include <gtest/gtest.h>
#include <assimp/Importer.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

// The file is read by assimp's reader of glTF, and its motion is compared with that of the JSON
// answer, which is of centres of mass in world axes (z up), whereas nodes are origins of bodies.

namespace {

using cli_test::Json;
using cli_test::Outcome;
using cli_test::Workplace;

constexpr const char* scenario = CRASHRANK_SOURCE_DATA "/scenarios/oncoming_truck.json";

struct Planar {
  double x = 0.0;
  double y = 0.0;
  double yaw = 0.0;
};

/// What a viewer computes between the two keys around a time: assimp's times are milliseconds.
template <class Value, class Key> Value value_at(const Key* keys, unsigned count, double time_ms) {
  unsigned next = 1;
  while (next + 1 < count && keys[next].mTime < time_ms) ++next;
  const Key& from = keys[next - 1];
  const Key& to = keys[next];
  const double share = std::clamp((time_ms - from.mTime) / (to.mTime - from.mTime), 0.0, 1.0);
  Value between;
  Assimp::Interpolator<Key>()(between, from, to, static_cast<ai_real>(share));
  return between;
}

Planar pose_at(const aiNodeAnim& channel, double time_s) {
  const auto place =
      value_at<aiVector3D>(channel.mPositionKeys, channel.mNumPositionKeys, 1e3 * time_s);
  const auto turn =
      value_at<aiQuaternion>(channel.mRotationKeys, channel.mNumRotationKeys, 1e3 * time_s);
  const aiVector3D forward = turn.Rotate({1.0F, 0.0F, 0.0F});
  return {place.x, place.y, std::atan2(forward.y, forward.x)};
}

const aiNodeAnim* channel_of(const aiScene& scene, const std::string& name) {
  const aiAnimation& animation = *scene.mAnimations[0];
  for (unsigned i = 0; i < animation.mNumChannels; ++i) {
    if (name == animation.mChannels[i]->mNodeName.C_Str()) return animation.mChannels[i];
  }
  return nullptr;
}

TEST(Animation, AnotherReaderFindsTheMotionOfTheJsonAnswer) {
  const Workplace place;
  const Outcome run =
      place.crashrank({"rank", scenario, "--json", "--motion", "--animation", "out.glb"});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json answer = run.json();
  const Json& winner = answer.at("ranking")[0];
  Assimp::Importer importer;
  const aiScene* const scene = importer.ReadFile(place.path("out.glb"), 0);
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();

  // One node a body, under a root that turns z up into y up and x ahead into z ahead.
  const aiNode& root = *scene->mRootNode;
  ASSERT_EQ(root.mNumChildren, answer.at("actors").size() + 1);
  const aiVector3D up = root.mTransformation * aiVector3D(0.0F, 0.0F, 1.0F);
  EXPECT_NEAR(up.y, 1.0, 1e-6);
  const aiVector3D ahead = root.mTransformation * aiVector3D(1.0F, 0.0F, 0.0F);
  EXPECT_NEAR(ahead.z, 1.0, 1e-6);
  for (const Json& actor : answer.at("actors")) {
    const auto name = actor.at("name").get<std::string>();
    EXPECT_NE(root.FindNode(name.c_str()), nullptr) << name;
  }

  ASSERT_EQ(scene->mNumAnimations, 1U);
  const aiAnimation& animation = *scene->mAnimations[0];
  EXPECT_EQ(animation.mName.C_Str(), winner.at("candidate").get<std::string>());
  // The ego, the lorry and the saloon move; barriers, pole and wall do not.
  EXPECT_EQ(animation.mNumChannels, 3U);
  std::size_t compared = 0;
  for (const Json& motion : winner.at("motion")) {
    const aiNodeAnim* const channel = channel_of(*scene, motion.at("body").get<std::string>());
    ASSERT_NE(channel, nullptr) << motion.at("body");
    EXPECT_EQ(channel->mPositionKeys[0].mTime, 0.0);
    EXPECT_EQ(channel->mRotationKeys[0].mTime, 0.0);
    // The origin stays where it is in the body's axes, seen from the centre of mass.
    Planar offset;
    for (std::size_t i = 0; i < motion.at("t_s").size(); ++i) {
      const double time_s = motion.at("t_s")[i];
      if (1e3 * time_s > animation.mDuration) break;
      const Planar at = pose_at(*channel, time_s);
      const double yaw = motion.at("yaw_deg")[i].get<double>() * M_PI / 180.0;
      const double dx = at.x - motion.at("x_m")[i].get<double>();
      const double dy = at.y - motion.at("y_m")[i].get<double>();
      const double ahead_m = std::cos(yaw) * dx + std::sin(yaw) * dy;
      const double left_m = std::cos(yaw) * dy - std::sin(yaw) * dx;
      if (i == 0) offset = {ahead_m, left_m, 0.0};
      EXPECT_NEAR(ahead_m, offset.x, 1e-3) << time_s;
      EXPECT_NEAR(left_m, offset.y, 1e-3) << time_s;
      EXPECT_NEAR(std::remainder(at.yaw - yaw, 2.0 * M_PI), 0.0, 1e-3) << time_s;
      ++compared;
    }
    // An origin below the rear axle is behind the centre of mass, in the middle.
    EXPECT_LT(offset.x, -0.5);
    EXPECT_NEAR(offset.y, 0.0, 0.05);
  }
  EXPECT_GT(compared, 500U);
  // Before its contact the lorry brakes as the scenario says.
  const aiNodeAnim* const lorry = channel_of(*scene, "lorry");
  ASSERT_NE(lorry, nullptr);
  const Json file = Json::parse(place.shell("cat '" + std::string(scenario) + "'").out);
  const Json& stated = file.at("actors")[0];
  const Planar begin = pose_at(*lorry, 0.0);
  const Planar later = pose_at(*lorry, 0.5);
  EXPECT_NEAR(begin.x, stated.at("pose").at("x_m").get<double>(), 1e-3);
  EXPECT_NEAR(begin.y, stated.at("pose").at("y_m").get<double>(), 1e-3);
  EXPECT_NEAR(std::hypot(later.x - begin.x, later.y - begin.y),
              0.5 * stated.at("speed_mps").get<double>() +
                  0.125 * stated.at("acceleration_mps2").get<double>(),
              2e-3);
}

TEST(Animation, BodiesOfOneModelShareItsArrays) {
  const Workplace place;
  const Outcome run = place.crashrank({"rank", scenario, "--animation", "out.glb"});
  ASSERT_EQ(run.code, 0) << run.err;
  const std::string bytes = place.read("out.glb");
  const std::size_t end = bytes.find("BIN") - 4;
  const Json whole = Json::parse(bytes.substr(20, end - 20));
  std::set<std::size_t> meshes;
  for (const Json& node : whole.at("nodes")) {
    if (node.contains("mesh")) meshes.insert(node.at("mesh").get<std::size_t>());
  }
  EXPECT_EQ(meshes.size(), whole.at("meshes").size());
  EXPECT_EQ(meshes.size() + 5, whole.at("nodes").size() - 1);  // six barriers are one mesh
  std::set<std::size_t> positions;
  for (const Json& mesh : whole.at("meshes")) {
    std::set<std::size_t> own;
    for (const Json& triangles : mesh.at("primitives")) {
      own.insert(triangles.at("attributes").at("POSITION").get<std::size_t>());
    }
    EXPECT_EQ(own.size(), 1U);
    positions.insert(own.begin(), own.end());
  }
  EXPECT_EQ(positions.size(), meshes.size());
}

TEST(Animation, WhatCannotBeWrittenIsRefusedBeforeTheWork) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  const auto refused = [&](const std::vector<std::string>& options, int code,
                           const std::string& reason) {
    std::vector<std::string> arguments{"rank", "scenario.json"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome run = place.crashrank(arguments);
    EXPECT_EQ(run.code, code) << reason;
    EXPECT_TRUE(cli_test::is_one_message(run.err)) << run.err;
    EXPECT_NE(run.err.find(reason), std::string::npos) << run.err;
  };
  refused({"--animation", "-"}, 2, "needs a file");
  refused({"--animation", "ego.obj"}, 2, "ego.obj: would be written over what is read");
  refused({"--animation", "nowhere/out.glb"}, 3, "nowhere/out.glb: cannot write");
  refused({"--animation", "out.glb", "--report", "out.glb"}, 2, "is the file of --report");
  refused({"--animation", "out.glb", "--deadline-ms", "5"}, 2, "within a budget");
  place.write("notes.glb", "not a mesh");
  refused({"--animation", "notes.glb"}, 2, "is kept");
  EXPECT_EQ(place.read("notes.glb"), "not a mesh");
}

}  // namespace

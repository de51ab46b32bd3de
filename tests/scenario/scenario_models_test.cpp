#include "crashrank/scenario/scenario_models.hpp"

#include "crashrank/mesh/properties.hpp"
#include "crashrank/model/make_model.hpp"
#include "crashrank/model/model.hpp"
#include "mesh/scratch_dir.hpp"
#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using test::ScratchDir;

constexpr const char* triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

std::string compiled(const ScratchDir& dir, const StatedMass& stated) {
  StoredModel stored;
  stored.model = *make_model(scenes::box_mesh({2.0F, 0.9F, 0.7F}, 3));
  stored.mass = shell_properties(stored.model.mesh);
  stored.stated = stated;
  const std::string file = (dir.path() / "car.crm").string();
  EXPECT_TRUE(save_model(stored, file, true).ok());
  return file;
}

std::string compiled(const ScratchDir& dir, double mass_kg) {
  StatedMass stated;
  if (mass_kg > 0.0) stated.mass_kg = mass_kg;
  return compiled(dir, stated);
}

ScenarioModel wanted(const std::string& name, const std::string& path) {
  ScenarioModel model;
  model.name = name;
  model.path = path;
  return model;
}

TEST(ScenarioModels, MeshesAndModelFilesAreReadInOrderAndTellTheirMass) {
  const ScratchDir dir;
  Scenario scenario;
  scenario.models = {wanted("mesh", dir.write("t.obj", triangle)),
                     wanted("car", compiled(dir, 3000.0)), wanted("told", compiled(dir, 3000.0))};
  scenario.models[0].transform.scale = 2.0;
  scenario.models[2].mass_kg = 1200.0;
  const Result<std::vector<Model>> models = load_scenario_models(scenario);
  ASSERT_TRUE(models.ok()) << models.error().message();
  ASSERT_EQ(models->size(), 3U);
  EXPECT_EQ((*models)[0].mesh.size(), 1U);
  EXPECT_EQ((*models)[0].mesh.bounds().extent().x(), 2.0F);
  EXPECT_EQ((*models)[1].mesh.size(), 108U);
  EXPECT_FALSE(scenario.models[0].mass_kg.has_value());
  EXPECT_EQ(scenario.models[1].mass_kg, 3000.0);
  EXPECT_EQ(scenario.models[2].mass_kg, 1200.0);
}

TEST(ScenarioModels, ABoxBecomesTheBodyOfItsKind) {
  Scenario scenario;
  ScenarioModel model;
  model.name = "seen";
  model.kind = BodyKind::truck;
  model.box_m = Eigen::Vector3d(8.0, 2.5, 3.5);
  model.transform.origin_m.x() = 2.0;  // from the rear axle to the middle
  scenario.models = {model};
  const Result<std::vector<Model>> models = load_scenario_models(scenario);
  ASSERT_TRUE(models.ok()) << models.error().message();
  const Box box = models->front().mesh.bounds();
  EXPECT_TRUE(box.extent().isApprox(Eigen::Vector3f(8.0F, 2.5F, 3.5F)));
  EXPECT_TRUE(box.center().isApprox(Eigen::Vector3f(0.0F, 0.0F, 1.75F)));
  for (const auto& [side, path] : {std::pair(std::nan(""), ""), std::pair(2.5, "truck.obj")}) {
    scenario.models[0].box_m->y() = side;
    scenario.models[0].path = path;
    const Result<std::vector<Model>> refused = load_scenario_models(scenario);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::bad_input);
    EXPECT_EQ(refused.error().place, "models.seen.box");
    EXPECT_FALSE(refused.error().remedy.empty());
  }
}

TEST(ScenarioModels, EachStatedQuantityIsTheFilesUnlessTheScenarioStatesIt) {
  const ScratchDir dir;
  const StatedMass of_file{1500.0, Eigen::Vector3d(0.4, 0.01, 0.6), 2400.0};
  const StatedMass of_scenario{1200.0, Eigen::Vector3d(-0.2, 0.0, 0.5), 1900.0};
  const std::string car = compiled(dir, of_file);
  for (unsigned chosen = 0; chosen < 8; ++chosen) {
    SCOPED_TRACE(chosen);
    Scenario scenario;
    ScenarioModel model = wanted("car", car);
    const bool mass = (chosen & 1U) != 0;
    const bool center = (chosen & 2U) != 0;
    const bool inertia = (chosen & 4U) != 0;
    if (mass) model.mass_kg = of_scenario.mass_kg;
    if (center) model.center_of_mass_m = of_scenario.center_of_mass_m;
    if (inertia) model.yaw_inertia_kgm2 = of_scenario.yaw_inertia_kgm2;
    scenario.models = {model};
    ASSERT_TRUE(load_scenario_models(scenario).ok());
    const ScenarioModel& read = scenario.models[0];
    EXPECT_EQ(read.mass_kg, (mass ? of_scenario : of_file).mass_kg);
    EXPECT_EQ(read.center_of_mass_m, (center ? of_scenario : of_file).center_of_mass_m);
    EXPECT_EQ(read.yaw_inertia_kgm2, (inertia ? of_scenario : of_file).yaw_inertia_kgm2);
  }
}

TEST(ScenarioModels, AYawInertiaThatNoScenarioMayGiveIsTheFilesFault) {
  const ScratchDir dir;
  ScenarioModel model = wanted("car", compiled(dir, {std::nullopt, std::nullopt, 1.1e9}));
  const Result<LoadedScenarioModel> refused = load_scenario_model(model);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::bad_input);
  EXPECT_EQ(refused.error().file, model.path);
  for (const char* part : {"yaw inertia", "1e+09", "--yaw-inertia-kgm2", "yaw_inertia_kgm2"}) {
    EXPECT_NE(refused.error().message().find(part), std::string::npos) << refused.error().message();
  }
  model.yaw_inertia_kgm2 = 2000.0;
  EXPECT_TRUE(load_scenario_model(model).ok());
}

TEST(ScenarioModels, AYawInertiaThatTheScenariosMassCannotHaveIsTheFilesFault) {
  const ScratchDir dir;
  ScenarioModel model = wanted("car", compiled(dir, {1500.0, std::nullopt, 2400.0}));
  model.mass_kg = 10.0;
  const Result<LoadedScenarioModel> refused = load_scenario_model(model);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::bad_input);
  EXPECT_EQ(refused.error().file, model.path);
  EXPECT_EQ(refused.error().place, "yaw inertia");
  EXPECT_NE(refused.error().message().find("models.car.mesh"), std::string::npos);
  model.yaw_inertia_kgm2 = 16.0;
  EXPECT_TRUE(load_scenario_model(model).ok());
  model.yaw_inertia_kgm2.reset();
  model.mass_kg = 1400.0;
  EXPECT_TRUE(load_scenario_model(model).ok());
  // Guessed as that of a person.
  model.path = compiled(dir, {std::nullopt, std::nullopt, 2400.0});
  model.mass_kg.reset();
  EXPECT_TRUE(load_scenario_model(model).ok());
  model.kind = BodyKind::pedestrian;
  EXPECT_FALSE(load_scenario_model(model).ok());
  model.kind = BodyKind::pole;
  EXPECT_TRUE(load_scenario_model(model).ok());
}

TEST(ScenarioModels, WhatCannotBeReadNamesItsModelAndChangesNothing) {
  const ScratchDir dir;
  const std::string car = compiled(dir, 3000.0);
  ScenarioModel turned = wanted("turned", car);
  turned.transform.up = Axis::plus_y;
  turned.transform.forward = Axis::plus_z;
  struct Case {
    ScenarioModel model;
    ErrorCode code;
    const char* told;
  };
  for (const Case& bad : std::vector<Case>{
           {wanted("gone", dir.path() / "gone.obj"), ErrorCode::not_found, "models.gone.mesh"},
           {wanted("lost", dir.path() / "lost.crm"), ErrorCode::not_found, "models.lost.mesh"},
           {wanted("none", dir.write("none.obj", "v 0 0 0\n")), ErrorCode::bad_input, "none.obj"},
           {turned, ErrorCode::bad_input, "a model file has its frame already"},
           {wanted("nowhere", ""), ErrorCode::usage, "'nowhere' names no mesh file"}}) {
    Scenario scenario;
    scenario.models = {wanted("car", car), bad.model};
    const Result<std::vector<Model>> models = load_scenario_models(scenario);
    ASSERT_FALSE(models.ok()) << bad.told;
    EXPECT_EQ(models.error().code, bad.code) << models.error().message();
    EXPECT_NE(models.error().message().find(bad.told), std::string::npos)
        << models.error().message();
    EXPECT_FALSE(scenario.models[0].mass_kg.has_value());
  }
}

TEST(ScenarioModels, AMassThatNoScenarioMayGiveIsTheFilesFaultUnlessTheScenarioGivesOne) {
  const ScratchDir dir;
  for (const double mass_kg : {1e9, 0.01}) {
    SCOPED_TRACE(mass_kg);
    const std::string car = compiled(dir, mass_kg);
    ScenarioModel model = wanted("car", car);
    const Result<LoadedScenarioModel> refused = load_scenario_model(model);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::bad_input);
    EXPECT_EQ(refused.error().file, car);
    for (const char* told : {"0.1", "1000000", "--mass-kg", "give mass_kg in the scenario"}) {
      EXPECT_NE(refused.error().message().find(told), std::string::npos)
          << refused.error().message();
    }
    model.mass_kg = 1200.0;
    EXPECT_TRUE(load_scenario_model(model).ok());
  }
  for (const double mass_kg : {0.0, 0.1, 1e6}) {
    EXPECT_TRUE(load_scenario_model(wanted("car", compiled(dir, mass_kg))).ok()) << mass_kg;
  }
}

}  // namespace
}  // namespace crashrank

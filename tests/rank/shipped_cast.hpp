#pragma once

#include "crashrank/mesh/profile.hpp"
#include "crashrank/model/make_model.hpp"
#include "crashrank/model/model.hpp"

#include "oracle/shipped_models.hpp"
#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace crashrank::scenes {

inline TriangleMesh shipped_mesh(const std::string& name) {
  Result<TriangleMesh> mesh =
      oracle::read_obj(std::string(CRASHRANK_MODEL_FOLDER "/") + name + ".obj");
  EXPECT_TRUE(mesh.ok());
  return mesh.ok() ? std::move(*mesh) : TriangleMesh{};
}

/// With its outline, which every ranking would compute again otherwise.
inline Model shipped_model(const std::string& name) {
  Result<Model> model = make_model(shipped_mesh(name));
  EXPECT_TRUE(model.ok());
  Result<Profile> profile = make_profile(model->mesh);
  EXPECT_TRUE(profile.ok());
  model->profile = std::make_shared<const Profile>(std::move(*profile));
  return std::move(*model);
}

/// A body for the models of `CastModel`.
struct ShippedRole {
  const char* name;
  BodyKind kind;
};
inline constexpr std::array<ShippedRole, 7> shipped_roles{{{"hatch", BodyKind::car},
                                                           {"hatch", BodyKind::car},
                                                           {"truck", BodyKind::truck},
                                                           {"pedestrian", BodyKind::pedestrian},
                                                           {"motorcycle", BodyKind::motorcycle},
                                                           {"pole", BodyKind::pole},
                                                           {"jersey_barrier", BodyKind::barrier}}};

/// The models of `shipped_roles`, made once.
inline const std::vector<Model>& shipped_cast() {
  static const std::vector<Model> cast = [] {
    std::vector<Model> models;
    for (const ShippedRole& role : shipped_roles) models.push_back(shipped_model(role.name));
    return models;
  }();
  return cast;
}

/// Adds the models of `shipped_cast` to a scenario.
inline void name_shipped_cast(Scenario& scenario) {
  for (const ShippedRole& role : shipped_roles) {
    ScenarioModel model;
    model.name = std::string(role.name) + std::to_string(scenario.models.size());
    model.kind = role.kind;
    scenario.models.push_back(model);
  }
  scenario.ego.model = 0;
}

}  // namespace crashrank::scenes

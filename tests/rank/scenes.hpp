#pragma once

#include "crashrank/model/make_model.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <gtest/gtest.h>
#include <bit>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace crashrank::scenes {

inline bool same_bits(double p, double q) {
  return std::bit_cast<std::uint64_t>(p) == std::bit_cast<std::uint64_t>(q);
}

/// A closed box with corners at plus and minus half, each face cut into n × n squares of two
/// triangles, one part a face: rear, front, right, left, bottom, top.
inline TriangleMesh box_mesh(const Eigen::Vector3f& half, int n = 1,
                             const Eigen::Vector3f& center = Eigen::Vector3f::Zero()) {
  constexpr std::array<const char*, 6> names{"rear", "front", "right", "left", "bottom", "top"};
  TriangleMesh mesh;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const bool positive = face % 2 == 1;
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; j <= n; ++j) {
        Eigen::Vector3f corner;
        corner[axis] = positive ? 1.0F : -1.0F;
        corner[u] = 2.0F * static_cast<float>(i) / static_cast<float>(n) - 1.0F;
        corner[v] = 2.0F * static_cast<float>(j) / static_cast<float>(n) - 1.0F;
        mesh.vertices.emplace_back(center + corner.cwiseProduct(half));
      }
    }
    Part part;
    part.name = names[static_cast<std::size_t>(face)];
    part.first_triangle = static_cast<std::uint32_t>(mesh.triangles.size());
    const auto side = static_cast<std::uint32_t>(n + 1);
    for (std::uint32_t i = 0; i + 1 < side; ++i) {
      for (std::uint32_t j = 0; j + 1 < side; ++j) {
        const std::uint32_t a = base + i * side + j;
        const std::uint32_t b = a + side;
        mesh.triangles.push_back(positive ? std::array{a, b, b + 1} : std::array{a, b + 1, b});
        mesh.triangles.push_back(positive ? std::array{a, b + 1, a + 1}
                                          : std::array{a, a + 1, b + 1});
      }
    }
    part.triangle_count = static_cast<std::uint32_t>(mesh.triangles.size()) - part.first_triangle;
    mesh.parts.push_back(part);
  }
  return mesh;
}

/// A scenario under construction: models and actors are added by value.
struct Scene {
  Scenario scenario;
  std::vector<Model> models;

  Scene() {
    scenario.name = "test";
    scenario.measure = Measure::polygons;
    scenario.grid.reset();
    scenario.add_straight_braking = false;
  }

  std::size_t add_model(const std::string& name, TriangleMesh mesh, BodyKind kind,
                        std::optional<double> mass_kg = std::nullopt) {
    ScenarioModel model;
    model.name = name;
    model.kind = kind;
    model.mass_kg = mass_kg;
    scenario.models.push_back(model);
    Result<Model> built = make_model(std::move(mesh));
    EXPECT_TRUE(built.ok());
    models.push_back(std::move(*built));
    return models.size() - 1;
  }

  ScenarioActor& add_actor(const std::string& name, std::size_t model, double x, double y,
                           double yaw = 0.0, double speed_mps = 0.0) {
    ScenarioActor actor;
    actor.name = name;
    actor.model = model;
    actor.pose = pose_from_angles({x, y, 0.0}, yaw, 0.0, 0.0);
    actor.speed_mps = speed_mps;
    scenario.actors.push_back(actor);
    return scenario.actors.back();
  }

  ListedCandidate& add_candidate(const std::string& name, double acceleration_mps2,
                                 std::optional<double> steering_rad = std::nullopt) {
    ListedCandidate candidate;
    candidate.name = name;
    candidate.acceleration_mps2 = acceleration_mps2;
    candidate.steering_rad = steering_rad;
    scenario.listed.push_back(candidate);
    return scenario.listed.back();
  }

  RankResult ranked(const RankOptions& options = {}) const {
    Result<RankResult> result = rank(scenario, models, options);
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message());
    return result.ok() ? std::move(*result) : RankResult{};
  }

  RankResult ranked(Measure measure) const {
    RankOptions options;
    options.measure = measure;
    return ranked(options);
  }
};

/// The result of a candidate, wherever it is in the ranking.
inline const CandidateResult& of(const RankResult& result, const std::string& name) {
  for (const CandidateResult& candidate : result.ranking) {
    if (result.candidates[candidate.candidate].name == name) return candidate;
  }
  ADD_FAILURE() << "no candidate " << name;
  return result.ranking.front();
}

inline std::vector<std::string> part_names(const Model& model, const BodyDamage& damage) {
  std::vector<std::string> names;
  for (const std::uint32_t part : damage.parts) names.push_back(model.mesh.parts[part].name);
  return names;
}

/// A 4 × 2 × 1.5 m car at the origin, driving at 20 m/s, and a wall 47.5 m ahead of its front.
inline Scene car_and_wall(std::optional<double> wall_kg = std::nullopt) {
  Scene scene;
  scene.scenario.ego.model = scene.add_model("car", box_mesh({2, 1, 0.75}), BodyKind::car, 1500.0);
  scene.scenario.ego.speed_mps = 20.0;
  const std::size_t wall =
      scene.add_model("wall", box_mesh({0.5F, 10, 3}), BodyKind::barrier, wall_kg);
  scene.add_actor("wall", wall, 50.0, 0.0);
  return scene;
}

/// A car of 4 × 1.8 × 1.4 m and 1000 kg at 16 m/s on a straight road, ranked by harm.
inline Scene car_on_road(double grip) {
  Scene scene;
  scene.scenario.ego.model =
      scene.add_model("car", box_mesh({2.0F, 0.9F, 0.7F}, 6, {0, 0, 0.7F}), BodyKind::car, 1000.0);
  scene.scenario.ego.speed_mps = 16.0;
  scene.scenario.horizon_s = 6.0;
  scene.scenario.measure = Measure::harm;
  scene.scenario.grip = grip;
  scene.add_candidate("on", 0.0);
  return scene;
}

}  // namespace crashrank::scenes

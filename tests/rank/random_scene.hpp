#pragma once

#include "oracle/random.hpp"
#include "rank/scenes.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

namespace crashrank::scenes {

/// A closed wedge, its front lower than its rear.
inline TriangleMesh wedge_mesh(float length, float width, float rear, float front) {
  TriangleMesh mesh;
  const float x = 0.5F * length;
  const float y = 0.5F * width;
  mesh.vertices = {{-x, -y, 0.0F}, {x, -y, 0.0F},  {x, y, 0.0F},  {-x, y, 0.0F},
                   {-x, -y, rear}, {x, -y, front}, {x, y, front}, {-x, y, rear}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                    {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
  mesh.parts.push_back({"hull", 0, 12});
  return mesh;
}

/// A closed round body that stands on the ground.
inline TriangleMesh round_mesh(float radius, float height, std::uint32_t sides) {
  TriangleMesh mesh;
  for (const float z : {0.0F, height}) {
    for (std::uint32_t i = 0; i < sides; ++i) {
      const float angle =
          2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(sides);
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  }
  mesh.vertices.emplace_back(0.0F, 0.0F, 0.0F);
  mesh.vertices.emplace_back(0.0F, 0.0F, height);
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t j = (i + 1) % sides;
    mesh.triangles.push_back({i, j, j + sides});
    mesh.triangles.push_back({i, j + sides, i + sides});
    mesh.triangles.push_back({2 * sides, j, i});
    mesh.triangles.push_back({2 * sides + 1, i + sides, j + sides});
  }
  mesh.parts.push_back({"hull", 0, static_cast<std::uint32_t>(mesh.size())});
  return mesh;
}

/// Indices of the models of `add_cast` in a scene.
enum CastModel : std::size_t {
  ego_model,
  car_model,
  truck_model,
  person_model,
  two_wheeler_model,
  pole_model,
  wall_model,
};

/// Models of random traffic with few triangles, 12 to 500.
inline void add_cast(oracle::Random& random, Scene& scene) {
  const auto real = [&random](double low, double high) {
    return static_cast<float>(random.real(low, high));
  };
  const auto car = [&] {
    if (random.chance(0.5)) {
      return wedge_mesh(real(3.2, 5.0), real(1.5, 2.0), real(1.2, 1.6), real(0.5, 1.0));
    }
    const float half_height = real(0.6, 0.8);
    return box_mesh({real(1.6, 2.5), real(0.75, 1.0), half_height},
                    static_cast<int>(random.integer(1, 6)), {0.0F, 0.0F, half_height});
  };
  scene.scenario.ego.model = scene.add_model("ego", car(), BodyKind::car, random.real(800, 2500));
  scene.add_model("car", car(), BodyKind::car, random.real(800, 2500));
  scene.add_model("truck", box_mesh({4.0F, 1.25F, 1.5F}, 2, {0.0F, 0.0F, 1.9F}), BodyKind::truck,
                  random.real(8000, 30000));
  scene.add_model("pedestrian", round_mesh(0.3F, 1.75F, 8), BodyKind::pedestrian, 75.0);
  scene.add_model("cyclist", wedge_mesh(1.8F, 0.5F, 1.6F, 1.2F), BodyKind::bicycle, 90.0);
  scene.add_model("pole", round_mesh(0.15F, 5.0F, 10), BodyKind::pole);
  scene.add_model("wall", box_mesh({6.0F, 0.2F, 1.0F}, 1, {0.0F, 0.0F, 1.0F}), BodyKind::building);
  if (!random.chance(0.5)) return;
  // Some of the poles break away, and some of the walls are rails.
  scene.scenario.models[pole_model].mass_kg = random.real(10, 300);
  scene.scenario.models[pole_model].breakaway = Breakaway{random.real(5e3, 100e3)};
  scene.scenario.models[wall_model].deflection_m = random.real(0.2, 2.0);
}

/// Random traffic of every kind around an ego, with models of 12 to 500 triangles.
inline Scene traffic(std::uint64_t seed) {
  oracle::Random random(seed);
  Scene scene;
  add_cast(random, scene);
  scene.scenario.ego.speed_mps = random.real(5, 30);
  scene.scenario.horizon_s = random.real(1.5, 3.0);
  scene.scenario.grid = CandidateGrid{3, 5};
  const auto actors = static_cast<int>(random.integer(1, 7));
  for (int i = 0; i < actors; ++i) {
    const auto model = static_cast<std::size_t>(random.integer(1, 6));
    const double ahead = random.real(5, 60);
    const double aside = random.real(-1, 1) * random.real(0, 12);
    ScenarioActor& actor = scene.add_actor("actor " + std::to_string(i), model, ahead, aside,
                                           random.real(-3.14, 3.14));
    if (model >= pole_model) continue;
    actor.speed_mps = random.real(0, model >= person_model ? 5 : 20);
    actor.acceleration_mps2 = random.real(-4, 2);
    actor.yaw_rate_radps = random.real(-0.3, 0.3);
  }
  return scene;
}

/// A queue of bodies of every kind on three lanes before the fast ego of a scene: the bodies that
/// it hits are pushed into others. The scene has the models of `CastModel`.
inline void add_queue(oracle::Random& random, Scene& scene) {
  scene.scenario.ego.speed_mps = random.real(10, 35);
  scene.scenario.horizon_s = 4.0;
  constexpr double lane_m = 3.2;
  constexpr double end_m = 55.0;
  const double begin_m = random.real(10, 25);
  int number = 0;
  for (int lane = -1; lane <= 1; ++lane) {
    double x = begin_m + random.real(0, 6);
    while (x < end_m) {
      const double kind = random.real(0, 1);
      CastModel model = car_model;
      double half_length_m = 2.4;
      if (kind < 0.12) {
        model = truck_model;
        half_length_m = 6.0;
      } else if (kind < 0.24) {
        model = two_wheeler_model;
        half_length_m = 1.2;
      } else if (kind < 0.38) {
        model = person_model;
        half_length_m = 0.4;
      } else if (kind < 0.44) {
        model = pole_model;
        half_length_m = 0.3;
      } else if (kind < 0.47) {
        model = wall_model;
        half_length_m = 6.0;
      }
      x += half_length_m + random.real(0.5, 5.0);
      ScenarioActor& actor =
          scene.add_actor("actor " + std::to_string(number++), model, x,
                          lane_m * lane + random.real(-0.5, 0.5), random.real(-0.2, 0.2));
      x += half_length_m;
      if (model < pole_model) actor.speed_mps = random.real(0, model == person_model ? 2 : 6);
    }
  }
}

/// A queue of bodies with few triangles, and six candidates.
inline Scene congestion(std::uint64_t seed) {
  oracle::Random random(seed);
  Scene scene;
  add_cast(random, scene);
  add_queue(random, scene);
  scene.scenario.grid = CandidateGrid{2, 3};
  return scene;
}

/// Gives up to `uncertain` movable actors two or three predictions, and some a probability of
/// absence. A fixed body next to another is certain: a wall that may be absent adjoins no other,
/// unlike in a scenario of its own.
inline void add_predictions(oracle::Random& random, Scene& scene, int uncertain) {
  constexpr double reach_m = 13.0;  // one of two walls
  const auto stands_alone = [&scene](const ScenarioActor& fixed) {
    for (const ScenarioActor& other : scene.scenario.actors) {
      const double distance_m = (other.pose.translation - fixed.pose.translation).norm();
      if (&other != &fixed && other.model >= pole_model && distance_m < reach_m) return false;
    }
    return true;
  };
  for (ScenarioActor& actor : scene.scenario.actors) {
    if (actor.model >= pole_model) {
      const bool chosen = random.chance(0.2) && stands_alone(actor);
      if (chosen && uncertain-- > 0) actor.existence_probability = random.real(0.1, 1);
      continue;
    }
    if (uncertain <= 0 || !random.chance(0.6)) continue;
    --uncertain;
    const std::int64_t count = random.integer(2, 3);
    double sum = 0.0;
    for (std::int64_t k = 0; k < count; ++k) {
      Prediction prediction;
      static_cast<ActorMotion&>(prediction) = actor;
      prediction.speed_mps *= random.real(0, 2);
      prediction.acceleration_mps2 += random.real(-3, 2);
      prediction.yaw_rate_radps += random.real(-0.4, 0.4);
      if (random.chance(0.3)) prediction.pose.translation.y() += random.real(-2, 2);
      prediction.probability = random.real(0.1, 1);
      sum += prediction.probability;
      actor.predictions.push_back(prediction);
    }
    for (Prediction& prediction : actor.predictions) prediction.probability /= sum;
    if (random.chance(0.3)) actor.existence_probability = random.real(0.1, 0.9);
  }
}

}  // namespace crashrank::scenes

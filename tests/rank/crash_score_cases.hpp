#pragma once

#include "rank/crash_score.hpp"

#include "tree/shapes.hpp"

#include <array>

namespace crashrank::detail {

inline Body make_body(BodyKind kind) {
  VehicleFacts facts;
  facts.kind = kind;
  const Result<Vehicle> v = describe_vehicle(test::box_mesh({2.0, 0.9, 0.7}, {1.2, 0, 0.7}), facts);
  Body body;
  body.vehicle = std::make_shared<const Vehicle>(*v);
  body.mass_kg = v->mass_kg;
  return body;
}

inline constexpr std::array<BodyKind, 6> movable_kinds{BodyKind::car,     BodyKind::truck,
                                                       BodyKind::bus,     BodyKind::motorcycle,
                                                       BodyKind::bicycle, BodyKind::pedestrian};

/// A scene of a car as the ego and one actor of each movable kind.
inline Scene scene_of(Measure measure) {
  Scene scene;
  scene.measure = measure;
  scene.ego = make_body(BodyKind::car);
  for (const BodyKind kind : movable_kinds) scene.actors.push_back(make_body(kind));
  scene.nominal.model = scene.harm.model;
  return scene;
}

}  // namespace crashrank::detail

#pragma once

#include "rank/tally.hpp"

#include "tree/shapes.hpp"

#include <array>
#include <vector>

namespace crashrank::detail {

inline Body make_body(BodyKind kind) {
  VehicleFacts facts;
  facts.kind = kind;
  const Result<Vehicle> v = describe_vehicle(test::box_mesh({2.0, 0.9, 0.7}, {1.2, 0, 0.7}), facts);
  Body body;
  body.vehicle = *v;
  body.mass_kg = v->mass_kg;
  return body;
}

inline constexpr std::array<BodyKind, 9> all_kinds{
    BodyKind::car,        BodyKind::truck,   BodyKind::bus,
    BodyKind::motorcycle, BodyKind::bicycle, BodyKind::pedestrian,
    BodyKind::barrier,    BodyKind::pole,    BodyKind::building};
/// Index of the building in `all_kinds`.
inline constexpr std::size_t wall = 8;

/// Measures that Tally computes.
inline constexpr std::array<Measure, 4> tallied{Measure::delta_v, Measure::energy,
                                                Measure::intrusion, Measure::harm};

/// A scene of a car as the ego and one actor of each kind.
inline Scene scene_of(Measure measure) {
  Scene scene;
  scene.measure = measure;
  scene.ego = make_body(BodyKind::car);
  for (const BodyKind kind : all_kinds) scene.actors.push_back(make_body(kind));
  scene.nominal.model = scene.harm.model;
  return scene;
}

/// Tally of the contacts in the nominal sample.
inline Tally tally_of(const Scene& scene, const std::vector<ContactEffect>& effects) {
  Tally tally;
  for (const ContactEffect& e : effects) tally.add(scene, e, scene.nominal);
  return tally;
}

}  // namespace crashrank::detail

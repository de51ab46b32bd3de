#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/rank/scenario.hpp"
#include "crashrank/tree/model.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace crashrank::detail {

/// Damage as reports tell it.
struct DamageSummary {
  std::size_t triangles = 0;
  double area_m2 = 0.0;
  std::vector<std::string> parts;  ///< each name once, in mesh order
};

inline const TriangleMesh& mesh_of_actor(const Scenario& scenario, View<const Model> models,
                                         std::size_t actor) {
  return models[scenario.actors[actor].model].mesh;
}

DamageSummary summary_of(const BodyDamage& damage, const TriangleMesh& mesh);

/// Of all bodies that a candidate hits, together.
DamageSummary summary_of_others(const Scenario& scenario, View<const Model> models,
                                const CandidateResult& candidate);

}  // namespace crashrank::detail

#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace crashrank::detail {

/// Numbers and names of a body's damage, as reports print them.
struct DamageSummary {
  std::size_t triangles = 0;
  double area_m2 = 0.0;
  std::vector<std::string> parts;  ///< each name once, in mesh order
};

/// A body other than the ego with its damage from all contacts of a candidate.
struct DamagedBody {
  std::size_t actor = 0;  ///< index into Scenario::actors
  BodyDamage damage;  ///< a triangle hit twice counts once; the pose is that at its first contact
};

inline const TriangleMesh& mesh_of_actor(const Scenario& scenario, View<const Model> models,
                                         std::size_t actor) {
  return models[scenario.actors[actor].model].mesh;
}

DamageSummary summary_of(const BodyDamage& damage, const TriangleMesh& mesh);

/// The bodies other than the ego that a candidate's contacts damage, those between others
/// included, each once, in the order of their first contacts.
std::vector<DamagedBody> damaged_others(const Scenario& scenario, View<const Model> models,
                                        const CandidateResult& candidate);

/// Of all of those together.
DamageSummary summary_of_others(const Scenario& scenario, View<const Model> models,
                                const CandidateResult& candidate);

}  // namespace crashrank::detail

#include "report/damage_summary.hpp"

#include <algorithm>
#include <utility>

namespace crashrank::detail {

DamageSummary summary_of(const BodyDamage& damage, const TriangleMesh& mesh) {
  DamageSummary summary;
  summary.triangles = damage.triangles.size();
  summary.area_m2 = damage.area_m2;
  for (const std::uint32_t part : damage.parts) summary.parts.push_back(mesh.parts[part].name);
  return summary;
}

DamageSummary summary_of_others(const Scenario& scenario, View<const Model> models,
                                const CandidateResult& candidate) {
  DamageSummary all;
  for (const Contact& contact : candidate.contacts) {
    DamageSummary one = summary_of(contact.other, mesh_of_actor(scenario, models, contact.actor));
    all.triangles += one.triangles;
    all.area_m2 += one.area_m2;
    for (std::string& part : one.parts) {
      const bool known = std::find(all.parts.begin(), all.parts.end(), part) != all.parts.end();
      if (!known) all.parts.push_back(std::move(part));
    }
  }
  return all;
}

}  // namespace crashrank::detail

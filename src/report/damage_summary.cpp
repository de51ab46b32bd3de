#include "report/damage_summary.hpp"

#include "rank/damage.hpp"
#include "report/contact_order.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace crashrank::detail {
namespace {

void add_damage_of(std::size_t actor, const BodyDamage& more, std::vector<DamagedBody>& bodies) {
  const auto same = std::find_if(bodies.begin(), bodies.end(),
                                 [actor](const DamagedBody& body) { return body.actor == actor; });
  if (same == bodies.end()) {
    bodies.push_back({actor, more});
    return;
  }
  BodyDamage& whole = same->damage;
  std::vector<std::uint32_t> both;
  std::set_union(whole.triangles.begin(), whole.triangles.end(), more.triangles.begin(),
                 more.triangles.end(), std::back_inserter(both));
  whole.triangles = std::move(both);
  whole.region.grow(more.region);
}

}  // namespace

DamageSummary summary_of(const BodyDamage& damage, const TriangleMesh& mesh) {
  DamageSummary summary;
  summary.triangles = damage.triangles.size();
  summary.area_m2 = damage.area_m2;
  for (const std::uint32_t part : damage.parts) summary.parts.push_back(mesh.parts[part].name);
  return summary;
}

std::vector<DamagedBody> damaged_others(const Scenario& scenario, View<const Model> models,
                                        const CandidateResult& candidate) {
  std::vector<DamagedBody> bodies;
  for (const AnyContact& contact : contacts_in_order(candidate)) {
    if (contact.own != nullptr) {
      add_damage_of(contact.own->actor, contact.own->other, bodies);
    } else {
      add_damage_of(contact.further->a, contact.further->damage_a, bodies);
      add_damage_of(contact.further->b, contact.further->damage_b, bodies);
    }
  }
  for (DamagedBody& body : bodies) {
    fill_area_and_parts(mesh_of_actor(scenario, models, body.actor), body.damage);
  }
  return bodies;
}

DamageSummary summary_of_others(const Scenario& scenario, View<const Model> models,
                                const CandidateResult& candidate) {
  DamageSummary all;
  for (const DamagedBody& body : damaged_others(scenario, models, candidate)) {
    DamageSummary one = summary_of(body.damage, mesh_of_actor(scenario, models, body.actor));
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

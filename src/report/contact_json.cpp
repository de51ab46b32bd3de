#include "report/contact_json.hpp"

#include "crashrank/crash/contact_law.hpp"

#include <cstddef>
#include <utility>

namespace crashrank::detail {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const Eigen::Vector3d& v) { return Json::array({v.x(), v.y(), v.z()}); }

Json outcome_json(const BodyOutcome& o, bool simulated) {
  constexpr double degrees = 180.0 / 3.14159265358979323846;
  Json entry{{"delta_v_mps", o.delta_v_mps},
             {"delta_v_x_mps", o.delta_v_x_mps},
             {"delta_v_y_mps", o.delta_v_y_mps},
             {"yaw_rate_change_dps", o.yaw_rate_change_radps * degrees},
             {"exposure_mps", o.exposure_mps},
             {"pdof_deg", o.pdof_deg},
             {"clock", o.clock}};
  if (!simulated) return entry;
  entry["crush_energy_j"] = o.crush_energy_j;
  entry["ees_mps"] = o.ees_mps;
  entry["crush_m"] = o.crush_m;
  entry["intrusion_m"] = o.intrusion_m;
  entry["cdc"] = o.cdc;
  entry["harm"] = o.harm;
  return entry;
}

Json severity_json(const ContactSeverity& s) {
  Json ego = outcome_json(s.ego, s.simulated);
  Json other = outcome_json(s.other, s.simulated);
  Json entry{{"simulated", s.simulated},
             {"slides", s.slides},
             {"dissipated_j", s.dissipated_j},
             {"a", ego},
             {"b", other},
             {"ego", std::move(ego)},
             {"other", std::move(other)}};
  if (s.simulated) {
    entry["duration_s"] = s.duration_s;
    entry["harm"] = s.harm;
  }
  return entry;
}

Json severity_json(const FurtherContact& contact, bool simulated) {
  Json entry{{"simulated", simulated},
             {"slides", contact.slides},
             {"dissipated_j", contact.dissipated_j},
             {"a", outcome_json(contact.outcome_a, simulated)},
             {"b", outcome_json(contact.outcome_b, simulated)}};
  if (simulated) {
    entry["duration_s"] = contact.duration_s;
    entry["harm"] = contact.harm;
  }
  return entry;
}

/// Corners of a region in body coordinates, null if the surfaces do not intersect.
Json region(const Box& box) {
  if (box.empty()) return nullptr;
  return {{"min", vector_json(box.min.cast<double>())},
          {"max", vector_json(box.max.cast<double>())}};
}

}  // namespace

const char* impact_state_name(ImpactState state) {
  switch (state) {
    case ImpactState::none:
      return "none";
    case ImpactState::grazing:
      return "grazing";
    case ImpactState::contact:
      return "contact";
    case ImpactState::overlapping:
      return "overlapping";
    case ImpactState::contained:
      return "contained";
    case ImpactState::undecided:
      break;
  }
  return "undecided";
}

void add_damage(Json& entry, const DamageSummary& first, const DamageSummary& second,
                SideKeys keys) {
  entry["damaged_triangles"] = both(first.triangles, second.triangles, keys);
  entry["damaged_area_m2"] = both(first.area_m2, second.area_m2, keys);
  entry["damaged_parts"] = both(Json(first.parts), Json(second.parts), keys);
}

Json contact_json(const Scenario& scenario, View<const Model> models, const Contact& contact) {
  Json entry{{"bodies", {"ego", scenario.actors[contact.actor].name}},
             {"other", scenario.actors[contact.actor].name},
             {"state", impact_state_name(contact.state)},
             {"time_of_impact_s", contact.time_of_impact_s},
             {"closing_speed_mps", contact.closing_speed_mps},
             {"beyond_crash_model", contact.closing_speed_mps > fastest_contact_mps},
             {"normal_speed_mps", contact.normal_speed_mps},
             {"contact_without_force", contact.contact_without_force},
             {"closing_energy_j", contact.closing_energy_j},
             {"gap_m", contact.gap_m},
             {"point_m", vector_json(contact.point_m)},
             {"normal", vector_json(contact.normal)},
             {"crush_s", contact.crush_s},
             {"crush_m", contact.severity.ego.crush_m},
             {"travel_m", contact.travel_m},
             {"region_m", both(region(contact.ego.region), region(contact.other.region))}};
  entry["severity"] = severity_json(contact.severity);
  add_damage(entry, summary_of(contact.ego, models[scenario.ego.model].mesh),
             summary_of(contact.other, mesh_of_actor(scenario, models, contact.actor)));
  return entry;
}

Json contact_json(const Scenario& scenario, View<const Model> models, const FurtherContact& contact,
                  bool simulated) {
  Json entry{
      {"bodies", {scenario.actors[contact.a].name, scenario.actors[contact.b].name}},
      {"time_of_impact_s", contact.time_s},
      {"closing_speed_mps", contact.closing_speed_mps},
      {"beyond_crash_model", contact.closing_speed_mps > fastest_contact_mps},
      {"closing_energy_j", contact.closing_energy_j},
      {"point_m", vector_json(contact.point_m)},
      {"region_m", both(region(contact.damage_a.region), region(contact.damage_b.region), a_b)}};
  entry["severity"] = severity_json(contact, simulated);
  add_damage(entry, summary_of(contact.damage_a, mesh_of_actor(scenario, models, contact.a)),
             summary_of(contact.damage_b, mesh_of_actor(scenario, models, contact.b)), a_b);
  return entry;
}

}  // namespace crashrank::detail

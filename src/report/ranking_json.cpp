#include "crashrank/report/ranking.hpp"
#include "report/damage_summary.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <utility>

namespace crashrank {
namespace {

using Json = nlohmann::ordered_json;
using detail::DamageSummary;

Json vector(const Eigen::Vector3d& v) { return Json::array({v.x(), v.y(), v.z()}); }

const char* origin_name(CandidateOrigin origin) {
  switch (origin) {
    case CandidateOrigin::listed:
      return "listed";
    case CandidateOrigin::added_braking:
      return "added-braking";
    case CandidateOrigin::grid:
      break;
  }
  return "grid";
}

const char* state_name(ImpactState state) {
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

/// {"ego": of one, "other": of the other}
template <class T> Json both(T ego, T other) {
  return {{"ego", std::move(ego)}, {"other", std::move(other)}};
}

void add_damage(Json& entry, const DamageSummary& ego, const DamageSummary& other) {
  entry["damaged_triangles"] = both(ego.triangles, other.triangles);
  entry["damaged_area_m2"] = both(ego.area_m2, other.area_m2);
  entry["damaged_parts"] = both(Json(ego.parts), Json(other.parts));
}

/// Corners of a region in body coordinates, null where the surfaces do not meet.
Json region(const Box& box) {
  if (box.empty()) return nullptr;
  return {{"min", vector(box.min.cast<double>())}, {"max", vector(box.max.cast<double>())}};
}

Json contact_json(const Scenario& scenario, View<const Model> models, const Contact& contact) {
  Json entry{{"other", scenario.actors[contact.actor].name},
             {"state", state_name(contact.state)},
             {"time_of_impact_s", contact.time_of_impact_s},
             {"closing_speed_mps", contact.closing_speed_mps},
             {"normal_speed_mps", contact.normal_speed_mps},
             {"closing_energy_j", contact.closing_energy_j},
             {"gap_m", contact.gap_m},
             {"point_m", vector(contact.point_m)},
             {"normal", vector(contact.normal)},
             {"crush_s", contact.crush_s},
             {"crush_m", contact.crush_m},
             {"region_m", both(region(contact.ego.region), region(contact.other.region))}};
  add_damage(
      entry, detail::summary_of(contact.ego, models[scenario.ego.model].mesh),
      detail::summary_of(contact.other, detail::mesh_of_actor(scenario, models, contact.actor)));
  return entry;
}

Json candidate_json(const Scenario& scenario, View<const Model> models, const RankResult& result,
                    std::size_t place) {
  const CandidateResult& ranked = result.ranking[place];
  const Candidate& candidate = result.candidates[ranked.candidate];
  Json contacts = Json::array();
  for (const Contact& contact : ranked.contacts) {
    contacts.push_back(contact_json(scenario, models, contact));
  }
  Json grazes = Json::array();
  for (const Graze& graze : ranked.grazes) {
    grazes.push_back({{"other", scenario.actors[graze.actor].name}, {"time_s", graze.time_s}});
  }
  Json entry{{"rank", place + 1},
             {"candidate", candidate.name},
             {"score", ranked.score ? Json(*ranked.score) : Json(nullptr)},
             {"score_interval",
              Json::array({ranked.score_interval.lowest, ranked.score_interval.highest})},
             {"collides", ranked.collides},
             {"contacts", std::move(contacts)},
             {"other", nullptr},
             {"time_of_impact_s", nullptr},
             {"closing_speed_mps", nullptr}};
  if (!ranked.contacts.empty()) {
    const Contact& first = ranked.contacts.front();
    entry["other"] = scenario.actors[first.actor].name;
    entry["time_of_impact_s"] = first.time_of_impact_s;
    entry["closing_speed_mps"] = first.closing_speed_mps;
  }
  add_damage(entry, detail::summary_of(ranked.ego, models[scenario.ego.model].mesh),
             detail::summary_of_others(scenario, models, ranked));
  entry["grazes"] = std::move(grazes);
  entry["origin"] = origin_name(candidate.origin);
  entry["acceleration_mps2"] = candidate.acceleration_mps2;
  entry["curvature_per_m"] = candidate.curvature_per_m;
  return entry;
}

Json body_json(const Scenario& scenario, const std::string& name, const RankedBody& body) {
  return {{"name", name},
          {"model", scenario.models[body.model].name},
          {"kind", body_kind_name(scenario.models[body.model].kind)},
          {"mass_kg", body.mass_kg},
          {"mass_guessed", body.mass_guessed}};
}

}  // namespace

std::string ranking_json(const Scenario& scenario, View<const Model> models,
                         const RankResult& result) {
  Json in_race = Json::array();
  for (const std::size_t candidate : result.in_race) {
    in_race.push_back(result.candidates[candidate].name);
  }
  Json ranking = Json::array();
  for (std::size_t place = 0; place < result.ranking.size(); ++place) {
    ranking.push_back(candidate_json(scenario, models, result, place));
  }
  Json actors = Json::array();
  for (std::size_t i = 0; i < result.actors.size(); ++i) {
    actors.push_back(body_json(scenario, scenario.actors[i].name, result.actors[i]));
  }
  const RankWork& work = result.work;
  const Json document{{"scenario", scenario.name},
                      {"measure", measure_name(result.measure)},
                      {"measure_unit", measure_unit(result.measure)},
                      {"complete", result.complete},
                      {"proved", result.proved},
                      {"in_race", std::move(in_race)},
                      {"elapsed_s", result.elapsed_s},
                      {"ego", body_json(scenario, "ego", result.ego)},
                      {"actors", std::move(actors)},
                      {"work",
                       {{"box_tests", work.box_tests},
                        {"body_pairs", work.body_pairs},
                        {"impact_bv_tests", work.impact.bv_tests},
                        {"impact_primitive_tests", work.impact.primitive_tests},
                        {"damage_queries", work.damage_queries}}},
                      {"ranking", std::move(ranking)}};
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace crashrank

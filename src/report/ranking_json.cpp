#include "crashrank/report/ranking.hpp"

#include "crashrank/scenario/candidate.hpp"
#include "report/contact_json.hpp"
#include "report/contact_order.hpp"
#include "report/damage_summary.hpp"
#include "report/future_words.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <utility>

namespace crashrank {
namespace {

using Json = nlohmann::ordered_json;
using detail::both;

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

/// Most names in `tied_with`.
constexpr std::size_t most_tied_names = 256;

Json name_json(const Scenario& scenario, const std::optional<std::size_t>& actor) {
  return actor ? Json(scenario.actors[*actor].name) : Json(nullptr);
}

Json optional_json(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json harm_json(const HarmOptions& harm) {
  const HarmWeights& w = harm.weights;
  const HarmRanges& r = harm.ranges;
  return {{"risk_model", risk_model_name(harm.model)},
          {"outcome", risk_outcome(harm.model)},
          {"friction", harm.friction},
          {"weights",
           {{"ego_occupant", w.ego_occupant},
            {"other_occupant", w.other_occupant},
            {"pedestrian", w.pedestrian},
            {"cyclist", w.cyclist},
            {"motorcyclist", w.motorcyclist},
            {"property_per_mj", w.property_per_mj},
            {"people_in_ego", w.people_in_ego},
            {"people_in_car", w.people_in_car},
            {"people_in_truck", w.people_in_truck},
            {"people_in_bus", w.people_in_bus}}},
          {"pedestrian",
           {{"age_years", optional_json(harm.pedestrian.age_years)},
            {"male_share", optional_json(harm.pedestrian.male_share)}}},
          {"ranges",
           {{"friction", Json::array({r.least_friction, r.most_friction})},
            {"strength", Json::array({r.least_strength, r.most_strength})},
            {"restitution", Json::array({r.least_restitution, r.most_restitution})},
            {"risk_speed", Json::array({r.least_risk_speed, r.most_risk_speed})},
            {"all_models", r.all_models}}},
          {"least_struck_share", harm.least_struck_share},
          {"after_contact", after_contact_name(harm.after_contact)}};
}

/// Names of the candidates that share a place, the first `most_tied_names` of them: every entry of
/// a tie lists all others, which grows with the square of their number.
Json tied_json(const RankResult& result, std::size_t index) {
  Json names = Json::array();
  for (const std::size_t candidate : tied_with(result, index)) {
    if (names.size() == most_tied_names) break;
    names.push_back(result.candidates[candidate].name);
  }
  return names;
}

/// What the futures lead to; those that do not differ for the candidate are one.
Json futures_json(const Scenario& scenario, const CandidateResult& ranked) {
  Json futures = Json::array();
  for (const FutureOutcome& outcome : ranked.futures) {
    Json entry{{"probability", outcome.probability},
               {"score", outcome.score},
               {"futures", outcome.futures},
               {"likeliest", outcome.is_likeliest},
               {"collides", outcome.collides},
               {"other", nullptr},
               {"state", nullptr},
               {"time_of_impact_s", nullptr},
               {"closing_speed_mps", nullptr},
               {"contacts", outcome.contacts},
               {"contact_without_force", outcome.contact_without_force},
               {"leaves_road", outcome.leaves_road}};
    if (outcome.collides) {
      entry["state"] = detail::impact_state_name(outcome.state);
      entry["other"] = scenario.actors[outcome.actor].name;
      entry["time_of_impact_s"] = outcome.time_of_impact_s;
      entry["closing_speed_mps"] = outcome.closing_speed_mps;
    }
    futures.push_back(std::move(entry));
  }
  return futures;
}

/// What people risk, without weights.
Json people_json(const Scenario& scenario, const CandidateResult& ranked) {
  Json people = Json::array();
  for (const PersonRisk& risk : ranked.people) {
    people.push_back({{"body", risk.body == ego_body ? "ego" : scenario.actors[risk.body].name},
                      {"persons", risk.persons},
                      {"probability", risk.probability},
                      {"exposure_mps", risk.exposure_mps},
                      {"exposure_pdof_deg", risk.exposure_pdof_deg},
                      {"exposure_time_s", risk.exposure_time_s}});
  }
  return people;
}

/// Simulated motions of the bodies that a contact force acted on.
Json motion_json(const Scenario& scenario, const CandidateResult& ranked) {
  constexpr double deg_per_rad = 57.29577951308232;
  const auto degrees = [](std::vector<double> angles) {
    for (double& angle : angles) angle *= deg_per_rad;
    return angles;
  };
  Json all = Json::array();
  for (const BodyMotion& motion : ranked.motion) {
    Json pressed = Json::array();
    for (const char one : motion.pressed) pressed.push_back(one != 0);
    all.push_back({{"body", motion.body == ego_body ? "ego" : scenario.actors[motion.body].name},
                   {"t_s", motion.t_s},
                   {"x_m", motion.x_m},
                   {"y_m", motion.y_m},
                   {"yaw_deg", degrees(motion.yaw_rad)},
                   {"vx_mps", motion.vx_mps},
                   {"vy_mps", motion.vy_mps},
                   {"yaw_rate_dps", degrees(motion.yaw_rate_radps)},
                   {"pressed", std::move(pressed)}});
  }
  return all;
}

Json demand_json(const ManoeuvreDemand& demand) {
  return {{"grip", demand.grip},
          {"engine", demand.engine},
          {"brakes", demand.brakes},
          {"steering", demand.steering},
          {"steering_rate", demand.steering_rate}};
}

Json plane_vector(const Eigen::Vector2d& v) { return Json::array({v.x(), v.y()}); }

Json leaving_json(const CandidateResult& ranked) {
  if (!ranked.leaves_road) return nullptr;
  const RoadLeaving& leaving = *ranked.leaves_road;
  return {{"time_s", leaving.time_s},
          {"speed_mps", leaving.speed_mps},
          {"point_m", plane_vector(leaving.point_m)}};
}

Json horizon_json(const CandidateResult& ranked) {
  if (!ranked.at_horizon) return nullptr;
  constexpr double deg_per_rad = 57.29577951308232;
  const HorizonState& state = *ranked.at_horizon;
  return {{"speed_mps", state.speed_mps},
          {"heading_deg", deg_per_rad * state.heading_rad},
          {"position_m", plane_vector(state.position_m)}};
}

Json candidate_json(const Scenario& scenario, View<const Model> models, const RankResult& result,
                    std::size_t place) {
  const CandidateResult& ranked = result.ranking[place];
  const Candidate& candidate = result.candidates[ranked.candidate];
  const bool sampled = !needs_crash(result.measure) || !result.samples.empty();
  const bool searched = ranked.score || ranked.searched;
  const bool tells_feasible =
      ranked.score || (ranked.searched && result.infeasible != Infeasible::keep);
  Json contacts = Json::array();
  for (const detail::AnyContact& contact : detail::contacts_in_order(ranked)) {
    contacts.push_back(contact.own != nullptr
                           ? detail::contact_json(scenario, models, *contact.own)
                           : detail::contact_json(scenario, models, *contact.further,
                                                  needs_crash(result.measure)));
  }
  Json grazes = Json::array();
  for (const Graze& graze : ranked.grazes) {
    grazes.push_back({{"other", scenario.actors[graze.actor].name}, {"time_s", graze.time_s}});
  }
  Json entry{
      {"rank", ranked.place},
      {"candidate", candidate.name},
      {"tied_with", tied_json(result, place)},
      {"feasible", tells_feasible || !ranked.feasible ? Json(ranked.feasible) : Json(nullptr)},
      {"grip_demand", ranked.score ? Json(ranked.demand.grip) : Json(nullptr)},
      {"demand", ranked.score ? demand_json(ranked.demand) : Json(nullptr)},
      {"leaves_road", leaving_json(ranked)},
      {"least_distance_m", optional_json(ranked.least_distance_m)},
      {"nearest", name_json(scenario, ranked.nearest)},
      {"least_time_gap_s", optional_json(ranked.least_time_gap_s)},
      {"soonest", name_json(scenario, ranked.soonest)},
      {"time_to_collision_s", optional_json(ranked.time_to_collision_s)},
      {"imminent", name_json(scenario, ranked.imminent)},
      {"at_horizon", horizon_json(ranked)},
      {"score", ranked.score ? Json(*ranked.score) : Json(nullptr)},
      {"score_interval",
       Json::array({ranked.score_interval.lowest, ranked.score_interval.highest})},
      {"score_estimate", optional_json(ranked.score_estimate)},
      {"numerical_interval",
       result.samples.empty()
           ? Json(nullptr)
           : Json::array({ranked.numerical_interval.lowest, ranked.numerical_interval.highest})},
      {"places", Json::array({ranked.best_place + 1, ranked.worst_place + 1})},
      {"separable_from_next", sampled ? Json(ranked.separable) : Json(nullptr)},
      {"overtaken_share", sampled ? Json(ranked.overtaken) : Json(nullptr)},
      {"collision_probability", searched ? Json(ranked.collision_probability) : Json(nullptr)},
      {"people", people_json(scenario, ranked)},
      {"futures", futures_json(scenario, ranked)},
      {"sampling_error", optional_json(ranked.sampling_error)},
      {"sampling_error_to_next", optional_json(ranked.sampling_error_to_next)},
      {"collides", searched || ranked.collides ? Json(ranked.collides) : Json(nullptr)},
      {"contacts", std::move(contacts)},
      {"crowded", ranked.crowded},
      {"other", nullptr},
      {"time_of_impact_s", nullptr},
      {"closing_speed_mps", nullptr},
      {"delta_v_mps", nullptr},
      {"pdof_deg", nullptr}};
  if (ranked.first_touch) {
    entry["other"] = scenario.actors[ranked.first_touch->actor].name;
    entry["time_of_impact_s"] = ranked.first_touch->time_of_impact_s;
    entry["closing_speed_mps"] = ranked.first_touch->closing_speed_mps;
  }
  if (!ranked.contacts.empty()) {
    const Contact& first = ranked.contacts.front();
    entry["other"] = scenario.actors[first.actor].name;
    entry["time_of_impact_s"] = first.time_of_impact_s;
    entry["closing_speed_mps"] = first.closing_speed_mps;
    const ContactSeverity& crash = first.severity;
    entry["delta_v_mps"] = both(crash.ego.delta_v_mps, crash.other.delta_v_mps);
    entry["pdof_deg"] = both(crash.ego.pdof_deg, crash.other.pdof_deg);
  }
  if (ranked.score && !ranked.first_touch) {
    detail::add_damage(entry, detail::summary_of(ranked.ego, models[scenario.ego.model].mesh),
                       detail::summary_of_others(scenario, models, ranked));
  } else {
    for (const char* key : {"damaged_triangles", "damaged_area_m2", "damaged_parts"}) {
      entry[key] = nullptr;
    }
  }
  entry["grazes"] = std::move(grazes);
  if (result.has_motion) entry["motion"] = motion_json(scenario, ranked);
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
          {"mass_guessed", body.mass_guessed},
          {"has_outline", body.has_outline}};
}

Json effort_json(const RankerEffort& effort) {
  return {{"work", effort.work},
          {"without_search", effort.without_search},
          {"without_crash", effort.without_crash},
          {"fully_evaluated", effort.fully_evaluated},
          {"left_early", effort.left_early},
          {"prepare_s", effort.prepare_s},
          {"bounds_s", effort.bounds_s},
          {"refining_s", effort.refining_s}};
}

}  // namespace

std::string ranking_json(const Scenario& asked, View<const Model> models, const RankResult& result,
                         View<const std::string> warnings) {
  const Scenario made = is_uncertain(asked) ? likeliest_future(asked) : Scenario{};
  const Scenario& scenario = is_uncertain(asked) ? made : asked;
  Json all_warnings = Json::array();
  for (const std::string& warning : warnings) all_warnings.push_back(warning);
  for (std::string& doubt : ranking_doubts(scenario, models, result)) {
    all_warnings.push_back(std::move(doubt));
  }
  Json dropped = Json::array();
  for (const std::size_t candidate : result.dropped) {
    dropped.push_back(result.candidates[candidate].name);
  }
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
  Json not_separable = Json::array();
  const bool sampled = !needs_crash(result.measure) || !result.samples.empty();
  for (std::size_t i = 0; sampled && i + 1 < result.ranking.size(); ++i) {
    const CandidateResult& ranked = result.ranking[i];
    const CandidateResult& next = result.ranking[i + 1];
    if (ranked.separable || ranked.place == next.place) continue;
    not_separable.push_back({{"ranks", Json::array({ranked.place, next.place})},
                             {"overtaken_share", ranked.overtaken},
                             {"within_numerical_error", ranked.within_numerical_error},
                             {"within_sampling_error", ranked.within_sampling_error}});
  }
  Json first;
  for (const RankOrder order : {RankOrder::score, RankOrder::upper}) {
    Json& name = first[order_name(order)];
    if (result.ranking.empty()) continue;
    name = result.candidates[result.ranking[first_by(result, order)].candidate].name;
  }
  Json& exact = first["without_errors"];
  if (const auto row = first_without_errors(result)) {
    exact = result.candidates[result.ranking[*row].candidate].name;
  }
  const RankWork& work = result.work;
  Json document{{"scenario", scenario.name},
                {"measure", measure_name(result.measure)},
                {"measure_unit", measure_unit(result.measure)},
                {"harm", needs_crash(result.measure) ? harm_json(result.harm) : nullptr},
                {"stability",
                 {{"samples", range_sample_count(result)},
                  {"numerical_samples", result.samples.size() - range_sample_count(result)},
                  {"not_separable_above_share", separable_share},
                  {"not_separable", std::move(not_separable)}}},
                {"futures",
                 {{"method", detail::future_method_name(result.futures.method)},
                  {"evaluated", result.futures.futures},
                  {"sampled", result.futures.sampled},
                  {"undrawn", result.futures.undrawn},
                  {"combinations", result.futures.combinations},
                  {"left_out", result.futures.left_out},
                  {"smooth", result.futures.smooth},
                  {"risk", risk_name(result.futures.risk)}}},
                {"infeasible", infeasible_name(result.infeasible)},
                {"order", order_name(result.order)},
                {"first_by", std::move(first)},
                {"dropped", std::move(dropped)},
                {"complete", result.complete},
                {"proved", result.proved},
                {"basis", basis_name(result.basis)},
                {"in_race", std::move(in_race)},
                {"elapsed_s", result.elapsed_s},
                {"warnings", std::move(all_warnings)},
                {"ego", body_json(scenario, "ego", result.ego)},
                {"actors", std::move(actors)},
                {"work",
                 {{"box_tests", work.box_tests},
                  {"body_pairs", work.body_pairs},
                  {"impact_bv_tests", work.impact.bv_tests},
                  {"impact_primitive_tests", work.impact.primitive_tests},
                  {"damage_queries", work.damage_queries},
                  {"crash_steps", work.crash_steps},
                  {"crash_pieces", work.crash_pieces}}},
                {"ranking", std::move(ranking)}};
  if (result.effort) document["effort"] = effort_json(*result.effort);
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace crashrank

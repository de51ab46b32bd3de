#include "scenario/scenario_parse.hpp"
#include "crashrank/internal/base/guarded.hpp"
#include "crashrank/scenario/scenario.hpp"
#include "scenario/json_object.hpp"
#include "scenario/json_text.hpp"
#include "scenario/key_ranges.hpp"
#include "scenario/read_actors.hpp"
#include "scenario/read_harm.hpp"
#include "scenario/read_road.hpp"
#include "scenario/scenario_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using detail::JsonObject;
using detail::NumberRange;
using detail::Refusals;
using namespace detail::ranges;
using nlohmann::json;

BodyKind read_kind(const JsonObject& object) {
  constexpr std::array<BodyKind, 9> kinds{
      BodyKind::car,        BodyKind::truck,   BodyKind::bus,
      BodyKind::motorcycle, BodyKind::bicycle, BodyKind::pedestrian,
      BodyKind::barrier,    BodyKind::pole,    BodyKind::building};
  const std::string text = object.text("kind", limits::name_characters);
  std::string known;
  for (const BodyKind kind : kinds) {
    if (text == body_kind_name(kind)) return kind;
    known += (known.empty() ? "" : ", ") + std::string(body_kind_name(kind));
  }
  object.refuse("kind", object.has("kind") ? "'" + text + "' is not a kind of body" : "is missing",
                "choose one of " + known);
  return BodyKind::car;
}

Axis read_axis(const JsonObject& object, const char* key, Axis otherwise) {
  constexpr std::array<std::pair<const char*, Axis>, 6> axes{{{"+x", Axis::plus_x},
                                                              {"-x", Axis::minus_x},
                                                              {"+y", Axis::plus_y},
                                                              {"-y", Axis::minus_y},
                                                              {"+z", Axis::plus_z},
                                                              {"-z", Axis::minus_z}}};
  if (!object.has(key)) return otherwise;
  const std::string text = object.text(key, limits::name_characters);
  for (const auto& [name, axis] : axes) {
    if (text == name) return axis;
  }
  object.refuse(key, "'" + text + "' is not an axis", "choose one of +x, -x, +y, -y, +z, -z");
  return otherwise;
}

bool same_line(Axis a, Axis b) { return static_cast<int>(a) / 2 == static_cast<int>(b) / 2; }

std::optional<Eigen::Vector3d> read_point(const JsonObject& object, const char* key,
                                          NumberRange range = position) {
  const json* array = object.array(key, 3, 3);
  if (array == nullptr) return std::nullopt;
  Eigen::Vector3d point;
  for (std::size_t i = 0; i < 3; ++i) {
    point[static_cast<Eigen::Index>(i)] = detail::checked_number(
        (*array)[i], object.path_of(indexed(key, i).c_str()), range, object.refusals(), 0.0);
  }
  return point;
}

std::optional<Surface> read_surface(const JsonObject& object) {
  if (!object.has("surface")) return std::nullopt;
  const Result<Surface> surface =
      surface_from_name(object.text("surface", limits::name_characters));
  if (surface) return *surface;
  object.refuse("surface", surface.error().reason, surface.error().remedy);
  return std::nullopt;
}

std::optional<Honeycomb> read_honeycomb(const JsonObject& parent) {
  if (!parent.has("honeycomb")) return std::nullopt;
  const JsonObject object(parent.at("honeycomb"), parent.path_of("honeycomb"), parent.refusals(),
                          {"pressure_pa", "depth_m", "low_m", "high_m"});
  for (const char* const key : {"pressure_pa", "depth_m", "high_m"}) object.require(key);
  Honeycomb honeycomb;
  honeycomb.pressure_pa = object.number("pressure_pa", honeycomb_pressure, 1.0);
  honeycomb.depth_m = object.number("depth_m", honeycomb_size, 1.0);
  honeycomb.low_m = object.number("low_m", honeycomb_low, 0.0);
  honeycomb.high_m = object.number("high_m", honeycomb_size, limits::honeycomb_m);
  if (!(honeycomb.low_m < honeycomb.high_m)) {
    object.refuse("low_m", "is not below high_m", "give the lower end");
  }
  return honeycomb;
}

std::optional<Breakaway> read_breakaway(const JsonObject& parent) {
  if (!parent.has("breakaway")) return std::nullopt;
  const JsonObject object(parent.at("breakaway"), parent.path_of("breakaway"), parent.refusals(),
                          {"force_n", "moment_nm"});
  if (!object.has("force_n") && !object.has("moment_nm")) {
    object.refuse("force_n", "is missing", "give force_n or moment_nm");
  }
  Breakaway foot;
  foot.force_n = object.number("force_n", breakaway, foot.force_n);
  foot.moment_nm = object.number("moment_nm", breakaway, foot.moment_nm);
  return foot;
}

/// A mesh, or length, width and height of the body's box in its place.
void read_shape(const JsonObject& object, ScenarioModel& model) {
  if (!object.has("box")) {
    if (!object.has("mesh")) {
      object.refuse("mesh", "is missing",
                    "name a mesh file, or give box: [length, width, height] in m");
    }
    model.mesh = object.name("mesh", limits::path_characters);
    return;
  }
  for (const char* const key : {"mesh", "scale", "up", "forward"}) {
    if (object.has(key)) {
      object.refuse(key, "is given together with box",
                    "keep one of them; a box is in metres, x forward, z up");
    }
  }
  model.box_m = read_point(object, "box", box_side);
}

ScenarioModel read_model(const json& value, const std::string& name, const std::string& path,
                         Refusals& refusals) {
  const JsonObject object(value, path, refusals,
                          {"mesh", "box", "kind", "mass_kg", "scale", "up", "forward", "origin_m",
                           "center_of_mass_m", "yaw_inertia_kgm2", "stiffness", "surface",
                           "honeycomb", "breakaway", "deflection_m", "deflection_force_n", "note"});
  ScenarioModel model;
  model.name = name;
  read_shape(object, model);
  model.kind = read_kind(object);
  if (object.has("mass_kg") && !object.at("mass_kg").is_null()) {
    model.mass_kg = object.optional_number("mass_kg", mass);
  }
  model.transform.scale = object.number("scale", scale, 1.0);
  model.transform.up = read_axis(object, "up", Axis::plus_z);
  model.transform.forward = read_axis(object, "forward", Axis::plus_x);
  if (same_line(model.transform.up, model.transform.forward)) {
    object.refuse("forward", "lies along the same line as up", "give two different axes");
  }
  if (const auto origin = read_point(object, "origin_m")) model.transform.origin_m = *origin;
  model.center_of_mass_m = read_point(object, "center_of_mass_m");
  model.yaw_inertia_kgm2 = object.optional_number("yaw_inertia_kgm2", yaw_inertia);
  model.stiffness = object.number("stiffness", stiffness, 1.0);
  model.surface = read_surface(object);
  model.honeycomb = read_honeycomb(object);
  model.breakaway = read_breakaway(object);
  model.deflection_m = object.number("deflection_m", deflection, 0.0);
  model.deflection_force_n = object.optional_number("deflection_force_n", breakaway);
  if (model.deflection_force_n && !object.has("deflection_m")) {
    object.refuse("deflection_force_n", "is given without deflection_m", "give both");
  }
  return model;
}

ScenarioEgo read_ego(const JsonObject& root, const std::vector<ScenarioModel>& models) {
  const JsonObject object(root.at("ego"), "ego", root.refusals(),
                          {"model", "pose", "speed_mps", "yaw_rate_dps", "wheelbase_m",
                           "max_acceleration_mps2", "max_deceleration_mps2", "max_steering_deg",
                           "max_steering_rate_dps", "occupants", "uncertainty", "note"});
  detail::require_version_2(root, object,
                            {"max_deceleration_mps2", "max_steering_rate_dps", "uncertainty"});
  ScenarioEgo ego;
  ego.model = detail::read_model_name(object, models);
  ego.pose = detail::read_pose(object);
  object.require("speed_mps");
  ego.speed_mps = object.number("speed_mps", speed, 0.0);
  ego.yaw_rate_radps = rad_per_deg * object.number("yaw_rate_dps", yaw_rate, 0.0);
  ego.wheelbase_m = object.optional_number("wheelbase_m", wheelbase);
  ego.max_acceleration_mps2 =
      object.number("max_acceleration_mps2", max_acceleration, ego.max_acceleration_mps2);
  ego.max_deceleration_mps2 = object.optional_number("max_deceleration_mps2", max_deceleration);
  ego.max_steering_rate_radps =
      rad_per_deg * object.number("max_steering_rate_dps", max_steering_rate,
                                  ego.max_steering_rate_radps / rad_per_deg);
  ego.max_steering_rad = rad_per_deg * object.number("max_steering_deg", max_steering, 35.0);
  ego.occupants = object.optional_number("occupants", occupants);
  ego.uncertainty = detail::read_uncertainty(object, "uncertainty");
  return ego;
}

ListedCandidate read_candidate(const json& value, const std::string& path, Refusals& refusals) {
  const JsonObject object(value, path, refusals,
                          {"name", "acceleration_mps2", "steering_deg", "yaw_rate_dps", "poses"});
  ListedCandidate candidate;
  object.require("name");
  candidate.name = object.name("name", limits::name_characters);
  candidate.poses = detail::read_poses(object);
  candidate.acceleration_mps2 = object.number("acceleration_mps2", acceleration, 0.0);
  if (const auto degrees = object.optional_number("steering_deg", steering)) {
    candidate.steering_rad = rad_per_deg * *degrees;
  }
  if (const auto rate = object.optional_number("yaw_rate_dps", yaw_rate)) {
    candidate.yaw_rate_radps = rad_per_deg * *rate;
  }
  if (object.has("poses")) {
    for (const char* key : {"acceleration_mps2", "steering_deg", "yaw_rate_dps"}) {
      if (object.has(key)) object.refuse(key, "is given together with poses", "keep one of them");
    }
  } else if (object.has("steering_deg") && object.has("yaw_rate_dps")) {
    object.refuse("yaw_rate_dps", "is given together with steering_deg", "keep one of them");
  }
  return candidate;
}

void read_candidates(const JsonObject& root, detail::ParsedScenario& parsed) {
  Scenario& scenario = parsed.scenario;
  if (!root.has("candidates")) return;
  Refusals& refusals = root.refusals();
  const JsonObject object(root.at("candidates"), "candidates", refusals,
                          {"listed", "table", "grid", "add_straight_braking", "note"});
  if (const json* listed = object.array("listed", 0, limits::listed_candidates)) {
    for (std::size_t i = 0; i < listed->size() && refusals.goes_on(); ++i) {
      const std::string path = object.path_of(indexed("listed", i).c_str());
      scenario.listed.push_back(read_candidate((*listed)[i], path, refusals));
    }
  }
  if (object.has("table")) {
    detail::require_version_2(root, object, {"table"});
    parsed.candidate_table = object.name("table", limits::path_characters);
  }
  if (!scenario.listed.empty() || object.has("table")) scenario.grid.reset();
  if (object.has("grid") && object.at("grid").is_boolean()) {
    scenario.grid = object.flag("grid", true) ? std::optional(CandidateGrid{}) : std::nullopt;
  } else if (object.has("grid")) {
    const JsonObject grid(object.at("grid"), object.path_of("grid"), refusals,
                          {"accelerations", "steerings"});
    scenario.grid = CandidateGrid{grid.count("accelerations", grid_side, 15),
                                  grid.count("steerings", grid_side, 15)};
  }
  scenario.add_straight_braking = object.flag("add_straight_braking", true);
}

void read_models(const JsonObject& root, Scenario& scenario) {
  root.require("models");
  if (!root.has("models")) return;
  const json& models = root.at("models");
  if (!models.is_object() || models.empty() || models.size() > limits::models) {
    detail::refuse_at(
        root.refusals(), "models", "is not an object of 1 to 256 models",
        "write it as {\"name\": {...}}",
        models.is_object() && !models.empty() ? ErrorCode::limit_exceeded : ErrorCode::bad_input);
    return;
  }
  for (const auto& [name, value] : models.items()) {
    const std::string path = "models." + name;
    detail::check_name(name, "models", limits::name_characters, root.refusals());
    if (!root.refusals().goes_on()) return;
    scenario.models.push_back(read_model(value, name, path, root.refusals()));
  }
}

/// Keys of earlier crash models: accepted, so that files which have them stay valid.
std::vector<std::string> find_keys_without_effect(const json& document) {
  std::vector<std::string> keys;
  for (const char* const pointer : {"/crush", "/harm/after_impact"}) {
    if (!document.contains(json::json_pointer(pointer))) continue;
    std::string key(pointer + 1);
    std::replace(key.begin(), key.end(), '/', '.');
    keys.push_back(std::move(key));
  }
  return keys;
}

detail::ParsedScenario read_scenario(const json& document, Refusals& refusals) {
  detail::ParsedScenario parsed;
  Scenario& scenario = parsed.scenario;
  const JsonObject root(document, {}, refusals,
                        {"$schema", "scenario_version", "name", "description", "models", "ego",
                         "candidates", "actors", "horizon_s", "crush", "measure", "harm", "grip",
                         "futures", "risk", "road", "note"});
  root.require("scenario_version");
  root.text("$schema", limits::path_characters);
  if (root.has("scenario_version") && root.at("scenario_version") != 1 &&
      root.at("scenario_version") != 2) {
    root.refuse("scenario_version", "is not a version this program reads",
                "it reads versions 1 and 2");
  }
  scenario.name = root.name("name", limits::name_characters);
  scenario.description = root.text("description", limits::description_characters);
  read_models(root, scenario);
  root.require("ego");
  if (!refusals.goes_on()) return parsed;
  if (root.has("ego")) scenario.ego = read_ego(root, scenario.models);
  read_candidates(root, parsed);
  detail::read_actors(root, scenario);
  detail::read_futures(root, scenario);
  detail::require_version_2(root, root, {"road"});
  scenario.road = detail::read_road(root);
  scenario.horizon_s = root.number("horizon_s", horizon, 4.0);
  if (root.has("measure")) {
    const Result<Measure> measure =
        measure_from_name(root.text("measure", limits::name_characters));
    if (measure) {
      scenario.measure = *measure;
    } else {
      root.refuse("measure", measure.error().reason, measure.error().remedy);
    }
  }
  if (root.has("harm")) {
    const JsonObject harm(root.at("harm"), "harm", refusals,
                          {"risk_model", "weights", "people", "pedestrian", "friction", "ranges",
                           "after_contact", "after_impact", "least_struck_share"});
    detail::read_harm(harm, scenario.harm);
  }
  scenario.grip = root.number("grip", grip, 0.8);
  if (refusals.ok()) scenario.keys_without_effect = find_keys_without_effect(document);
  return parsed;
}

/// Divides probabilities that are rounded by their sum.
template <class Weighted>
void normalise(std::vector<Weighted>& weighted, const std::string& path, Scenario& scenario) {
  double sum = 0.0;
  for (const Weighted& each : weighted) sum += each.probability;
  const double off = std::abs(sum - 1.0);
  // A sum of 0.99 is written to two digits and stored with an error.
  constexpr double stored = 1e-9;
  if (off <= scenario_limits::probability_sum ||
      off > scenario_limits::written_probability_sum + stored)
    return;
  for (Weighted& each : weighted) each.probability /= sum;
  scenario.normalised.push_back(path);
}

void normalise(Scenario& scenario) {
  for (std::size_t i = 0; i < scenario.actors.size(); ++i) {
    normalise(scenario.actors[i].predictions, indexed("actors", i) + ".predictions", scenario);
  }
  normalise(scenario.futures, "futures", scenario);
}

detail::ParsedScenario parse(const std::string& text, const std::string& file, Refusals& refusals) {
  if (text.size() > limits::file_bytes) {
    refusals.add(
        {ErrorCode::limit_exceeded, {}, {}, "is larger than 16 MiB", "split the scenario"});
    return {};
  }
  Result<json> document = detail::parse_json(text);
  if (!document) {
    refusals.add(document.error());
    return {};
  }
  detail::ParsedScenario parsed = read_scenario(*document, refusals);
  Scenario& scenario = parsed.scenario;
  if (refusals.goes_on()) normalise(scenario);
  if (refusals.goes_on()) detail::check_names(scenario, refusals);
  if (refusals.goes_on()) detail::check_probabilities(scenario, refusals);
  if (refusals.goes_on()) detail::check_road(scenario.road, refusals);
  if (scenario.name.empty()) scenario.name = std::filesystem::path(file).stem().string();
  return parsed;
}

Result<Scenario> parse_alone(const std::string& text, const std::string& file) {
  Result<detail::ParsedScenario> parsed = detail::parse_scenario_text(text, file);
  if (!parsed) return parsed.error();
  if (!parsed->candidate_table.empty()) {
    return detail::error_in_file(file, {ErrorCode::bad_input,
                                        {},
                                        "candidates.table",
                                        "names a file, and text alone is read",
                                        "load the scenario from its file, or list the candidates"});
  }
  return std::move(parsed->scenario);
}

}  // namespace

Result<Scenario> parse_scenario(const std::string& text, const std::string& file) {
  return detail::guarded([&] { return parse_alone(text, file); });
}

Result<detail::ParsedScenario> detail::parse_scenario_text(const std::string& text,
                                                           const std::string& file) {
  Refusals refusals;
  ParsedScenario parsed = parse(text, file, refusals);
  if (!refusals.ok()) return error_in_file(file, refusals.errors().front());
  return parsed;
}

detail::ParsedScenario detail::parse_scenario_text(const std::string& text, const std::string& file,
                                                   Refusals& refusals) {
  return parse(text, file, refusals);
}

}  // namespace crashrank

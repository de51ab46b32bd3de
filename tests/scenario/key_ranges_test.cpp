#include "scenario/key_ranges.hpp"
#include "scenario/scenario_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

// The ranges of scenario fields, the published schema, the parser and the check
// of scenarios made by programs, held against each other: the schema by reading
// it, the others by what they accept.

namespace crashrank {
namespace {

using detail::NumberRange;
using nlohmann::json;

json load(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  EXPECT_TRUE(in) << path;
  return json::parse(in);
}

json schema() { return load(CRASHRANK_SCHEMA); }

// Every numeric field of the format once, each within its range.
json full_document() { return load(CRASHRANK_SCENARIO_DATA "/all_numbers.json"); }

bool states_a_number(const json& node) {
  if (!node.is_object() || !node.contains("type")) return false;
  const json& type = node.at("type");
  const auto is_number = [](const json& t) { return t == "number" || t == "integer"; };
  return type.is_array() ? std::any_of(type.begin(), type.end(), is_number) : is_number(type);
}

void for_each_node(const json& node, const std::string& pointer,
                   const std::function<void(const json&, const std::string&)>& use) {
  use(node, pointer);
  if (node.is_object()) {
    for (const auto& [key, value] : node.items()) for_each_node(value, pointer + "/" + key, use);
  } else if (node.is_array()) {
    for (std::size_t i = 0; i < node.size(); ++i) {
      for_each_node(node[i], pointer + "/" + std::to_string(i), use);
    }
  }
}

NumberRange range_in_schema(const json& node) {
  const bool above = node.contains("exclusiveMinimum");
  return {node.at(above ? "exclusiveMinimum" : "minimum").get<double>(),
          node.at("maximum").get<double>(), above};
}

TEST(KeyRanges, TheSchemaStatesEveryRangeOnce) {
  const json whole = schema();
  std::set<std::string> rows;
  for (const detail::ranges::Field& field : detail::ranges::fields) {
    EXPECT_TRUE(rows.insert(field.schema).second) << field.schema << " has two rows";
    const json::json_pointer pointer(field.schema);
    ASSERT_TRUE(whole.contains(pointer)) << field.schema;
    const NumberRange stated = range_in_schema(whole.at(pointer));
    EXPECT_EQ(stated.lowest, field.range.lowest) << field.schema;
    EXPECT_EQ(stated.highest, field.range.highest) << field.schema;
    EXPECT_EQ(stated.above, field.range.above) << field.schema;
  }
  for_each_node(whole, "", [&](const json& node, const std::string& pointer) {
    if (!states_a_number(node)) return;
    EXPECT_EQ(rows.count(pointer), 1U) << pointer << " has no row";
  });
}

TEST(KeyRanges, TheSchemaStatesEverySizeOnce) {
  const json whole = schema();
  std::set<std::string> rows;
  for (const detail::ranges::Size& size : detail::ranges::sizes) {
    const std::string place = std::string(size.schema) + "/" + size.keyword;
    EXPECT_TRUE(rows.insert(place).second) << place << " has two rows";
    const json::json_pointer pointer(place);
    ASSERT_TRUE(whole.contains(pointer)) << place;
    EXPECT_EQ(whole.at(pointer), size.most) << place;
  }
  constexpr int few = 3;  // points, corners and pairs
  for_each_node(whole, "", [&](const json& node, const std::string& pointer) {
    for (const char* const keyword : {"maxItems", "maxProperties", "maxLength"}) {
      if (!node.is_object() || !node.contains(keyword) || node.at(keyword) <= few) continue;
      EXPECT_EQ(rows.count(pointer + "/" + keyword), 1U) << pointer << " has no row";
    }
  });
}

// The schema of a place of a document: references followed, of alternatives the
// one that has the key.
class SchemaWalk {
public:
  explicit SchemaWalk(const json& whole) : whole_(whole) {}

  // Null where the schema does not describe the place.
  const json* member(const json& node, const std::string& key) const {
    const json& here = resolved(node);
    if (here.contains("oneOf")) {
      for (const json& each : here.at("oneOf")) {
        if (const json* found = member(each, key)) return found;
      }
    }
    if (here.contains("properties") && here.at("properties").contains(key) &&
        here.at("properties").at(key).is_object()) {
      return &resolved(here.at("properties").at(key));
    }
    if (here.contains("additionalProperties") && here.at("additionalProperties").is_object()) {
      return &resolved(here.at("additionalProperties"));
    }
    return nullptr;
  }

  const json* element(const json& node) const {
    const json& here = resolved(node);
    return here.contains("items") ? &resolved(here.at("items")) : nullptr;
  }

private:
  const json& resolved(const json& node) const {
    if (!node.is_object() || !node.contains("$ref")) return node;
    return resolved(whole_.at(json::json_pointer(node.at("$ref").get<std::string>().substr(1))));
  }

  const json& whole_;
};

struct NumberAt {
  json::json_pointer place;  // in the document
  NumberRange range;         // as the schema states it
  bool whole = false;        // an integer
};

void collect(const SchemaWalk& walk, const json& node, const json& value,
             const json::json_pointer& place, std::vector<NumberAt>& numbers) {
  if (value.is_object()) {
    for (const auto& [key, member] : value.items()) {
      const json* const below = walk.member(node, key);
      ASSERT_NE(below, nullptr) << (place / key).to_string();
      collect(walk, *below, member, place / key, numbers);
    }
  } else if (value.is_array()) {
    const json* const below = walk.element(node);
    ASSERT_NE(below, nullptr) << place.to_string();
    for (std::size_t i = 0; i < value.size(); ++i) {
      collect(walk, *below, value[i], place / i, numbers);
    }
  } else if (value.is_number() && place.to_string() != "/scenario_version") {
    ASSERT_TRUE(states_a_number(node)) << place.to_string();
    numbers.push_back({place, range_in_schema(node), node.at("type") == "integer"});
  }
}

std::vector<NumberAt> numbers_of(const json& document) {
  const json whole = schema();
  std::vector<NumberAt> numbers;
  collect(SchemaWalk(whole), whole, document, json::json_pointer(), numbers);
  return numbers;
}

// "/models/car/origin_m/1" as errors name it: "models.car.origin_m[1]".
std::string key_path(const json::json_pointer& place) {
  std::string path;
  std::istringstream steps(place.to_string().substr(1));
  for (std::string step; std::getline(steps, step, '/');) {
    const bool index = step.find_first_not_of("0123456789") == std::string::npos;
    path += index ? "[" + step + "]" : (path.empty() ? "" : ".") + step;
  }
  return path;
}

double just_below(const NumberAt& number) {
  const double lowest = number.range.lowest;
  if (number.range.above) return lowest;
  return number.whole ? lowest - 1.0 : lowest - 1e-9 * std::max(1.0, std::abs(lowest));
}

double just_above(const NumberAt& number) {
  const double highest = number.range.highest;
  return number.whole ? highest + 1.0 : highest + 1e-9 * std::max(1.0, std::abs(highest));
}

double lowest_inside(const NumberAt& number) {
  return number.range.above ? std::numeric_limits<double>::min() : number.range.lowest;
}

// The error of the document with this number at that place, or none.
Error parsed_with(json document, const NumberAt& number, double value) {
  document.at(number.place) = value;
  const Result<Scenario> scenario = parse_scenario(document.dump(), "f");
  return scenario ? Error{} : scenario.error();
}

TEST(KeyRanges, TheParserRefusesWhatTheSchemaRefuses) {
  const json document = full_document();
  ASSERT_TRUE(parse_scenario(document.dump(), "f").ok())
      << parse_scenario(document.dump(), "f").error().message();
  const std::vector<NumberAt> numbers = numbers_of(document);
  EXPECT_GT(numbers.size(), 90U);
  for (const NumberAt& number : numbers) {
    const std::string path = key_path(number.place);
    for (const double outside : {just_below(number), just_above(number)}) {
      const Error error = parsed_with(document, number, outside);
      EXPECT_EQ(error.place, path) << outside;
      EXPECT_NE(error.reason.find("out of range"), std::string::npos) << path << ": " << outside;
    }
    // Other rules may refuse an end of the range, as times that have to rise;
    // the range does not.
    for (const double inside : {lowest_inside(number), number.range.highest}) {
      const Error error = parsed_with(document, number, inside);
      EXPECT_EQ(error.reason.find("out of range"), std::string::npos)
          << path << ": " << inside << ": " << error.message();
    }
  }
}

// Every field of the schema's table is a number of the document, so that no row
// goes unchecked.
TEST(KeyRanges, TheDocumentHasEveryFieldOfTheTable) {
  const json document = full_document();
  json whole = schema();
  // Marks every stated range by a highest number of its own.
  double mark = 1.0;
  std::map<double, std::string> pointer_of;
  for (const detail::ranges::Field& field : detail::ranges::fields) {
    whole.at(json::json_pointer(field.schema))["maximum"] = mark;
    pointer_of[mark] = field.schema;
    mark += 1.0;
  }
  std::vector<NumberAt> numbers;
  collect(SchemaWalk(whole), whole, document, json::json_pointer(), numbers);
  for (const NumberAt& number : numbers) pointer_of.erase(number.range.highest);
  for (const auto& [key, pointer] : pointer_of)
    ADD_FAILURE() << pointer << " is not in the document";
}

// Where a program's scenario stores a number of the document, and what a unit
// of the file is there.
struct Stored {
  double* number = nullptr;
  double unit = 1.0;
};

constexpr double rad = detail::ranges::rad_per_deg;

std::map<std::string, Stored> stored_motion(const std::string& path, ActorMotion& motion) {
  if (!motion.poses.empty()) {
    std::map<std::string, Stored> stored;
    for (std::size_t i = 0; i < motion.poses.size(); ++i) {
      const std::string at = path + "poses[" + std::to_string(i) + "].";
      TimedPose& pose = motion.poses[i];
      stored[at + "t_s"] = {&pose.time_s};
      stored[at + "x_m"] = {&pose.pose.translation.x()};
      stored[at + "y_m"] = {&pose.pose.translation.y()};
      stored[at + "z_m"] = {&pose.pose.translation.z()};
    }
    return stored;
  }
  return {{path + "pose.x_m", {&motion.pose.translation.x()}},
          {path + "pose.y_m", {&motion.pose.translation.y()}},
          {path + "pose.z_m", {&motion.pose.translation.z()}},
          {path + "speed_mps", {&motion.speed_mps}},
          {path + "acceleration_mps2", {&motion.acceleration_mps2}},
          {path + "yaw_rate_dps", {&motion.yaw_rate_radps, rad}}};
}

std::map<std::string, Stored> stored_numbers(Scenario& s) {
  ScenarioModel& car = s.models.at(0);
  ScenarioModel& post = s.models.at(1);
  ScenarioModel& rail = s.models.at(2);
  ScenarioModel& wall = s.models.at(3);
  ScenarioModel& wide = s.models.at(4);
  ScenarioEgo& ego = s.ego;
  HarmWeights& w = s.harm.weights;
  HarmRanges& r = s.harm.ranges;
  std::map<std::string, Stored> stored{
      {"horizon_s", {&s.horizon_s}},
      {"grip", {&s.grip}},
      {"models.car.mass_kg", {&*car.mass_kg}},
      {"models.car.center_of_mass_m[0]", {&car.center_of_mass_m->x()}},
      {"models.car.center_of_mass_m[1]", {&car.center_of_mass_m->y()}},
      {"models.car.center_of_mass_m[2]", {&car.center_of_mass_m->z()}},
      {"models.car.yaw_inertia_kgm2", {&*car.yaw_inertia_kgm2}},
      {"models.car.stiffness", {&car.stiffness}},
      {"models.wall.honeycomb.pressure_pa", {&wall.honeycomb->pressure_pa}},
      {"models.wall.honeycomb.depth_m", {&wall.honeycomb->depth_m}},
      {"models.wall.honeycomb.low_m", {&wall.honeycomb->low_m}},
      {"models.wall.honeycomb.high_m", {&wall.honeycomb->high_m}},
      {"models.post.mass_kg", {&*post.mass_kg}},
      {"models.post.breakaway.force_n", {&post.breakaway->force_n}},
      {"models.post.breakaway.moment_nm", {&post.breakaway->moment_nm}},
      {"models.post.box[0]", {&post.box_m->x()}},
      {"models.post.box[1]", {&post.box_m->y()}},
      {"models.post.box[2]", {&post.box_m->z()}},
      {"models.rail.box[0]", {&rail.box_m->x()}},
      {"models.rail.box[1]", {&rail.box_m->y()}},
      {"models.rail.box[2]", {&rail.box_m->z()}},
      {"models.rail.deflection_m", {&rail.deflection_m}},
      {"models.rail.deflection_force_n", {&*rail.deflection_force_n}},
      {"models.wide.box[0]", {&wide.box_m->x()}},
      {"models.wide.box[1]", {&wide.box_m->y()}},
      {"models.wide.box[2]", {&wide.box_m->z()}},
      {"ego.pose.x_m", {&ego.pose.translation.x()}},
      {"ego.pose.y_m", {&ego.pose.translation.y()}},
      {"ego.pose.z_m", {&ego.pose.translation.z()}},
      {"ego.speed_mps", {&ego.speed_mps}},
      {"ego.yaw_rate_dps", {&ego.yaw_rate_radps, rad}},
      {"ego.wheelbase_m", {&*ego.wheelbase_m}},
      {"ego.max_acceleration_mps2", {&ego.max_acceleration_mps2}},
      {"ego.max_deceleration_mps2", {&*ego.max_deceleration_mps2}},
      {"ego.max_steering_deg", {&ego.max_steering_rad, rad}},
      {"ego.max_steering_rate_dps", {&ego.max_steering_rate_radps, rad}},
      {"ego.occupants", {&*ego.occupants}},
      {"ego.uncertainty.position_m", {&ego.uncertainty.position_m}},
      {"ego.uncertainty.heading_deg", {&ego.uncertainty.heading_rad, rad}},
      {"ego.uncertainty.speed_mps", {&ego.uncertainty.speed_mps}},
      {"candidates.listed[0].acceleration_mps2", {&s.listed.at(0).acceleration_mps2}},
      {"candidates.listed[0].steering_deg", {&*s.listed.at(0).steering_rad, rad}},
      {"candidates.listed[1].acceleration_mps2", {&s.listed.at(1).acceleration_mps2}},
      {"candidates.listed[1].yaw_rate_dps", {&*s.listed.at(1).yaw_rate_radps, rad}},
      {"actors[0].occupants", {&*s.actors.at(0).occupants}},
      {"actors[0].existence_probability", {&s.actors.at(0).existence_probability}},
      {"actors[0].perception.position_m", {&s.actors.at(0).perception.position_m}},
      {"actors[0].perception.heading_deg", {&s.actors.at(0).perception.heading_rad, rad}},
      {"actors[0].perception.speed_mps", {&s.actors.at(0).perception.speed_mps}},
      {"road.off_road.harm_per_leaving", {&s.road.harm_per_leaving}},
      {"road.off_road.grip", {&*s.road.off_road_grip}},
      {"harm.weights.ego_occupant", {&w.ego_occupant}},
      {"harm.weights.other_occupant", {&w.other_occupant}},
      {"harm.weights.pedestrian", {&w.pedestrian}},
      {"harm.weights.cyclist", {&w.cyclist}},
      {"harm.weights.motorcyclist", {&w.motorcyclist}},
      {"harm.weights.property_per_mj", {&w.property_per_mj}},
      {"harm.people.ego", {&w.people_in_ego}},
      {"harm.people.car", {&w.people_in_car}},
      {"harm.people.truck", {&w.people_in_truck}},
      {"harm.people.bus", {&w.people_in_bus}},
      {"harm.pedestrian.age_years", {&*s.harm.pedestrian.age_years}},
      {"harm.pedestrian.male_share", {&*s.harm.pedestrian.male_share}},
      {"harm.friction", {&s.harm.friction}},
      {"harm.ranges.friction[0]", {&r.least_friction}},
      {"harm.ranges.friction[1]", {&r.most_friction}},
      {"harm.ranges.strength[0]", {&r.least_strength}},
      {"harm.ranges.strength[1]", {&r.most_strength}},
      {"harm.ranges.restitution[0]", {&r.least_restitution}},
      {"harm.ranges.restitution[1]", {&r.most_restitution}},
      {"harm.ranges.risk_speed[0]", {&r.least_risk_speed}},
      {"harm.ranges.risk_speed[1]", {&r.most_risk_speed}},
      {"harm.least_struck_share", {&s.harm.least_struck_share}},
  };
  stored.merge(stored_motion("actors[0].", s.actors.at(0)));
  stored.merge(stored_motion("actors[1].", s.actors.at(1)));
  for (std::size_t k = 0; k < s.actors.at(2).predictions.size(); ++k) {
    Prediction& prediction = s.actors.at(2).predictions[k];
    const std::string path = "actors[2].predictions[" + std::to_string(k) + "].";
    stored[path + "probability"] = {&prediction.probability};
    stored.merge(stored_motion(path, prediction));
  }
  return stored;
}

// What a Scenario has in another form than the file, or not at all.
bool has_no_number_of_its_own(const std::string& path) {
  static const std::vector<std::string> forms{
      "_deg",             // of poses: rotations
      ".scale",           // of a mesh: ImportTransform, checked with the mesh
      ".origin_m[",       // the same
      ".after_impact.",   // without effect
      "road.drivable",    // corners: check_area
      "candidates.grid."  // whole numbers
  };
  return std::any_of(forms.begin(), forms.end(), [&path](const std::string& form) {
    return path.find(form) != std::string::npos;
  });
}

TEST(KeyRanges, TheCheckRefusesWhatTheParserRefuses) {
  const json document = full_document();
  Result<Scenario> parsed = parse_scenario(document.dump(), "f");
  ASSERT_TRUE(parsed.ok()) << parsed.error().message();
  Scenario scenario = *parsed;
  const std::map<std::string, Stored> stored = stored_numbers(scenario);
  ASSERT_TRUE(detail::check_scenario(scenario).ok());
  std::size_t checked = 0;
  for (const NumberAt& number : numbers_of(document)) {
    const std::string path = key_path(number.place);
    const auto found = stored.find(path);
    if (found == stored.end()) {
      EXPECT_TRUE(has_no_number_of_its_own(path)) << path;
      continue;
    }
    ++checked;
    double& kept = *found->second.number;
    const double unit = found->second.unit;
    const double before = kept;
    for (const double outside : {just_below(number), just_above(number)}) {
      kept = outside * unit;
      const Status status = detail::check_scenario(scenario);
      ASSERT_FALSE(status.ok()) << path << ": " << outside;
      // An array's elements share the name of the array there.
      EXPECT_EQ(path.find(status.error().place), 0U) << path << ": " << status.error().message();
      EXPECT_NE(status.error().reason.find("out of range"), std::string::npos)
          << path << ": " << status.error().message();
    }
    kept = number.range.highest * unit;
    const Status status = detail::check_scenario(scenario);
    if (!status.ok()) {
      EXPECT_EQ(status.error().reason.find("out of range"), std::string::npos)
          << path << ": " << status.error().message();
    }
    kept = before;
  }
  EXPECT_EQ(checked, stored.size());
}

}  // namespace
}  // namespace crashrank

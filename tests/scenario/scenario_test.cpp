#include "crashrank/scenario/scenario.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace crashrank {
namespace {

using nlohmann::json;

std::string read(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  EXPECT_TRUE(in) << path;
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

json sample() { return json::parse(read(CRASHRANK_SCENARIO_DATA "/sample.json")); }

Error error_of(const std::string& text) {
  const Result<Scenario> scenario = parse_scenario(text, "f.json");
  EXPECT_FALSE(scenario.ok());
  return scenario.ok() ? Error{} : scenario.error();
}

TEST(Scenario, EveryKeyOfTheSampleArrives) {
  const Result<Scenario> parsed = parse_scenario(sample().dump(), "f.json");
  ASSERT_TRUE(parsed.ok()) << parsed.error().message();
  const Scenario& s = *parsed;
  EXPECT_EQ(s.name, "sample");
  ASSERT_EQ(s.models.size(), 2U);
  EXPECT_EQ(s.models[0].name, "car");
  EXPECT_EQ(s.models[0].mesh, "meshes/box.obj");
  EXPECT_EQ(s.models[0].kind, BodyKind::car);
  EXPECT_EQ(s.models[0].mass_kg, 1500.0);
  EXPECT_EQ(s.models[0].center_of_mass_m, Eigen::Vector3d(1.2, 0.0, 0.55));
  EXPECT_EQ(s.models[0].yaw_inertia_kgm2, 2400.0);
  EXPECT_EQ(s.models[0].stiffness, 1.25);
  EXPECT_EQ(s.models[0].surface, Surface::sheet_metal);
  EXPECT_EQ(s.models[1].kind, BodyKind::barrier);
  EXPECT_FALSE(s.models[1].center_of_mass_m || s.models[1].yaw_inertia_kgm2);
  EXPECT_EQ(s.models[1].stiffness, 1.0);
  EXPECT_EQ(s.models[1].surface, Surface::concrete);
  EXPECT_FALSE(s.models[0].honeycomb.has_value());
  EXPECT_EQ(s.models[1].honeycomb, (Honeycomb{342000.0, 0.54, 0.2, 0.85}));
  EXPECT_FALSE(s.models[1].mass_kg.has_value());
  EXPECT_EQ(s.models[1].transform.scale, 10.0);
  EXPECT_EQ(s.ego.model, 0U);
  EXPECT_EQ(s.ego.speed_mps, 20.0);
  EXPECT_EQ(s.ego.wheelbase_m, 2.7);
  EXPECT_NEAR(s.ego.max_steering_rad, 35.0 * M_PI / 180.0, 1e-15);
  EXPECT_EQ(s.ego.occupants, 2.0);
  ASSERT_EQ(s.listed.size(), 4U);
  EXPECT_FALSE(s.listed[0].steering_rad || s.listed[0].yaw_rate_radps);
  EXPECT_EQ(s.listed[1].acceleration_mps2, -3.0);
  EXPECT_NEAR(*s.listed[1].steering_rad, 2.5 * M_PI / 180.0, 1e-15);
  EXPECT_NEAR(*s.listed[2].yaw_rate_radps, -12.0 * M_PI / 180.0, 1e-15);
  ASSERT_EQ(s.listed[3].poses.size(), 2U);
  EXPECT_EQ(s.listed[3].poses[1].time_s, 1.0);
  EXPECT_EQ(s.listed[3].poses[1].pose.translation, Eigen::Vector3d(18.0, 1.0, 0.0));
  ASSERT_TRUE(s.grid.has_value());
  EXPECT_EQ(s.grid->accelerations, 3U);
  EXPECT_EQ(s.grid->steerings, 5U);
  EXPECT_TRUE(s.add_straight_braking);
  ASSERT_EQ(s.actors.size(), 3U);
  EXPECT_EQ(s.actors[0].speed_mps, 15.0);
  EXPECT_EQ(s.actors[0].acceleration_mps2, -2.0);
  EXPECT_NEAR(s.actors[0].yaw_rate_radps, 3.0 * M_PI / 180.0, 1e-15);
  EXPECT_NEAR(s.actors[0].pose.rotation(0, 0), -1.0, 1e-15);
  EXPECT_EQ(s.actors[1].model, 1U);
  EXPECT_EQ(s.actors[2].poses.size(), 2U);
  EXPECT_EQ(s.actors[0].occupants, 0.0);
  EXPECT_FALSE(s.actors[1].occupants.has_value());
  EXPECT_EQ(s.actors[2].occupants, 4.5);
  EXPECT_EQ(s.horizon_s, 4.0);
  EXPECT_EQ(s.keys_without_effect, (std::vector<std::string>{"crush", "harm.after_impact"}));
  EXPECT_EQ(s.measure, Measure::area);
  EXPECT_EQ(s.harm.model, RiskModel::malliaris_monfort);
  EXPECT_EQ(s.harm.weights.pedestrian, 2.0);
  EXPECT_EQ(s.harm.weights.property_per_mj, 0.5);
  EXPECT_EQ(s.harm.weights.cyclist, 1.0);
  EXPECT_EQ(s.harm.weights.people_in_ego, 3.0);
  EXPECT_EQ(s.harm.ranges.least_friction, 0.2);
  EXPECT_EQ(s.harm.ranges.most_friction, 0.5);
  EXPECT_FALSE(s.harm.ranges.all_models);
  EXPECT_EQ(s.harm.after_contact, AfterContact::releases);
  EXPECT_EQ(s.grip, 0.8);
}

// The same variants are given to the published schema by schema_test.py.
TEST(Scenario, EveryErrorNamesItsKeyPath) {
  const json variants = json::parse(read(CRASHRANK_SCENARIO_DATA "/bad_scenarios.json"));
  ASSERT_GT(variants.size(), 50U);
  for (const json& variant : variants) {
    SCOPED_TRACE(variant.at("why").get<std::string>());
    const std::string text = sample().patch(variant.at("patch")).dump();
    const Result<Scenario> scenario = parse_scenario(text, "f.json");
    EXPECT_EQ(scenario.ok(), !variant.contains("place"));
    if (scenario.ok()) continue;
    EXPECT_EQ(scenario.error().place, variant.value("place", std::string()));
    EXPECT_EQ(scenario.error().file, "f.json");
    EXPECT_FALSE(scenario.error().reason.empty());
    EXPECT_FALSE(scenario.error().remedy.empty());
    EXPECT_TRUE(scenario.error().code == ErrorCode::bad_input ||
                scenario.error().code == ErrorCode::limit_exceeded);
    EXPECT_EQ(scenario.error().message().find('\n'), std::string::npos);
  }
}

TEST(Scenario, DefaultsAreThoseOfTheSchema) {
  const json schema = json::parse(read(CRASHRANK_SCHEMA));
  const auto at = [&schema](const char* pointer) { return schema.at(json::json_pointer(pointer)); };
  const std::string least = R"({"scenario_version":1,"models":{"m":{"mesh":"a.obj","kind":"car"}},)"
                            R"("ego":{"model":"m","speed_mps":1}})";
  const Result<Scenario> s = parse_scenario(least, "folder/least.json");
  ASSERT_TRUE(s.ok()) << s.error().message();
  EXPECT_EQ(s->name, "least");
  EXPECT_EQ(at("/properties/horizon_s/default"), s->horizon_s);
  EXPECT_EQ(at("/properties/grip/default"), s->grip);
  EXPECT_EQ(at("/properties/measure/default"), measure_name(s->measure));
  EXPECT_EQ(at("/$defs/ego/properties/max_acceleration_mps2/default"),
            s->ego.max_acceleration_mps2);
  EXPECT_NEAR(at("/$defs/ego/properties/max_steering_deg/default").get<double>(),
              s->ego.max_steering_rad * 180.0 / M_PI, 1e-12);
  EXPECT_NEAR(at("/$defs/ego/properties/max_steering_rate_dps/default").get<double>(),
              s->ego.max_steering_rate_radps * 180.0 / M_PI, 1e-12);
  EXPECT_FALSE(s->ego.max_deceleration_mps2 || s->road.ends() || s->road.off_road_grip);
  EXPECT_EQ(s->road.harm_per_leaving, 0.0);
  for (const char* const key : {"position_m", "heading_deg", "speed_mps"}) {
    const std::string errors = "/$defs/state_errors/properties/";
    EXPECT_EQ(at((errors + key + "/default").c_str()), 0.0);
  }
  EXPECT_FALSE(s->ego.uncertainty.any() || is_uncertain(*s));
  ASSERT_TRUE(s->grid.has_value());
  EXPECT_EQ(s->grid->accelerations, 15U);
  EXPECT_EQ(s->grid->steerings, 15U);
  EXPECT_TRUE(s->add_straight_braking);
  EXPECT_EQ(at("/$defs/model/properties/stiffness/default"), s->models[0].stiffness);
  EXPECT_FALSE(s->models[0].surface || s->ego.occupants);
}

TEST(Scenario, ErrorsOfStatesAreReadInTheirUnits) {
  json document = sample();
  document["scenario_version"] = 2;
  document["ego"]["uncertainty"] = {{"position_m", 0.25}, {"heading_deg", 18}, {"speed_mps", 1.5}};
  document["actors"][0]["perception"] = {{"heading_deg", 9}};
  const Result<Scenario> s = parse_scenario(document.dump(), "f");
  ASSERT_TRUE(s.ok()) << s.error().message();
  EXPECT_EQ(s->ego.uncertainty.position_m, 0.25);
  EXPECT_NEAR(s->ego.uncertainty.heading_rad, 0.1 * M_PI, 1e-15);
  EXPECT_EQ(s->ego.uncertainty.speed_mps, 1.5);
  EXPECT_EQ(s->actors[0].perception.position_m, 0.0);
  EXPECT_NEAR(s->actors[0].perception.heading_rad, 0.05 * M_PI, 1e-15);
  EXPECT_FALSE(s->actors[1].perception.any());
  EXPECT_TRUE(is_uncertain(*s));
  EXPECT_FALSE(is_uncertain(likeliest_future(*s)));
}

TEST(Scenario, RoundedProbabilitiesAreDividedByTheirSum) {
  const auto with = [](const std::vector<double>& probabilities) {
    json document = sample();
    document["scenario_version"] = 2;
    json& actor = document["actors"][1];
    actor = {{"name", "may turn"}, {"model", "car"}};
    for (const double each : probabilities) {
      actor["predictions"].push_back({{"probability", each}, {"speed_mps", 9}});
    }
    return parse_scenario(document.dump(), "f");
  };
  for (const auto& [written, read] :
       std::vector<std::pair<std::vector<double>, std::vector<double>>>{
           {{0.33, 0.33, 0.33}, {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}},
           {{0.51, 0.5}, {0.51 / 1.01, 0.5 / 1.01}},
           {{0.99}, {1.0}},
           {{0.25, 0.7499}, {0.25 / 0.9999, 0.7499 / 0.9999}}}) {
    const Result<Scenario> s = with(written);
    ASSERT_TRUE(s.ok()) << s.error().message();
    EXPECT_EQ(s->normalised, std::vector<std::string>{"actors[1].predictions"});
    for (std::size_t k = 0; k < read.size(); ++k) {
      EXPECT_NEAR(s->actors[1].predictions[k].probability, read[k], 1e-15);
    }
  }
  // What rounding of the last digit leaves is kept as it is written.
  const Result<Scenario> exact = with({0.25, 0.7500001});
  ASSERT_TRUE(exact.ok());
  EXPECT_TRUE(exact->normalised.empty());
  EXPECT_EQ(exact->actors[1].predictions[1].probability, 0.7500001);
  EXPECT_EQ(with({0.5, 0.48}).error().place, "actors[1].predictions");

  json document = sample();
  document["scenario_version"] = 2;
  document["futures"] = {{{"probability", 0.3}, {"motions", json::object()}},
                         {{"probability", 0.695}, {"motions", json::object()}}};
  const Result<Scenario> joint = parse_scenario(document.dump(), "f");
  ASSERT_TRUE(joint.ok()) << joint.error().message();
  EXPECT_EQ(joint->normalised, std::vector<std::string>{"futures"});
  EXPECT_NEAR(joint->futures[0].probability, 0.3 / 0.995, 1e-15);
}

TEST(Scenario, PoseAndSpeedStandOnceBesidePredictions) {
  json document = sample();
  document["scenario_version"] = 2;
  document["actors"][1] = {{"name", "may turn"},
                           {"model", "car"},
                           {"pose", {{"x_m", 40}, {"yaw_deg", 180}}},
                           {"speed_mps", 11},
                           {"predictions",
                            {{{"probability", 0.5}, {"yaw_rate_dps", 20}},
                             {{"probability", 0.25}, {"pose", {{"y_m", 3}}}, {"speed_mps", 0}},
                             {{"probability", 0.25}, {"poses", {{{"t_s", 0}, {"x_m", 39}}}}}}}};
  const Result<Scenario> s = parse_scenario(document.dump(), "f");
  ASSERT_TRUE(s.ok()) << s.error().message();
  const std::vector<Prediction>& predictions = s->actors[1].predictions;
  EXPECT_EQ(predictions[0].pose.translation, Eigen::Vector3d(40.0, 0.0, 0.0));
  EXPECT_NEAR(predictions[0].pose.rotation(0, 0), -1.0, 1e-15);
  EXPECT_EQ(predictions[0].speed_mps, 11.0);
  EXPECT_EQ(predictions[1].pose.translation, Eigen::Vector3d(0.0, 3.0, 0.0));
  EXPECT_EQ(predictions[1].pose.rotation(0, 0), 1.0);
  EXPECT_EQ(predictions[1].speed_mps, 0.0);
  EXPECT_EQ(predictions[2].poses.front().pose.translation.x(), 39.0);
}

TEST(Scenario, KeysWithoutEffectAreListed) {
  json document = sample();
  EXPECT_EQ(parse_scenario(document.dump(), "f")->keys_without_effect,
            (std::vector<std::string>{"crush", "harm.after_impact"}));
  document["harm"].erase("after_impact");
  EXPECT_EQ(parse_scenario(document.dump(), "f")->keys_without_effect,
            (std::vector<std::string>{"crush"}));
  document.erase("crush");
  document.erase("harm");
  EXPECT_TRUE(parse_scenario(document.dump(), "f")->keys_without_effect.empty());
}

TEST(Scenario, WhatWheelsDoAfterAContactReadsBackFromTheSchema) {
  const json key = json::parse(read(CRASHRANK_SCHEMA))
                       .at(json::json_pointer("/$defs/harm/properties/after_contact"));
  ASSERT_EQ(key.at("enum").size(), 3U);
  EXPECT_EQ(key.at("default"), after_contact_name(HarmOptions{}.after_contact));
  json document = sample();
  for (const json& name : key.at("enum")) {
    document["harm"]["after_contact"] = name;
    const Result<Scenario> s = parse_scenario(document.dump(), "f");
    ASSERT_TRUE(s.ok()) << s.error().message();
    EXPECT_EQ(after_contact_name(s->harm.after_contact), name.get<std::string>());
  }
}

TEST(Scenario, EverySurfaceOfTheSchemaReadsBack) {
  const json names = json::parse(read(CRASHRANK_SCHEMA))
                         .at(json::json_pointer("/$defs/model/properties/surface/enum"));
  ASSERT_EQ(names.size(), 6U);
  for (const json& name : names) {
    const Result<Surface> surface = surface_from_name(name.get<std::string>());
    ASSERT_TRUE(surface.ok());
    EXPECT_EQ(surface_name(*surface), name.get<std::string>());
  }
  EXPECT_NE(surface_from_name("glass").error().remedy.find("sheet-metal"), std::string::npos);
}

TEST(Scenario, ListedCandidatesReplaceTheGrid) {
  json document = sample();
  document["candidates"].erase("grid");
  EXPECT_FALSE(parse_scenario(document.dump(), "f")->grid.has_value());
  document["candidates"]["grid"] = true;
  EXPECT_TRUE(parse_scenario(document.dump(), "f")->grid.has_value());
}

TEST(Scenario, TextThatIsNoJsonNamesLineAndColumn) {
  EXPECT_EQ(error_of("{\n  \"a\": }").place, "line 2, column 8");
  EXPECT_EQ(error_of("").reason, "is empty");
  EXPECT_EQ(error_of(" \n").reason, "is empty");
  EXPECT_EQ(error_of("{\"a\": 1").reason, "the text ends too early");
  EXPECT_EQ(error_of("{\"a\": NaN}").place, "line 1, column 7");
  EXPECT_EQ(error_of("{} x").place, "line 1, column 4");
  EXPECT_EQ(error_of("{\"a\": 1,}").place, "line 1, column 9");
  EXPECT_EQ(error_of("{// no\n}").place, "line 1, column 2");
  EXPECT_EQ(error_of("[]").reason, "is array, not an object");
}

TEST(Scenario, TextInLatin1NamesTheByteThatIsNotUtf8) {
  for (const char* const text :
       {"{\n \"name\": \"M\xfcnchen\"}", "{\n \"name\": \"M\xff\"}", "{\n \"name\": \"M\xc3\"}"}) {
    const Error error = error_of(text);
    EXPECT_EQ(error.reason, "this byte is not UTF-8");
    EXPECT_EQ(error.place, "line 2, column 12");
  }
  EXPECT_EQ(error_of("{\"a\": }  \"\xfc\"").reason, "this is not JSON");
}

TEST(Scenario, ANumberBeyondADoubleNamesItsKey) {
  EXPECT_EQ(error_of(R"({"grip": 1e999})").place, "grip");
  EXPECT_EQ(error_of(R"({"ego": {"speed_kmh": -1e999}})").place, "ego.speed_kmh");
  EXPECT_EQ(error_of(R"({"actors": [{"poses": [[0, 1], [2, 1e999]]}]})").place,
            "actors[0].poses[1][1]");
  EXPECT_EQ(error_of(R"({"a": [1], "b": [1e999]})").place, "b[0]");
}

TEST(Scenario, WhatIsNoJsonAtAllIsTold) {
  for (const char* const text : {"# a mesh\no car\nv 0 0 0\n", "v 0 0 0", "glTF\x02\x01"}) {
    const Error error = error_of(text);
    EXPECT_EQ(error.place, "line 1, column 1");
    EXPECT_NE(error.reason.find("not JSON, which begins with {"), std::string::npos);
  }
}

TEST(Scenario, AKeyThatComesTwiceIsAnError) {
  EXPECT_EQ(error_of(R"({"grip": 1, "grip": 2})").place, "grip");
  EXPECT_EQ(error_of(R"({"actors": [{"name": "a"}, {"name": "b", "name": "c"}]})").place,
            "actors[1].name");
}

TEST(Scenario, HostileTextIsRefusedCheaply) {
  EXPECT_EQ(error_of(std::string(1'000'000, '[')).reason, "nested too deeply");
  EXPECT_EQ(error_of("{\"grip\": 1e999}").code, ErrorCode::bad_input);
  EXPECT_EQ(error_of(std::string(scenario_limits::file_bytes + 1, ' ')).code,
            ErrorCode::limit_exceeded);
  json crowded = sample();
  for (int i = 0; i < 1001; ++i) {
    crowded["actors"].push_back({{"name", std::to_string(i)}, {"model", "car"}});
  }
  EXPECT_EQ(error_of(crowded.dump()).code, ErrorCode::limit_exceeded);
  EXPECT_EQ(error_of(crowded.dump()).place, "actors");
}

TEST(Scenario, UnknownKeysAreShownWithoutControlCharacters) {
  const Error error = error_of("{\"a\\nb\\u001b[2J\": 1}");
  EXPECT_EQ(error.place, "a?b?[2J");
}

TEST(Scenario, ErrorsQuoteTheTextWithoutControlCharacters) {
  EXPECT_EQ(error_of(R"({"\u001b[2J": 1, "\u001b[2J": 2})").place, "?[2J");
  json odd = sample();
  odd["models"].begin().value()["kind"] = "c\x1b]0;r\xc2\x9b";
  EXPECT_EQ(error_of(odd.dump()).reason, "'c?]0;r?' is not a kind of body");
  // Cut between characters.
  json wide = sample();
  wide[std::string(63, 'k') + "\xc3\xa9"] = 1;
  EXPECT_EQ(error_of(wide.dump()).place, std::string(63, 'k') + "...");
}

TEST(MassGuess, FollowsKindAndSize) {
  const Eigen::Vector3d car(4.5, 1.8, 1.5);
  EXPECT_NEAR(guess_mass_kg(BodyKind::car, car), -1333.5 + 526.9 * std::exp(0.8 * std::log(8.1)),
              1e-9);
  EXPECT_EQ(guess_mass_kg(BodyKind::car, {1.0, 1.0, 1.0}), 300.0);
  EXPECT_EQ(guess_mass_kg(BodyKind::truck, car), 25000.0);
  EXPECT_EQ(guess_mass_kg(BodyKind::bus, car), 13000.0);
  EXPECT_EQ(guess_mass_kg(BodyKind::motorcycle, car), 250.0);
  EXPECT_EQ(guess_mass_kg(BodyKind::bicycle, car), 90.0);
  EXPECT_EQ(guess_mass_kg(BodyKind::bus, {24.0, 2.55, 3.2}), 13000.0);
  EXPECT_EQ(guess_mass_kg(BodyKind::bus, {30.0, 2.3, 3.6}), 45000.0);  // a tram
  EXPECT_EQ(guess_mass_kg(BodyKind::pedestrian, {0.9, 0.6, 1.75}), 75.0);
  EXPECT_NEAR(guess_mass_kg(BodyKind::pedestrian, {0.61, 0.38, 1.14}), 23.6, 0.1);  // six years
  EXPECT_NEAR(guess_mass_kg(BodyKind::pedestrian, {0.6, 0.5, 1.88}), 91.0, 0.1);
  EXPECT_NEAR(guess_mass_kg(BodyKind::pedestrian, {1.75, 0.6, 0.3}), 75.0, 0.1);  // lies
  EXPECT_EQ(guess_mass_kg(BodyKind::pedestrian, {1.1, 0.67, 1.39}), 93.0);        // in a wheelchair
  for (const BodyKind kind : {BodyKind::barrier, BodyKind::pole, BodyKind::building}) {
    EXPECT_TRUE(std::isinf(guess_mass_kg(kind, car)));
  }
}

TEST(Measure, NamesReadBack) {
  for (const Measure measure : {Measure::polygons, Measure::area, Measure::closing_energy}) {
    EXPECT_EQ(*measure_from_name(measure_name(measure)), measure);
  }
  EXPECT_STREQ(measure_unit(Measure::area), "m2");
  EXPECT_EQ(measure_from_name("harmless").error().code, ErrorCode::usage);
}

TEST(Scenario, ACheckFindsEveryErrorOnce) {
  json document = sample();
  EXPECT_TRUE(parse_scenario(document.dump(), "f.json").ok());
  document["horizon"] = 3;
  document["grip"] = "high";
  document["models"]["car"].erase("kind");
  document["models"]["wall"]["mesh"] = "/elsewhere/wall.obj";
  document["ego"].erase("speed_mps");
  document["candidates"]["listed"][1]["steering_deg"] = 500;
  document["actors"][0]["pose"] = 3;
  document["actors"][1]["name"] = document["actors"][0]["name"];
  document["actors"][2]["model"] = "van";
  const CheckedScenario checked = check_scenario(document.dump(), "f.json");
  std::vector<std::string> places;
  for (const Error& error : checked.errors) {
    places.push_back(error.place);
    EXPECT_NE(error.file, "");
    EXPECT_FALSE(error.reason.empty() || error.remedy.empty()) << error.message();
  }
  const std::vector<std::string> expected{
      "horizon",         "models.car.kind", "ego.speed_mps", "candidates.listed[1].steering_deg",
      "actors[0].pose",  "actors[2].model", "grip",          "actors[1].name",
      "models.wall.mesh"};
  EXPECT_EQ(places, expected);
}

TEST(Scenario, ACheckFindsMotionsThatNoBodyHas) {
  json document = sample();
  document["models"]["car"] = {{"box", {4.5, 1.8, 1.5}}, {"kind", "car"}};
  document["models"]["wall"] = {{"box", {4, 0.6, 0.8}}, {"kind", "barrier"}};
  EXPECT_TRUE(check_scenario(document.dump(), "f.json").errors.empty());
  for (std::size_t i = 0; i < 2; ++i) {
    document["actors"][i] = {{"name", std::to_string(i)},
                             {"model", "car"},
                             {"poses", {{{"t_s", 0}}, {{"t_s", 1}, {"x_m", 400}}}}};
  }
  const CheckedScenario checked = check_scenario(document.dump(), "f.json");
  ASSERT_EQ(checked.errors.size(), 2U);
  EXPECT_EQ(checked.errors[1].place, "actors[1]");
}

TEST(Scenario, ACheckOfAnyPartOfADocumentEnds) {
  const json whole = json::parse(read(CRASHRANK_SCENARIO_DATA "/all_numbers.json"));
  const json flat = whole.flatten();
  for (const auto& [pointer, value] : flat.items()) {
    for (json::json_pointer place(pointer); !place.empty(); place = place.parent_pointer()) {
      for (const json& other : {json(), json(7), json("x"), json::array(), json::object()}) {
        json changed = whole;
        changed[place] = other;
        check_scenario(changed.dump(), "f.json");
      }
    }
  }
  EXPECT_EQ(check_scenario("{", "f.json").errors.size(), 1U);
}

}  // namespace
}  // namespace crashrank

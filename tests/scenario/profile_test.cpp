#include "crashrank/scenario/harm_options.hpp"

#include "rank/scenes.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace crashrank {
namespace {

using nlohmann::json;

std::string read(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

json default_profile() {
  return json::parse(read(CRASHRANK_DATA "/profiles/everybody_alike.json"));
}

void expect_refused(const std::string& text, const std::string& place) {
  SCOPED_TRACE(text.substr(0, 100));
  const Result<HarmOptions> profile = parse_profile(text, "p.json");
  ASSERT_FALSE(profile.ok());
  EXPECT_EQ(profile.error().file, "p.json");
  EXPECT_EQ(profile.error().place, place);
  EXPECT_FALSE(profile.error().reason.empty());
  EXPECT_FALSE(profile.error().remedy.empty());
  EXPECT_TRUE(profile.error().code == ErrorCode::bad_input ||
              profile.error().code == ErrorCode::limit_exceeded);
  EXPECT_EQ(profile.error().message().find('\n'), std::string::npos);
}

std::vector<double> numbers_of(const HarmOptions& h) {
  const HarmWeights& w = h.weights;
  const HarmRanges& r = h.ranges;
  return {static_cast<double>(h.model),
          w.ego_occupant,
          w.other_occupant,
          w.pedestrian,
          w.cyclist,
          w.motorcyclist,
          w.property_per_mj,
          w.people_in_ego,
          w.people_in_car,
          w.people_in_truck,
          w.people_in_bus,
          h.pedestrian.age_years.value_or(-1.0),
          h.pedestrian.male_share.value_or(-1.0),
          h.friction,
          r.least_friction,
          r.most_friction,
          r.least_strength,
          r.most_strength,
          r.least_restitution,
          r.most_restitution,
          r.least_risk_speed,
          r.most_risk_speed,
          r.all_models ? 1.0 : 0.0,
          static_cast<double>(h.after_contact),
          h.least_struck_share};
}

TEST(Profile, TheShippedOneWritesOutTheDefaults) {
  // Laid over values that are all different, it has to say every one of them.
  HarmOptions other;
  other.model = RiskModel::joksch_monfort;
  other.weights = {7, 7, 7, 7, 7, 7, 7, 7, 7, 7};
  other.pedestrian = {7, 0.7};
  other.friction = 7;
  other.ranges = {0.7, 0.7, 7, 7, 0.7, 0.7, 7, 7, false};
  other.after_contact = AfterContact::locks;
  other.least_struck_share = 0.7;
  const Result<HarmOptions> profile = parse_profile(default_profile().dump(), "p.json", other);
  ASSERT_TRUE(profile.ok()) << profile.error().message();
  EXPECT_EQ(numbers_of(*profile), numbers_of(HarmOptions{}));
}

TEST(Profile, WhatItLeavesOutStays) {
  HarmOptions other;
  other.weights.pedestrian = 3.0;
  other.ranges.most_strength = 2.0;
  const Result<HarmOptions> profile = parse_profile(
      R"({"profile_version": 1, "weights": {"cyclist": 0.5}, "friction": 0.4})", "p.json", other);
  ASSERT_TRUE(profile.ok()) << profile.error().message();
  other.weights.cyclist = 0.5;
  other.friction = 0.4;
  EXPECT_EQ(numbers_of(*profile), numbers_of(other));
}

TEST(Profile, WhatWheelsDoAfterAContactIsReadByName) {
  for (const AfterContact after :
       {AfterContact::brakes, AfterContact::releases, AfterContact::locks}) {
    const json text{{"profile_version", 1}, {"after_contact", after_contact_name(after)}};
    HarmOptions other;
    other.after_contact =
        after == AfterContact::brakes ? AfterContact::locks : AfterContact::brakes;
    const Result<HarmOptions> profile = parse_profile(text.dump(), "p.json", other);
    ASSERT_TRUE(profile.ok()) << profile.error().message();
    EXPECT_EQ(profile->after_contact, after);
  }
}

TEST(Profile, KeysWithoutEffectChangeNothing) {
  HarmOptions other;
  other.after_contact = AfterContact::releases;
  const Result<HarmOptions> profile = parse_profile(
      R"({"profile_version": 1,
          "after_impact": {"deceleration_mps2": 9, "longest_s": 1, "most_contacts": 2}})",
      "p.json", other);
  ASSERT_TRUE(profile.ok()) << profile.error().message();
  EXPECT_EQ(numbers_of(*profile), numbers_of(other));
}

TEST(Profile, ErrorsNameTheirPlace) {
  const auto with = [](const char* pointer, const json& value) {
    json profile = default_profile();
    profile[json::json_pointer(pointer)] = value;
    return profile.dump();
  };
  expect_refused("{}", "profile_version");
  expect_refused(with("/profile_version", 2), "profile_version");
  expect_refused(with("/mercy", 1), "mercy");
  expect_refused(with("/name", "two\nlines"), "name");
  expect_refused(with("/description", std::string(5000, 'x')), "description");
  expect_refused(with("/weights/ego_occupant", -0.1), "weights.ego_occupant");
  expect_refused(with("/weights/ego_occupant", "all"), "weights.ego_occupant");
  expect_refused(with("/pedestrian/age_years", 121), "pedestrian.age_years");
  expect_refused(with("/pedestrian/male_share", -0.1), "pedestrian.male_share");
  expect_refused(with("/pedestrian/height_m", 1.7), "pedestrian.height_m");
  expect_refused(with("/ranges/restitution", json::array({0.5, 11})), "ranges.restitution[1]");
  expect_refused(with("/weights/ego_occupant", nullptr), "weights.ego_occupant");
  expect_refused(with("/people/bus", 1e300), "people.bus");
  expect_refused(with("/ranges/strength", json::array({1.4, 0.7})), "ranges.strength");
  expect_refused(with("/ranges/strength", json::array({1, 2, 3})), "ranges.strength");
  expect_refused(with("/ranges/all_models", 1), "ranges.all_models");
  expect_refused(with("/after_contact", "flies"), "after_contact");
  expect_refused(with("/after_contact", 0), "after_contact");
  expect_refused(with("/after_impact/most_contacts", 1e9), "after_impact.most_contacts");
  expect_refused(with("/after_impact/longest_s", -1), "after_impact.longest_s");
  expect_refused(with("/after_impact/deceleration_mps2", "hard"), "after_impact.deceleration_mps2");
  expect_refused(with("/after_impact/gentle", 1), "after_impact.gentle");
  expect_refused(with("/after_impact", 3), "after_impact");
  expect_refused(with("/least_struck_share", 1.5), "least_struck_share");
  expect_refused(with("/risk_model", "tea leaves"), "risk_model");
  expect_refused("[]", "");
}

TEST(Profile, TextFromAStrangerIsRefusedInTime) {
  for (const std::string& text :
       {std::string("{\"profile_version\": 1"), std::string("\xff\xfe{}"),
        std::string("{\"profile_version\": 1, \"profile_version\": 1}"), std::string(100000, '['),
        std::string("{\"profile_version\": 1e999}"), std::string("NaN"), std::string()}) {
    const Result<HarmOptions> profile = parse_profile(text, "p.json");
    ASSERT_FALSE(profile.ok());
    EXPECT_EQ(profile.error().file, "p.json");
    EXPECT_FALSE(profile.error().remedy.empty());
  }
  const Result<HarmOptions> large =
      parse_profile(std::string(harm_limits::file_bytes + 1, ' '), "p.json");
  ASSERT_FALSE(large.ok());
  EXPECT_EQ(large.error().code, ErrorCode::limit_exceeded);
}

TEST(Profile, FilesAreReadOrNamed) {
  const Result<HarmOptions> shipped =
      load_profile_file(CRASHRANK_DATA "/profiles/everybody_alike.json");
  ASSERT_TRUE(shipped.ok()) << shipped.error().message();
  const Result<HarmOptions> missing = load_profile_file("/nowhere/p.json");
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().code, ErrorCode::not_found);
  EXPECT_EQ(missing.error().file, "/nowhere/p.json");
  EXPECT_FALSE(load_profile_file(CRASHRANK_DATA).ok());
}

// Ranges: KeyRanges, with schema_test, which holds both schemas against each other.
TEST(Profile, AProfileOfTheSchemasDefaultsIsTheDefault) {
  const json schema = json::parse(read(CRASHRANK_DATA "/profile.schema.json"));
  json profile{{"profile_version", 1}};
  for (const auto& [name, member] : schema.at("properties").items()) {
    if (member.contains("default")) profile[name] = member["default"];
    if (!member.contains("properties")) continue;
    for (const auto& [key, value] : member["properties"].items()) {
      profile[name][key] = value.at("default");
    }
  }
  const Result<HarmOptions> read_back = parse_profile(profile.dump(), "p.json");
  ASSERT_TRUE(read_back.ok()) << read_back.error().message();
  EXPECT_EQ(numbers_of(*read_back), numbers_of(HarmOptions{}));
  EXPECT_EQ(profile.size(), 10U);
}

TEST(Profile, RankTakesTheScenariosAndTheCallersOverIt) {
  scenes::Scene scene;
  const std::size_t car = scene.add_model(
      "car", scenes::box_mesh({2.2F, 0.9F, 0.7F}, 4, {0, 0, 0.7F}), BodyKind::car, 1500.0);
  const std::size_t wall = scene.add_model(
      "wall", scenes::box_mesh({0.5F, 3.0F, 1.0F}, 2, {0, 0, 1}), BodyKind::building);
  scene.scenario.ego.model = car;
  scene.scenario.ego.speed_mps = 12.0;
  scene.add_actor("wall", wall, 10.0, 0.0);
  scene.add_candidate("on", 0.0);
  scene.scenario.measure = Measure::harm;
  const double one = *scene.ranked().ranking[0].score;
  ASSERT_GT(one, 0.0);
  scene.scenario.harm.weights.people_in_ego = 3.0;
  EXPECT_DOUBLE_EQ(*scene.ranked().ranking[0].score, 3.0 * one);
  RankOptions options;
  options.harm = HarmOptions{};
  options.harm->weights.ego_occupant = 0.5;
  const RankResult callers = scene.ranked(options);
  EXPECT_DOUBLE_EQ(*callers.ranking[0].score, 0.5 * one);
  EXPECT_EQ(callers.harm.weights.ego_occupant, 0.5);
  options.harm->weights.ego_occupant = -1.0;
  const Result<RankResult> refused = rank(scene.scenario, scene.models, options);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().place, "harm.weights.ego_occupant");
}

}  // namespace
}  // namespace crashrank

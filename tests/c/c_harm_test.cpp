#include "c/c_objects.hpp"
#include "crashrank/crashrank.hpp"
#include "crashrank/scenario/scenario_models.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <string>
#include <utility>
#include <vector>

using namespace c_objects;

namespace {

Scenario empty_scenario() {
  crashrank_scenario* made = nullptr;
  EXPECT_EQ(crashrank_scenario_create("harm", &made, nullptr), CRASHRANK_OK);
  return Scenario(made);
}

crashrank_harm harm_of(const crashrank_scenario* scenario) {
  auto harm = sized<crashrank_harm>();
  EXPECT_EQ(crashrank_scenario_get_harm(scenario, &harm, nullptr), CRASHRANK_OK);
  return harm;
}

Scores scores_in_cpp(const crashrank::Scenario& scenario,
                     const std::vector<crashrank::Model>& models) {
  crashrank::RankOptions options;
  options.measure = crashrank::Measure::harm;
  const auto ranked = crashrank::rank(scenario, models, options);
  EXPECT_TRUE(ranked.ok());
  Scores scores;
  for (const crashrank::CandidateResult& one : ranked->ranking) {
    scores.emplace_back(ranked->candidates[one.candidate].name, one.score.value_or(-1.0));
  }
  return scores;
}

TEST(CApi, HarmChangesScoresAsInTheLibrary) {
  const std::string file = CRASHRANK_SCENARIOS "/pushed_onto_crossing.json";
  const Loaded in_c = load(file);
  crashrank::Result<crashrank::Scenario> in_cpp = crashrank::load_scenario_file(file);
  ASSERT_TRUE(in_cpp.ok());
  const auto models = crashrank::load_scenario_models(*in_cpp);
  ASSERT_TRUE(models.ok());
  const Scores as_in_file = scores_in_c(in_c);
  EXPECT_EQ(as_in_file, scores_in_cpp(*in_cpp, *models));

  crashrank_error error{};
  crashrank_harm harm = harm_of(in_c.scenario.get());
  crashrank::HarmOptions& same = in_cpp->harm;
  same.weights.ego_occupant = harm.weights_ego_occupant = 0.25;
  same.weights.other_occupant = harm.weights_other_occupant = 3.0;
  same.weights.pedestrian = harm.weights_pedestrian = 7.0;
  same.weights.property_per_mj = harm.weights_property_per_mj = 0.5;
  same.weights.people_in_car = harm.people_car = 2.0;
  same.friction = harm.friction = 0.4;
  same.model = crashrank::RiskModel::malliaris_monfort;
  harm.risk_model = CRASHRANK_RISK_MODEL_MALLIARIS_MONFORT;
  same.after_contact = crashrank::AfterContact::locks;
  harm.after_contact = CRASHRANK_AFTER_CONTACT_LOCKS;
  same.pedestrian.age_years = harm.pedestrian_age_years = 80.0;
  same.ranges.least_strength = harm.ranges_strength[0] = 0.9;
  ASSERT_EQ(crashrank_scenario_set_harm(in_c.scenario.get(), &harm, &error), CRASHRANK_OK)
      << error.message;
  const Scores weighted = scores_in_c(in_c);
  EXPECT_EQ(weighted, scores_in_cpp(*in_cpp, *models));
  EXPECT_NE(weighted, as_in_file);
}

TEST(CApi, HarmReturnsWhatWasSet) {
  const Scenario scenario = empty_scenario();
  const crashrank::HarmOptions defaults;
  crashrank_harm harm = harm_of(scenario.get());
  EXPECT_EQ(harm.weights_pedestrian, defaults.weights.pedestrian);
  EXPECT_EQ(harm.people_bus, defaults.weights.people_in_bus);
  EXPECT_EQ(harm.ranges_restitution[1], defaults.ranges.most_restitution);
  EXPECT_EQ(harm.risk_model, CRASHRANK_RISK_MODEL_TUM);
  EXPECT_EQ(harm.after_contact, CRASHRANK_AFTER_CONTACT_BRAKES);
  EXPECT_EQ(harm.pedestrian_age_years, -1.0);
  EXPECT_EQ(harm.ranges_all_models, 1);

  double next = 1.0;
  for (double* number : {&harm.weights_ego_occupant,
                         &harm.weights_other_occupant,
                         &harm.weights_pedestrian,
                         &harm.weights_cyclist,
                         &harm.weights_motorcyclist,
                         &harm.weights_property_per_mj,
                         &harm.people_ego,
                         &harm.people_car,
                         &harm.people_truck,
                         &harm.people_bus,
                         &harm.pedestrian_age_years,
                         &harm.friction,
                         &harm.ranges_friction[0],
                         &harm.ranges_friction[1],
                         &harm.ranges_strength[0],
                         &harm.ranges_strength[1],
                         &harm.ranges_restitution[0],
                         &harm.ranges_restitution[1],
                         &harm.ranges_risk_speed[0],
                         &harm.ranges_risk_speed[1]}) {
    *number = next += 0.125;
  }
  harm.pedestrian_male_share = 0.5;
  harm.ranges_all_models = 0;
  harm.risk_model = CRASHRANK_RISK_MODEL_JOKSCH_MONFORT;
  harm.after_contact = CRASHRANK_AFTER_CONTACT_RELEASES;
  crashrank_error error{};
  ASSERT_EQ(crashrank_scenario_set_harm(scenario.get(), &harm, &error), CRASHRANK_OK)
      << error.message;
  const crashrank_harm again = harm_of(scenario.get());
  EXPECT_EQ(std::memcmp(&harm, &again, sizeof harm), 0);
}

TEST(CApi, BadHarmIsRefusedByMember) {
  const Scenario scenario = empty_scenario();
  const crashrank_harm before = harm_of(scenario.get());
  using Change = std::function<void(crashrank_harm&, double)>;
  const std::vector<std::pair<const char*, Change>> members{
      {"weights_ego_occupant", [](auto& h, double v) { h.weights_ego_occupant = v; }},
      {"weights_other_occupant", [](auto& h, double v) { h.weights_other_occupant = v; }},
      {"weights_pedestrian", [](auto& h, double v) { h.weights_pedestrian = v; }},
      {"weights_cyclist", [](auto& h, double v) { h.weights_cyclist = v; }},
      {"weights_motorcyclist", [](auto& h, double v) { h.weights_motorcyclist = v; }},
      {"weights_property_per_mj", [](auto& h, double v) { h.weights_property_per_mj = v; }},
      {"people_ego", [](auto& h, double v) { h.people_ego = v; }},
      {"people_car", [](auto& h, double v) { h.people_car = v; }},
      {"people_truck", [](auto& h, double v) { h.people_truck = v; }},
      {"people_bus", [](auto& h, double v) { h.people_bus = v; }},
      {"pedestrian_age_years", [](auto& h, double v) { h.pedestrian_age_years = v; }},
      {"pedestrian_male_share", [](auto& h, double v) { h.pedestrian_male_share = v; }},
      {"friction", [](auto& h, double v) { h.friction = v; }},
      {"ranges_friction", [](auto& h, double v) { h.ranges_friction[1] = v; }},
      {"ranges_strength", [](auto& h, double v) { h.ranges_strength[0] = v; }},
      {"ranges_restitution", [](auto& h, double v) { h.ranges_restitution[1] = v; }},
      {"ranges_risk_speed", [](auto& h, double v) { h.ranges_risk_speed[1] = v; }},
  };
  for (const auto& [member, change] : members) {
    for (const double value : {double{NAN}, double{INFINITY}, 1e7}) {
      crashrank_harm bad = before;
      change(bad, value);
      crashrank_error error{};
      EXPECT_EQ(crashrank_scenario_set_harm(scenario.get(), &bad, &error), CRASHRANK_BAD_INPUT);
      EXPECT_NE(std::strstr(error.message, (std::string("crashrank_harm.") + member).c_str()),
                nullptr)
          << error.message;
    }
  }
  crashrank_error error{};
  crashrank_harm bad = before;
  bad.weights_cyclist = -1.0;
  EXPECT_EQ(crashrank_scenario_set_harm(scenario.get(), &bad, &error), CRASHRANK_BAD_INPUT);
  bad = before;
  std::swap(bad.ranges_friction[0], bad.ranges_friction[1]);
  EXPECT_EQ(crashrank_scenario_set_harm(scenario.get(), &bad, &error), CRASHRANK_BAD_INPUT);
  for (const int32_t value : {0, 5, -1, INT32_MAX}) {
    bad = before;
    bad.risk_model = value;
    EXPECT_EQ(crashrank_scenario_set_harm(scenario.get(), &bad, &error), CRASHRANK_USAGE);
    EXPECT_NE(std::strstr(error.message, "crashrank_harm.risk_model"), nullptr) << error.message;
    bad = before;
    bad.after_contact = value;
    EXPECT_EQ(crashrank_scenario_set_harm(scenario.get(), &bad, &error), CRASHRANK_USAGE);
    EXPECT_NE(std::strstr(error.message, "crashrank_harm.after_contact"), nullptr) << error.message;
  }
  EXPECT_EQ(crashrank_scenario_set_harm(scenario.get(), nullptr, &error), CRASHRANK_USAGE);
  EXPECT_NE(std::strstr(error.message, "harm: is NULL"), nullptr) << error.message;
  EXPECT_EQ(crashrank_scenario_get_harm(nullptr, &bad, &error), CRASHRANK_USAGE);
  EXPECT_NE(std::strstr(error.message, "scenario: is NULL"), nullptr) << error.message;
  const crashrank_harm after = harm_of(scenario.get());
  EXPECT_EQ(std::memcmp(&before, &after, sizeof before), 0);
}

TEST(CApi, AProfileIsLaidOverTheHarmOfTheScenario) {
  const std::string text =
      R"({"profile_version": 1, "risk_model": "malliaris-rosen", "weights": {"pedestrian": 4}})";
  const std::string file = testing::TempDir() + "/c_harm_profile.json";
  std::ofstream(file) << text;
  crashrank_error error{};
  for (const bool from_file : {true, false}) {
    const Scenario scenario = empty_scenario();
    crashrank_harm expected = harm_of(scenario.get());
    expected.weights_cyclist = 2.0;
    ASSERT_EQ(crashrank_scenario_set_harm(scenario.get(), &expected, &error), CRASHRANK_OK);
    const auto apply = [&](const std::string& words) {
      if (!from_file) {
        return crashrank_scenario_set_profile_from_text(scenario.get(), words.data(), words.size(),
                                                        "words", &error);
      }
      std::ofstream(file) << words;
      return crashrank_scenario_load_profile(scenario.get(), file.c_str(), &error);
    };
    ASSERT_EQ(apply(text), CRASHRANK_OK) << error.message;
    expected.weights_pedestrian = 4.0;
    expected.risk_model = CRASHRANK_RISK_MODEL_MALLIARIS_ROSEN;
    const crashrank_harm applied = harm_of(scenario.get());
    EXPECT_EQ(std::memcmp(&applied, &expected, sizeof expected), 0);

    EXPECT_EQ(apply(R"({"profile_version": 1, "weights": {"cyclist": -4}})"), CRASHRANK_BAD_INPUT);
    EXPECT_NE(std::strstr(error.message, "weights.cyclist"), nullptr) << error.message;
    EXPECT_EQ(apply(std::string((1 << 20) + 1, ' ')), CRASHRANK_LIMIT_EXCEEDED);
    const crashrank_harm kept = harm_of(scenario.get());
    EXPECT_EQ(std::memcmp(&kept, &expected, sizeof expected), 0);
  }
  std::remove(file.c_str());
  const Scenario scenario = empty_scenario();
  EXPECT_EQ(crashrank_scenario_load_profile(scenario.get(), file.c_str(), &error),
            CRASHRANK_NOT_FOUND);
  EXPECT_EQ(crashrank_scenario_load_profile(scenario.get(), nullptr, &error), CRASHRANK_USAGE);
  EXPECT_NE(std::strstr(error.message, "file: is NULL"), nullptr) << error.message;
}

}  // namespace

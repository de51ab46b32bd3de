#include "c/c_objects.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

using namespace c_objects;

namespace {

/// A struct of this library followed by members of a later one.
template <class Struct> struct Later {
  Struct known = sized<Struct>();
  double unknown[2] = {0.0, 0.0};
};

crashrank_actor box_at(double x_m) {
  auto actor = sized<crashrank_actor>();
  actor.name = "box";
  std::memcpy(actor.pose, identity, sizeof identity);
  actor.pose[3] = x_m;
  return actor;
}

Scenario boxes() {
  crashrank_error error{};
  crashrank_scenario* made = nullptr;
  EXPECT_EQ(crashrank_scenario_create("boxes", &made, &error), CRASHRANK_OK);
  EXPECT_EQ(crashrank_scenario_add_model(made, "box", CRASHRANK_KIND_CAR, 1500.0, &error),
            CRASHRANK_OK);
  auto ego = sized<crashrank_ego>();
  std::memcpy(ego.pose, identity, sizeof identity);
  ego.speed_mps = 10.0;
  EXPECT_EQ(crashrank_scenario_set_ego(made, &ego, &error), CRASHRANK_OK);
  const crashrank_actor actor = box_at(20.0);
  EXPECT_EQ(crashrank_scenario_add_actor(made, &actor, &error), CRASHRANK_OK);
  auto straight = sized<crashrank_candidate>();
  straight.name = "straight";
  EXPECT_EQ(crashrank_scenario_add_candidate(made, &straight, &error), CRASHRANK_OK);
  return Scenario(made);
}

/// Every size that no version of the struct has is refused, naming the struct.
template <class Struct, class Call>
void expect_sizes_are_checked(const std::string& type, Struct given, const Call& call) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{4}, sizeof(Struct) - 1,
                                 sizeof(Struct) + 3, std::size_t{4096}, SIZE_MAX}) {
    given.size = size;
    crashrank_error error{};
    EXPECT_EQ(call(&given, &error), CRASHRANK_USAGE) << type << ' ' << size;
    EXPECT_NE(std::strstr(error.message, (type + ".size: is").c_str()), nullptr) << error.message;
    EXPECT_NE(std::strstr(error.message, ("sizeof(" + type + ")").c_str()), nullptr)
        << error.message;
  }
}

TEST(CApi, SizesThatNoStructHasAreRefused) {
  const Scenario scenario = boxes();
  crashrank_scenario* s = scenario.get();
  const Models models = make_models();
  ASSERT_EQ(add_box(models.get()), CRASHRANK_OK);
  const crashrank_models* m = models.get();
  crashrank_ranking* answer = nullptr;
  ASSERT_EQ(crashrank_rank(s, m, nullptr, &answer, nullptr), CRASHRANK_OK);
  const Ranking ranking(answer);
  crashrank_ranker* prepared = nullptr;
  ASSERT_EQ(crashrank_ranker_create(s, m, nullptr, &prepared, nullptr), CRASHRANK_OK);
  const Ranker ranker(prepared);

  expect_sizes_are_checked("crashrank_body", sized<crashrank_body>(), [&](auto* b, auto* e) {
    return crashrank_scenario_set_body(s, 0, b, e);
  });
  expect_sizes_are_checked("crashrank_ego", sized<crashrank_ego>(),
                           [&](auto* g, auto* e) { return crashrank_scenario_set_ego(s, g, e); });
  expect_sizes_are_checked("crashrank_actor", box_at(9.0),
                           [&](auto* a, auto* e) { return crashrank_scenario_add_actor(s, a, e); });
  expect_sizes_are_checked(
      "crashrank_candidate", sized<crashrank_candidate>(),
      [&](auto* c, auto* e) { return crashrank_scenario_add_candidate(s, c, e); });
  expect_sizes_are_checked("crashrank_harm", sized<crashrank_harm>(),
                           [&](auto* h, auto* e) { return crashrank_scenario_get_harm(s, h, e); });
  expect_sizes_are_checked("crashrank_harm", sized<crashrank_harm>(),
                           [&](auto* h, auto* e) { return crashrank_scenario_set_harm(s, h, e); });
  crashrank_ranking* none = nullptr;
  expect_sizes_are_checked("crashrank_rank_options", sized<crashrank_rank_options>(),
                           [&](auto* o, auto* e) { return crashrank_rank(s, m, o, &none, e); });
  EXPECT_EQ(none, nullptr);
  expect_sizes_are_checked("crashrank_choice", sized<crashrank_choice>(), [&](auto* c, auto* e) {
    return crashrank_ranking_get(ranking.get(), 0, c, e);
  });
  auto asked = sized<crashrank_rank_options>();
  asked.motion = 1;
  ASSERT_EQ(crashrank_rank(s, m, &asked, &answer, nullptr), CRASHRANK_OK);
  const Ranking moved(answer);
  expect_sizes_are_checked(
      "crashrank_body_motion", sized<crashrank_body_motion>(),
      [&](auto* b, auto* e) { return crashrank_ranking_motion(moved.get(), 0, 0, b, e); });
  crashrank_ranker* no_ranker = nullptr;
  expect_sizes_are_checked(
      "crashrank_ranker_options", sized<crashrank_ranker_options>(),
      [&](auto* o, auto* e) { return crashrank_ranker_create(s, m, o, &no_ranker, e); });
  EXPECT_EQ(no_ranker, nullptr);
  auto full = sized<crashrank_answer>();
  expect_sizes_are_checked("crashrank_budget", sized<crashrank_budget>(), [&](auto* b, auto* e) {
    return crashrank_ranker_rank(ranker.get(), b, &full, e);
  });
  expect_sizes_are_checked("crashrank_answer", sized<crashrank_answer>(), [&](auto* a, auto* e) {
    return crashrank_ranker_rank(ranker.get(), nullptr, a, e);
  });
}

TEST(CApi, MembersThatASmallerStructLacksTakeTheirDefaults) {
  const Scenario scenario = boxes();
  crashrank_error error{};
  // What lies behind the caller's struct is not read.
  auto body = sized<crashrank_body>();
  body.size = offsetof(crashrank_body, stiffness);
  body.stiffness = -5.0;
  body.surface = 77;
  EXPECT_EQ(crashrank_scenario_set_body(scenario.get(), 0, &body, &error), CRASHRANK_OK)
      << error.message;
  crashrank_rank_options options{sizeof(std::size_t), 99, 1000, 1, 0, 99, 1, 1};
  const Models models = make_models();
  ASSERT_EQ(add_box(models.get()), CRASHRANK_OK);
  crashrank_ranking* answer = nullptr;
  ASSERT_EQ(crashrank_rank(scenario.get(), models.get(), &options, &answer, &error), CRASHRANK_OK)
      << error.message;
  const Ranking ranking(answer);
  EXPECT_EQ(crashrank_ranking_json(answer), nullptr);
  EXPECT_EQ(crashrank_ranking_motion_count(answer, 0), 0U);

  // Of harm: what the scenario has.
  auto harm = sized<crashrank_harm>();
  ASSERT_EQ(crashrank_scenario_get_harm(scenario.get(), &harm, &error), CRASHRANK_OK);
  harm.friction = 0.7;
  ASSERT_EQ(crashrank_scenario_set_harm(scenario.get(), &harm, &error), CRASHRANK_OK);
  crashrank_harm older = harm;
  older.size = offsetof(crashrank_harm, weights_pedestrian);
  older.weights_ego_occupant = 3.0;
  older.friction = -1.0;
  ASSERT_EQ(crashrank_scenario_set_harm(scenario.get(), &older, &error), CRASHRANK_OK)
      << error.message;
  ASSERT_EQ(crashrank_scenario_get_harm(scenario.get(), &harm, &error), CRASHRANK_OK);
  EXPECT_EQ(harm.weights_ego_occupant, 3.0);
  EXPECT_EQ(harm.friction, 0.7);
}

TEST(CApi, AnswersFillTheCallersStructAlone) {
  const Scenario scenario = boxes();
  const Models models = make_models();
  ASSERT_EQ(add_box(models.get()), CRASHRANK_OK);
  crashrank_ranking* answer = nullptr;
  ASSERT_EQ(crashrank_rank(scenario.get(), models.get(), nullptr, &answer, nullptr), CRASHRANK_OK);
  const Ranking ranking(answer);
  auto whole = sized<crashrank_choice>();
  ASSERT_EQ(crashrank_ranking_get(answer, 0, &whole, nullptr), CRASHRANK_OK);
  EXPECT_EQ(whole.size, sizeof whole);

  auto older = sized<crashrank_choice>();
  older.size = offsetof(crashrank_choice, delta_v_mps);
  older.delta_v_mps = 123.0;
  older.contacts = 456;
  ASSERT_EQ(crashrank_ranking_get(answer, 0, &older, nullptr), CRASHRANK_OK);
  EXPECT_EQ(older.size, offsetof(crashrank_choice, delta_v_mps));
  EXPECT_EQ(older.closing_speed_mps, whole.closing_speed_mps);
  EXPECT_EQ(older.delta_v_mps, 123.0);
  EXPECT_EQ(older.contacts, 456U);

  Later<crashrank_choice> later;
  later.known.size = sizeof later;
  later.unknown[1] = 5.0;
  ASSERT_EQ(crashrank_ranking_get(answer, 0, &later.known, nullptr), CRASHRANK_OK);
  EXPECT_EQ(later.known.size, sizeof later);
  EXPECT_EQ(later.known.delta_v_mps, whole.delta_v_mps);
  EXPECT_EQ(later.unknown[1], 0.0);
}

TEST(CApi, MembersOfLaterVersionsAreAcceptedWhileZero) {
  const Scenario scenario = boxes();
  crashrank_error error{};
  Later<crashrank_body> later;
  later.known.size = sizeof later;
  EXPECT_EQ(crashrank_scenario_set_body(scenario.get(), 0, &later.known, &error), CRASHRANK_OK)
      << error.message;
  later.unknown[1] = 1.0;
  EXPECT_EQ(crashrank_scenario_set_body(scenario.get(), 0, &later.known, &error), CRASHRANK_USAGE);
  EXPECT_NE(std::strstr(error.message, "crashrank_body: "), nullptr) << error.message;
}

TEST(CApi, ValuesHaveTheNamesOfScenarioFiles) {
  const auto names = [](const auto& name_of) {
    std::vector<std::string> all;
    for (int32_t value = 1; name_of(value) != nullptr; ++value) all.emplace_back(name_of(value));
    EXPECT_EQ(name_of(0), nullptr);
    EXPECT_EQ(name_of(-1), nullptr);
    EXPECT_EQ(name_of(INT32_MIN), nullptr);
    EXPECT_EQ(name_of(INT32_MAX), nullptr);
    return all;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(names(crashrank_body_kind_name), (Names{"car", "truck", "bus", "motorcycle", "bicycle",
                                                    "pedestrian", "barrier", "pole", "building"}));
  EXPECT_EQ(names(crashrank_surface_name),
            (Names{"sheet-metal", "steel", "concrete", "wood", "rubber", "person"}));
  EXPECT_EQ(names(crashrank_measure_name), (Names{"polygons", "area", "closing-energy", "delta-v",
                                                  "energy", "intrusion", "harm"}));
  EXPECT_EQ(names(crashrank_risk_model_name),
            (Names{"tum", "malliaris-monfort", "malliaris-rosen", "joksch-monfort"}));
  EXPECT_EQ(names(crashrank_after_contact_name), (Names{"brakes", "releases", "locks"}));
  EXPECT_STREQ(crashrank_body_kind_name(CRASHRANK_KIND_PEDESTRIAN), "pedestrian");
  EXPECT_STREQ(crashrank_surface_name(CRASHRANK_SURFACE_CONCRETE), "concrete");
  EXPECT_STREQ(crashrank_measure_name(CRASHRANK_MEASURE_DELTA_V), "delta-v");
}

TEST(CApi, WhatIsMissingOrOutOfRangeIsNamed) {
  const Scenario scenario = boxes();
  crashrank_scenario* s = scenario.get();
  const Models models = make_models();
  ASSERT_EQ(add_box(models.get()), CRASHRANK_OK);
  crashrank_error error{};
  const auto expect_named = [&](crashrank_status status, crashrank_status expected,
                                const char* name) {
    EXPECT_EQ(status, expected);
    EXPECT_NE(std::strstr(error.message, name), nullptr) << error.message;
  };
  crashrank_actor actor = box_at(30.0);
  actor.name = nullptr;
  expect_named(crashrank_scenario_add_actor(s, &actor, &error), CRASHRANK_USAGE,
               "crashrank_actor.name: is NULL");
  actor = box_at(NAN);
  expect_named(crashrank_scenario_add_actor(s, &actor, &error), CRASHRANK_BAD_INPUT,
               "crashrank_actor.pose: ");
  actor = box_at(30.0);
  actor.pose_count = 1;
  expect_named(crashrank_scenario_add_actor(s, &actor, &error), CRASHRANK_USAGE,
               "crashrank_actor.poses: is NULL");
  const crashrank_timed_pose shrunk{1.0, {0.5}};
  actor.poses = &shrunk;
  expect_named(crashrank_scenario_add_actor(s, &actor, &error), CRASHRANK_BAD_INPUT,
               "crashrank_actor.poses[0].pose: ");
  expect_named(crashrank_rank(s, nullptr, nullptr, nullptr, &error), CRASHRANK_USAGE,
               "models: is NULL");
  const auto expect_refused_by_rank = [&](const char* name) {
    crashrank_ranking* none = nullptr;
    expect_named(crashrank_rank(s, models.get(), nullptr, &none, &error), CRASHRANK_BAD_INPUT,
                 name);
  };
  for (const double bad : {double{NAN}, 0.0, 61.0}) {
    ASSERT_EQ(crashrank_scenario_set_horizon(s, bad, &error), CRASHRANK_OK);
    expect_refused_by_rank("horizon_s: ");
  }
  ASSERT_EQ(crashrank_scenario_set_horizon(s, 4.0, &error), CRASHRANK_OK);
  for (const double bad : {double{NAN}, 0.0, 3.1}) {
    ASSERT_EQ(crashrank_scenario_set_grip(s, bad, &error), CRASHRANK_OK);
    expect_refused_by_rank("grip: ");
  }
  ASSERT_EQ(crashrank_scenario_set_grip(s, 0.8, &error), CRASHRANK_OK);
  for (const double bad : {double{NAN}, 1001.0}) {
    ASSERT_EQ(crashrank_scenario_set_ego_occupants(s, bad, &error), CRASHRANK_OK);
    expect_refused_by_rank("ego.occupants: ");
  }
  expect_named(crashrank_scenario_set_horizon(nullptr, 1.0, &error), CRASHRANK_USAGE,
               "scenario: is NULL");
  expect_named(crashrank_scenario_set_grip(nullptr, 1.0, &error), CRASHRANK_USAGE,
               "scenario: is NULL");
}

}  // namespace

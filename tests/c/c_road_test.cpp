#include "c/c_objects.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <string>

using namespace c_objects;

namespace {

const std::string oncoming_file = CRASHRANK_SCENARIOS "/oncoming_truck.json";

struct Told {
  std::size_t index = 0;
  crashrank_manoeuvre manoeuvre{};
};

/// By candidate.
std::map<std::string, Told> manoeuvres_in_c(const Loaded& loaded,
                                            crashrank_infeasible infeasible = 0) {
  crashrank_error error{};
  auto options = sized<crashrank_rank_options>();
  options.infeasible = infeasible;
  crashrank_ranking* made = nullptr;
  EXPECT_EQ(crashrank_rank(loaded.scenario.get(), loaded.models.get(), &options, &made, &error),
            CRASHRANK_OK)
      << error.message;
  const Ranking ranking(made);
  std::map<std::string, Told> all;
  for (std::size_t i = 0; i < crashrank_ranking_size(made); ++i) {
    auto choice = sized<crashrank_choice>();
    auto manoeuvre = sized<crashrank_manoeuvre>();
    EXPECT_EQ(crashrank_ranking_get(made, i, &choice, &error), CRASHRANK_OK);
    EXPECT_EQ(crashrank_ranking_manoeuvre(made, i, &manoeuvre, &error), CRASHRANK_OK);
    all[choice.candidate] = {i, manoeuvre};
  }
  return all;
}

TEST(CRoad, LeavingItAndWeakBrakesAreTold) {
  const Loaded loaded = load(oncoming_file);
  for (const auto& [name, told] : manoeuvres_in_c(loaded)) {
    EXPECT_EQ(told.manoeuvre.feasible, 1) << name;
    EXPECT_EQ(told.manoeuvre.leaves_road, 0) << name;
    EXPECT_TRUE(std::isnan(told.manoeuvre.leaves_road_s)) << name;
    EXPECT_EQ(told.manoeuvre.least_distance_m, 0.0) << name;
    EXPECT_TRUE(std::isnan(told.manoeuvre.time_to_collision_s)) << name;
  }
  auto limits = sized<crashrank_ego_limits>();
  limits.max_deceleration_mps2 = 3.0;
  crashrank_scenario* scenario = loaded.scenario.get();
  ASSERT_EQ(crashrank_scenario_set_ego_limits(scenario, &limits, nullptr), CRASHRANK_OK);
  const auto braked = manoeuvres_in_c(loaded);
  const Told& brakes = braked.at("brake in lane");
  EXPECT_EQ(brakes.manoeuvre.feasible, 0);
  EXPECT_GT(brakes.manoeuvre.brakes_demand, 2.0);
  EXPECT_EQ(braked.at("coast into the barrier").manoeuvre.feasible, 1);
  EXPECT_LT(braked.at("left across the road").index, brakes.index);
  EXPECT_EQ(manoeuvres_in_c(loaded, CRASHRANK_INFEASIBLE_DROP).count("brake in lane"), 0U);
  EXPECT_EQ(manoeuvres_in_c(loaded, CRASHRANK_INFEASIBLE_KEEP).count("brake in lane"), 1U);
}

TEST(CRoad, AnAreaEndsWhereTheScenarioSays) {
  const Loaded loaded = load(oncoming_file);
  crashrank_scenario* scenario = loaded.scenario.get();
  const std::array<double, 8> lane{-50, -50, 12, -50, 12, 50, -50, 50};
  const std::array<double, 6> island{-40, 10, -30, 10, -30, 20};
  ASSERT_EQ(crashrank_scenario_add_area(scenario, lane.data(), 4, nullptr), CRASHRANK_OK);
  ASSERT_EQ(crashrank_scenario_add_hole(scenario, 0, island.data(), 3, nullptr), CRASHRANK_OK);
  ASSERT_EQ(crashrank_scenario_set_off_road(scenario, 0.01, 0.4, nullptr), CRASHRANK_OK);
  const auto left = manoeuvres_in_c(loaded);
  const crashrank_manoeuvre& ahead = left.at("brake in lane").manoeuvre;
  EXPECT_EQ(ahead.leaves_road, 1);
  EXPECT_GT(ahead.leaves_road_s, 0.0);
  EXPECT_GT(ahead.leaves_road_mps, 0.0);
  EXPECT_EQ(ahead.feasible, 0);  // beside the road the grip is half
}

TEST(CRoad, RefusesWhatItCannotRead) {
  const Loaded loaded = load(oncoming_file);
  crashrank_scenario* scenario = loaded.scenario.get();
  const std::array<double, 8> hourglass{0, 0, 9, 9, 9, 0, 0, 9};
  crashrank_error error{};
  EXPECT_EQ(crashrank_scenario_add_hole(scenario, 0, hourglass.data(), 4, &error), CRASHRANK_USAGE);
  EXPECT_EQ(crashrank_scenario_add_area(scenario, nullptr, 4, &error), CRASHRANK_USAGE);
  EXPECT_EQ(crashrank_scenario_add_area(scenario, hourglass.data(), 1'000'000, &error),
            CRASHRANK_USAGE);
  ASSERT_EQ(crashrank_scenario_add_area(scenario, hourglass.data(), 4, nullptr), CRASHRANK_OK);
  crashrank_ranking* made = nullptr;
  EXPECT_EQ(crashrank_rank(scenario, loaded.models.get(), nullptr, &made, &error),
            CRASHRANK_BAD_INPUT);
  EXPECT_NE(std::string(error.message).find("road.drivable[0].outer"), std::string::npos)
      << error.message;
}

}  // namespace

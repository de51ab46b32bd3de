#include "crashrank/rank/rank.hpp"

#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace crashrank {
namespace {

using scenes::car_and_wall;
using scenes::Scene;

TEST(Rank, AScenarioWithoutCandidatesIsRefused) {
  Scene scene = car_and_wall();
  scene.scenario.grid.reset();
  scene.scenario.add_straight_braking = false;
  const Result<RankResult> ranked = rank(scene.scenario, scene.models);
  ASSERT_FALSE(ranked.ok());
  EXPECT_EQ(ranked.error().code, ErrorCode::bad_input);
  EXPECT_EQ(ranked.error().place, "candidates");
}

TEST(Rank, ErrorsNameTheirPlace) {
  Scene scene = car_and_wall();
  scene.add_candidate("keep going", 0.0);
  scene.scenario.models[0].kind = BodyKind::pole;
  scene.scenario.models[0].mass_kg.reset();
  const Result<RankResult> immovable = rank(scene.scenario, scene.models);
  ASSERT_FALSE(immovable.ok());
  EXPECT_EQ(immovable.error().place, "models.car.mass_kg");
  EXPECT_EQ(immovable.error().code, ErrorCode::bad_input);

  const std::vector<Model> none;
  EXPECT_EQ(rank(scene.scenario, none).error().code, ErrorCode::usage);

  std::vector<Model> hollow(2);
  const Result<RankResult> empty = rank(scene.scenario, hollow);
  ASSERT_FALSE(empty.ok());
  EXPECT_EQ(empty.error().place, "models.car.mesh");

  scene.scenario.actors[0].model = 7;
  EXPECT_EQ(rank(scene.scenario, scene.models).error().code, ErrorCode::bad_input);
}

TEST(Rank, RangeErrorsStateTheRange) {
  Scene scene = car_and_wall();
  scene.add_candidate("keep going", 0.0);
  scene.scenario.actors[0].yaw_rate_radps = 20.0;
  const Result<RankResult> result = rank(scene.scenario, scene.models);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().place, "actors[0].yaw_rate_dps");
  EXPECT_EQ(result.error().reason, "is 1145.91559, out of range");
  EXPECT_EQ(result.error().remedy, "give a number from -720 to 720");
  RankOptions options;
  options.harm.emplace().step = 16.0;
  scene.scenario.actors[0].yaw_rate_radps = 0.0;
  EXPECT_EQ(rank(scene.scenario, scene.models, options).error().place, "harm.step");
}

TEST(Rank, ImpossibleMotionsOfActorsAreRefusedInEveryForm) {
  Scene scene = car_and_wall();
  scene.add_candidate("keep going", 0.0);
  ScenarioActor& actor = scene.scenario.actors[0];
  Pose away = actor.pose;
  away.translation.x() -= 400.0;
  // 400 m in 0.1 s: milliseconds used as seconds, or the tracks of two bodies merged.
  actor.poses = {{0.0, actor.pose}, {0.1, away}};
  Result<RankResult> result = rank(scene.scenario, scene.models);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().place, "actors[0] \"wall\"");
  EXPECT_EQ(result.error().reason, "its motion is faster than 300 m/s");
  actor.poses[1].time_s = 2.0;
  EXPECT_TRUE(rank(scene.scenario, scene.models).ok());
}

TEST(Rank, DuplicateNamesAreRefusedAndEmptyOnesAreNot) {
  Scene scene = car_and_wall();
  scene.add_candidate("keep going", 0.0);
  scene.add_candidate("keep going", -1.0);
  Result<RankResult> result = rank(scene.scenario, scene.models);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().place, "candidates.listed[1].name");
  for (ListedCandidate& candidate : scene.scenario.listed) candidate.name.clear();
  scene.scenario.actors.push_back(scene.scenario.actors[0]);
  result = rank(scene.scenario, scene.models);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().place, "actors[1].name");
  for (ScenarioActor& actor : scene.scenario.actors) actor.name.clear();
  EXPECT_TRUE(rank(scene.scenario, scene.models).ok());
}

TEST(Rank, AnActorIsNotNamedAsTheEgoIsInAnswers) {
  Scene scene = car_and_wall();
  scene.add_candidate("keep going", 0.0);
  scene.add_actor("ego", 0, 20.0, 30.0);
  const Result<RankResult> result = rank(scene.scenario, scene.models);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, ErrorCode::bad_input);
  EXPECT_EQ(result.error().place, "actors[1].name");
  EXPECT_FALSE(result.error().remedy.empty());
  for (const char* const other : {"Ego", "ego 2", "the ego"}) {
    scene.scenario.actors.back().name = other;
    EXPECT_TRUE(rank(scene.scenario, scene.models).ok()) << other;
  }
}

TEST(Rank, NumbersOutOfRangeAreRefused) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double inf = std::numeric_limits<double>::infinity();
  const auto place_after = [](auto&& spoil) {
    Scene scene = car_and_wall();
    scene.add_candidate("keep going", 0.0);
    spoil(scene.scenario);
    const Result<RankResult> result = rank(scene.scenario, scene.models);
    EXPECT_FALSE(result.ok());
    return result.ok() ? std::string() : result.error().place;
  };
  for (const double bad : {nan, inf, -inf}) {
    EXPECT_EQ(place_after([&](Scenario& s) { s.ego.speed_mps = bad; }), "ego.speed_mps");
    EXPECT_EQ(place_after([&](Scenario& s) { s.ego.pose.translation.y() = bad; }), "ego.pose");
    EXPECT_EQ(place_after([&](Scenario& s) { s.actors[0].pose.rotation(1, 1) = bad; }),
              "actors[0].pose");
    EXPECT_EQ(place_after([&](Scenario& s) { s.actors[0].acceleration_mps2 = bad; }),
              "actors[0].acceleration_mps2");
    EXPECT_EQ(place_after([&](Scenario& s) { s.listed[0].steering_rad = bad; }),
              "candidates.listed[0].steering_deg");
    EXPECT_EQ(place_after([&](Scenario& s) { s.horizon_s = bad; }), "horizon_s");
    EXPECT_EQ(place_after([&](Scenario& s) { s.models[0].mass_kg = bad; }), "models.car.mass_kg");
    EXPECT_EQ(place_after([&](Scenario& s) { s.grip = bad; }), "grip");
  }
  EXPECT_EQ(place_after([](Scenario& s) { s.ego.pose.translation.y() = 2e5; }), "ego.pose.y_m");
  EXPECT_EQ(place_after([](Scenario& s) { s.models[0].mass_kg = 0.0; }), "models.car.mass_kg");
  EXPECT_EQ(place_after([](Scenario& s) { s.horizon_s = 0.0; }), "horizon_s");
  EXPECT_EQ(place_after([](Scenario& s) { s.grid = CandidateGrid{0, 3}; }), "candidates.grid");
  EXPECT_EQ(place_after([](Scenario& s) {
              s.grid = CandidateGrid{1000, 1000};
            }),
            "candidates.grid");
  EXPECT_EQ(place_after([](Scenario& s) {
              s.actors[0].poses = {{1.0, {}}, {0.5, {}}};
            }).rfind("actors[0] \"wall\".poses", 0),
            0U);
}

}  // namespace
}  // namespace crashrank

#include "crashrank/rank/anytime/ranker.hpp"

#include "oracle/random.hpp"
#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

namespace {

using namespace crashrank;
using scenes::box_mesh;
using scenes::of;
using scenes::Scene;

/// A car of 4 × 2 m at the origin with axles at 1/5 and 4/5 of its length and a track of 0.86 of
/// its width.
constexpr double axle_m = 1.2;
constexpr double wheel_m = 0.86;

Area rectangle(double low_x, double low_y, double high_x, double high_y) {
  return {{{low_x, low_y}, {high_x, low_y}, {high_x, high_y}, {low_x, high_y}}, {}};
}

Scene on_road(double speed_mps, Area area) {
  Scene scene;
  scene.scenario.measure = Measure::harm;
  scene.scenario.ego.model =
      scene.add_model("car", box_mesh({2, 1, 0.7F}, 1, {0, 0, 0.75F}), BodyKind::car, 1500.0);
  scene.scenario.ego.speed_mps = speed_mps;
  scene.scenario.road.drivable = {std::move(area)};
  return scene;
}

TEST(RoadLeaving, BeginsWithTheFirstWheel) {
  Scene scene = on_road(20.0, rectangle(-10, -3, 30, 3));
  scene.add_candidate("keeps going", 0.0);
  scene.add_candidate("brakes", -7.5);
  const RankResult result = scene.ranked();
  const CandidateResult& going = of(result, "keeps going");
  ASSERT_TRUE(going.leaves_road.has_value());
  EXPECT_NEAR(going.leaves_road->time_s, (30.05 - axle_m) / 20.0, 1e-6);
  EXPECT_NEAR(going.leaves_road->speed_mps, 20.0, 1e-9);
  EXPECT_NEAR(going.leaves_road->point_m.x(), 30.05, 1e-5);
  EXPECT_NEAR(std::abs(going.leaves_road->point_m.y()), wheel_m, 1e-6);
  EXPECT_FALSE(of(result, "brakes").leaves_road.has_value());
  // Neither has a contact: the one that stays on the road is first.
  EXPECT_EQ(of(result, "brakes").place, 1U);
}

TEST(RoadLeaving, IsFoundOnRandomPaths) {
  int leaving = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    oracle::Random random(seed);
    Area area = rectangle(-10, -random.real(2, 8), random.real(50, 100), random.real(2, 8));
    const double x = random.real(12, 40);
    area.holes.push_back({{x, -1.5}, {x + 3, -1.5}, {x + 3, random.real(-1, 1.5)}, {x, 0.5}});
    Scene scene = on_road(random.real(3.0, 40.0), area);
    scene.add_candidate("steers", random.real(-6.0, 3.0), random.real(-0.1, 0.1));
    const RankResult result = scene.ranked();
    const CandidateResult& ranked = result.ranking.front();
    const Motion& motion = result.candidates[0].motion;
    std::optional<double> expected;
    for (double t = 0.0; t <= 4.0 && !expected; t += 1e-3) {
      const Pose pose = motion.pose_at(t);
      for (const double side_x : {axle_m, -axle_m}) {
        for (const double side_y : {wheel_m, -wheel_m}) {
          const Eigen::Vector3d at =
              pose.rotation * Eigen::Vector3d(side_x, side_y, 0.0) + pose.translation;
          const View<const Area> areas(scene.scenario.road.drivable);
          if (!holds(areas, at.head<2>()) && distance_to_border_m(areas, at.head<2>()) > 0.05) {
            expected = t;
          }
        }
      }
    }
    ASSERT_EQ(ranked.leaves_road.has_value(), expected.has_value());
    if (!expected) continue;
    ++leaving;
    EXPECT_NEAR(ranked.leaves_road->time_s, *expected, 1.1e-3);
  }
  EXPECT_GT(leaving, 20);
}

TEST(RoadLeaving, ASeamOfTheMapIsNoEdge) {
  Scene scene = on_road(20.0, rectangle(-10, -3, 20, 3));
  scene.scenario.road.drivable.push_back(rectangle(20.08, -3, 200, 3));
  scene.add_candidate("keeps going", 0.0);
  EXPECT_FALSE(scene.ranked().ranking.front().leaves_road.has_value());
  scene.scenario.road.drivable[1] = rectangle(20.4, -3, 200, 3);
  EXPECT_TRUE(scene.ranked().ranking.front().leaves_road.has_value());
}

TEST(RoadLeaving, AddsTheStatedHarmUnlessAContactComesFirst) {
  Scene scene = on_road(20.0, rectangle(-10, -3, 30, 3));
  scene.scenario.road.harm_per_leaving = 0.125;
  scene.add_candidate("keeps going", 0.0);
  scene.add_candidate("brakes", -7.5);
  RankResult result = scene.ranked();
  EXPECT_EQ(of(result, "keeps going").score, 0.125);
  EXPECT_EQ(of(result, "keeps going").score_interval.lowest, 0.125);
  EXPECT_EQ(of(result, "brakes").score, 0.0);
  EXPECT_EQ(*scene.ranked(Measure::energy).ranking.back().score, 0.0);
  const std::size_t wall =
      scene.add_model("wall", box_mesh({0.5F, 8, 1}, 1, {0, 0, 1}), BodyKind::barrier);
  // Behind and before the end of the road.
  for (const auto& [wall_x, left] : {std::pair(45.0, true), std::pair(25.0, false)}) {
    scene.scenario.actors.clear();
    scene.add_actor("wall", wall, wall_x, 0.0);
    result = scene.ranked();
    const double with = *of(result, "keeps going").score;
    EXPECT_EQ(of(result, "keeps going").leaves_road.has_value(), left);
    scene.scenario.road.harm_per_leaving = 0.0;
    const double without = *of(scene.ranked(), "keeps going").score;
    scene.scenario.road.harm_per_leaving = 0.125;
    EXPECT_NEAR(with - without, left ? 0.125 : 0.0, 1e-12);
  }
}

// A wall before the end of the road exists with that probability; a Ranker answers alike.
TEST(RoadLeaving, IsToldInAnyFuture) {
  for (const double exists : {0.25, 0.75, 1.0}) {
    Scene scene = on_road(20.0, rectangle(-10, -3, 30, 3));
    scene.scenario.road.harm_per_leaving = 0.125;
    scene.add_candidate("keeps going", 0.0);
    const std::size_t wall =
        scene.add_model("wall", box_mesh({0.5F, 8, 1}, 1, {0, 0, 1}), BodyKind::barrier);
    scene.add_actor("wall", wall, 25.0, 0.0).existence_probability = exists;
    const RankResult result = scene.ranked();
    const CandidateResult& going = result.ranking.front();
    EXPECT_EQ(going.leaves_road.has_value(), exists < 1.0);
    double leaves = 0.0;
    for (const FutureOutcome& future : going.futures) {
      EXPECT_NE(future.leaves_road, future.collides);
      if (future.leaves_road) leaves += future.probability;
    }
    EXPECT_DOUBLE_EQ(leaves, 1.0 - exists);
    RankerOptions options;
    Result<Ranker> ranker = Ranker::prepare(scene.scenario, scene.models, options);
    ASSERT_TRUE(ranker.ok());
    const RankerAnswer answer = ranker->rank(result.candidates);
    EXPECT_EQ(answer.ranking[0].leaves_road, exists < 1.0);
  }
}

TEST(RoadLeaving, OffRoadGripLimitsTheDemand) {
  Scene scene = on_road(20.0, rectangle(-10, -3, 20, 3));
  scene.scenario.road.off_road_grip = 0.3;
  scene.add_candidate("brakes", -7.5);
  const CandidateResult ranked = scene.ranked().ranking.front();
  ASSERT_TRUE(ranked.leaves_road.has_value());
  EXPECT_FALSE(ranked.feasible);
  EXPECT_NEAR(ranked.demand.brakes, 7.5 / (0.3 * standard_gravity_mps2), 1e-12);
  scene.scenario.road.off_road_grip.reset();
  EXPECT_TRUE(scene.ranked().ranking.front().feasible);
}

}  // namespace

#include "crashrank/scenario/candidate.hpp"
#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <numbers>

namespace crashrank {
namespace {

using scenes::box_mesh;
using scenes::of;
using scenes::Scene;

/// What follows the impact of a long scrape is no more than hard braking, and whether the car loses
/// touch with the wall for a moment changes little.
TEST(Scrape, AFasterScrapeAlongAWallIsHardlyMilder) {
  for (const double angle_deg : {10.0, 15.0, 20.0, 30.0, 45.0}) {
    Scene scene = scenes::car_on_road(0.8);
    const std::size_t wall = scene.add_model(
        "wall", box_mesh({30.0F, 0.2F, 1.2F}, 30, {20, -0.2F, 1.2F}), BodyKind::building);
    scene.add_actor("wall", wall, 14.0, 0.0, angle_deg * std::numbers::pi / 180.0);
    double most = 0.0;
    double deepest = 0.0;
    for (double speed = 8.0; speed <= 26.0; speed += 1.0) {
      scene.scenario.ego.speed_mps = speed;
      const double score = *of(scene.ranked(), "on").score;
      deepest = std::max(deepest, most - score);
      most = std::max(most, score);
    }
    std::printf("%g degrees: %.4f persons at most, deepest fall %.4f\n", angle_deg, most, deepest);
    EXPECT_GT(most, 0.02);
    EXPECT_LT(deepest, 0.005) << angle_deg << " degrees";
  }
}

// Scraping along a barrier decelerates a car less than its brakes do; hitting it at an angle
// decelerates it more.
TEST(Scrape, HarmOfAScrapeRisesWithTheAngle) {
  double last = 0.0;
  for (const double angle_deg : {3.0, 8.0, 15.0, 30.0}) {
    Scene scene = scenes::car_on_road(0.8);
    const double yaw = angle_deg * std::numbers::pi / 180.0;
    scene.scenario.ego.pose = pose_from_angles({0, 0, 0}, yaw, 0.0, 0.0);
    const std::size_t wall =
        scene.add_model("wall", box_mesh({200.0F, 0.25F, 1.0F}), BodyKind::barrier, {});
    scene.add_actor("wall", wall, 190.0, 4.0);
    const RankResult result = scene.ranked();
    const CandidateResult& on = of(result, "on");
    ASSERT_FALSE(on.contacts.empty()) << angle_deg;
    EXPECT_GT(*on.score, last) << angle_deg;
    last = *on.score;
  }
}

}  // namespace
}  // namespace crashrank

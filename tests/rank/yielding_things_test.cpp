#include "crashrank/vehicle/vehicle.hpp"
#include "rank/random_scene.hpp"
#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>

// Posts that break away and rails that deflect, as scenarios state them.

namespace crashrank {
namespace {

using scenes::box_mesh;
using scenes::car_on_road;
using scenes::of;
using scenes::same_bits;
using scenes::Scene;

/// A car of 1,000 kg at 16 m/s before a post.
Scene car_and_post() {
  Scene scene = car_on_road(0.8);
  scene.scenario.harm.intervals = false;
  const std::size_t post =
      scene.add_model("post", scenes::round_mesh(0.08F, 3.0F, 12), BodyKind::pole);
  scene.add_actor("post", post, 15.0, 0.2);
  return scene;
}

ScenarioModel& last_model(Scene& scene) { return scene.scenario.models.back(); }

double harm_of(const Scene& scene) { return of(scene.ranked(), "on").score.value(); }

Error error_of(const Scene& scene) {
  const Result<RankResult> result = rank(scene.scenario, scene.models);
  return result ? Error{} : result.error();
}

TEST(YieldingThings, APostThatNothingBreaksRanksAsARigidOneToTheBit) {
  const Scene rigid = car_and_post();
  Scene strong = car_and_post();
  last_model(strong).mass_kg = 100.0;
  last_model(strong).breakaway = Breakaway{1e9};
  EXPECT_TRUE(same_bits(harm_of(strong), harm_of(rigid)));
}

TEST(YieldingThings, APostThatBreaksAwayIsHitWithLessHarmAndDeltaV) {
  const Scene rigid = car_and_post();
  Scene post = car_and_post();
  last_model(post).mass_kg = 20.0;
  last_model(post).breakaway = Breakaway{1e9, 3800.0};
  EXPECT_LT(harm_of(post), 0.1 * harm_of(rigid));
  const RankResult result = post.ranked();
  ASSERT_FALSE(of(result, "on").contacts.empty());
  const ContactSeverity& severity = of(result, "on").contacts.front().severity;
  EXPECT_LT(severity.ego.delta_v_mps, 3.0);
  EXPECT_GT(severity.other.delta_v_mps, severity.ego.delta_v_mps);
}

/// The post flies into a person behind it.
TEST(YieldingThings, APostThatBrokeAwayHitsOthers) {
  Scene scene = car_and_post();
  last_model(scene).mass_kg = 60.0;
  last_model(scene).breakaway = Breakaway{20e3};
  const std::size_t person =
      scene.add_model("person", scenes::round_mesh(0.25F, 1.75F, 12), BodyKind::pedestrian);
  scene.add_actor("person", person, 15.6, 0.2);
  const RankResult result = scene.ranked();
  bool hit = false;
  for (const FurtherContact& contact : of(result, "on").further) {
    hit = hit || (contact.a == 0 && contact.b == 1) || (contact.a == 1 && contact.b == 0);
  }
  EXPECT_TRUE(hit);
}

/// A car at 20 degrees into a rail of parts.
double rail_delta_v(int parts, double deflection_m) {
  Scene scene = car_on_road(0.8);
  scene.scenario.harm.intervals = false;
  scene.scenario.ego.speed_mps = 25.0;
  scene.scenario.ego.pose = pose_from_angles({0, 0, 0}, 0.35, 0, 0);
  const float half_m = 24.0F / static_cast<float>(parts);
  const std::size_t part =
      scene.add_model("part", box_mesh({half_m, 0.15F, 0.4F}, 2, {0, 0, 0.4F}), BodyKind::barrier);
  last_model(scene).surface = Surface::steel;
  last_model(scene).deflection_m = deflection_m;
  for (int i = 0; i < parts; ++i) {
    scene.add_actor("part " + std::to_string(i), part,
                    -10.0 + static_cast<double>(half_m) * (2 * i + 1), 3.5);
  }
  return of(scene.ranked(Measure::delta_v), "on").score.value();
}

TEST(YieldingThings, ARailInPartsDeflectsAsOne) {
  for (const double deflection_m : {0.5, 1.0}) {
    const double whole = rail_delta_v(1, deflection_m);
    EXPECT_NEAR(rail_delta_v(12, deflection_m) / whole, 1.0, 0.1) << deflection_m;
  }
}

TEST(YieldingThings, RefusalsNameTheKey) {
  Scene scene = car_and_post();
  last_model(scene).breakaway = Breakaway{25e3};
  EXPECT_EQ(error_of(scene).place, "models.post.mass_kg");
  EXPECT_EQ(error_of(scene).reason, "is missing, but the body breaks away");
  last_model(scene).mass_kg = 100.0;
  EXPECT_EQ(error_of(scene).place, "");
  last_model(scene).deflection_m = 0.5;
  EXPECT_EQ(error_of(scene).place, "models.post.deflection_m");
  EXPECT_EQ(error_of(scene).reason, "belongs to a body with a mass");
  last_model(scene).deflection_m = 0.0;
  last_model(scene).breakaway = Breakaway{};
  EXPECT_EQ(error_of(scene).place, "models.post.breakaway.force_n");
  last_model(scene).breakaway = Breakaway{25e3};
  scene.scenario.models[scene.scenario.ego.model].breakaway = Breakaway{25e3};
  EXPECT_EQ(error_of(scene).place, "models.car.breakaway");
  EXPECT_EQ(error_of(scene).reason, "belongs to the ego, which moves");
}

TEST(YieldingThings, APostHasNoErrorOfPerceptionAndOnePose) {
  Scene scene = car_and_post();
  last_model(scene).mass_kg = 100.0;
  last_model(scene).breakaway = Breakaway{25e3};
  scene.scenario.actors[0].perception.position_m = 0.1;
  EXPECT_EQ(error_of(scene).reason, "belongs to a fixed body");
  // Nor has it any where all moving bodies get small ones.
  scene.scenario.actors[0].perception = {};
  RankOptions smooth;
  smooth.smooth = true;
  EXPECT_TRUE(of(scene.ranked(smooth), "on").score.has_value());
}

}  // namespace
}  // namespace crashrank

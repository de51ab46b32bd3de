#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace crashrank {
namespace {

using scenes::box_mesh;
using scenes::of;
using scenes::Scene;

constexpr double speed_mps = 16.0;

TriangleMesh car_mesh() { return box_mesh({2.0F, 0.9F, 0.7F}, 6, {0, 0, 0.7F}); }

/// An ego of 1000 kg at 16 m/s on a straight road.
Scene road() {
  Scene scene;
  scene.scenario.ego.model = scene.add_model("car", car_mesh(), BodyKind::car, 1000.0);
  scene.scenario.ego.speed_mps = speed_mps;
  scene.scenario.horizon_s = 6.0;
  scene.scenario.measure = Measure::harm;
  scene.scenario.harm.after.deceleration_mps2 = 0.0;
  scene.add_candidate("on", 0.0);
  return scene;
}

TEST(Aftermath, AChainOfEqualMassesHalvesTheSpeedEachTime) {
  Scene scene = road();
  for (const double x : {10.0, 20.0, 30.0}) {
    scene.add_actor("car at " + std::to_string(x), scene.scenario.ego.model, x, 0.0);
  }
  const RankResult result = scene.ranked();
  const CandidateResult& on = of(result, "on");
  ASSERT_GE(on.contacts.size(), 2U);
  // Equal masses share their momentum, and part by a restitution of at most 0.35: what is left is
  // half of the closing speed, less half of the rebound.
  double left = speed_mps;
  double harm = 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < on.contacts.size(); ++i) {
    const Contact& contact = on.contacts[i];
    EXPECT_EQ(contact.actor, i);
    EXPECT_NEAR(contact.closing_speed_mps, left, 0.02 * speed_mps);
    const double delta_v = contact.severity.ego.delta_v_mps;
    EXPECT_GE(delta_v, 0.49 * left);
    EXPECT_LE(delta_v, 0.5 * 1.35 * left);
    EXPECT_NEAR(contact.severity.other.delta_v_mps, delta_v, 1e-9);
    EXPECT_EQ(contact.event, i + 1);
    harm += contact.severity.harm;
    sum += delta_v;
    left -= delta_v;
  }
  EXPECT_NEAR(*on.score, harm, 1e-12);
  const RankResult delta_v = scene.ranked(Measure::delta_v);
  EXPECT_NEAR(*of(delta_v, "on").score, sum, 1e-9);
}

TEST(Aftermath, FollowingEndsWhereTheOptionsSay) {
  Scene scene = road();
  for (const double x : {10.0, 20.0, 30.0}) {
    scene.add_actor("car at " + std::to_string(x), scene.scenario.ego.model, x, 0.0);
  }
  scene.scenario.harm.after.most_contacts = 1;
  EXPECT_EQ(of(scene.ranked(), "on").contacts.size(), 1U);
  scene.scenario.harm.after.most_contacts = 2;
  EXPECT_EQ(of(scene.ranked(), "on").contacts.size(), 2U);
  scene.scenario.harm.after.most_contacts = 4;
  scene.scenario.harm.after.longest_s = 0.2;
  EXPECT_EQ(of(scene.ranked(), "on").contacts.size(), 1U);
  // Measures that do not simulate the crash do not follow it either.
  EXPECT_EQ(of(scene.ranked(Measure::area), "on").contacts.size(), 1U);
}

TEST(Aftermath, TheWayToTheNextIsBraked) {
  constexpr double deceleration = 4.0;
  Scene scene = road();
  scene.scenario.harm.after.deceleration_mps2 = deceleration;
  scene.add_actor("car", scene.scenario.ego.model, 10.0, 0.0);
  scene.add_actor("second", scene.scenario.ego.model, 15.0, 0.0);
  const RankResult result = scene.ranked();
  const CandidateResult& on = of(result, "on");
  ASSERT_EQ(on.contacts.size(), 2U);
  const double left = speed_mps - on.contacts[0].severity.ego.delta_v_mps;
  // The crash itself takes some of the 5 m.
  const double closing = on.contacts[1].closing_speed_mps;
  EXPECT_GE(closing, std::sqrt(std::max(0.0, left * left - 2 * deceleration * 5.0)) - 0.3);
  EXPECT_LE(closing, std::sqrt(left * left - 2 * deceleration * 3.0) + 0.3);
  // 8 m/s last for 8 m at that deceleration.
  scene.scenario.actors[1].pose.translation.x() = 24.0;
  EXPECT_EQ(of(scene.ranked(), "on").contacts.size(), 1U);
}

TEST(Aftermath, GlancingACarThenAPole) {
  Scene scene = road();
  const std::size_t pole =
      scene.add_model("pole", box_mesh({0.15F, 0.15F, 2.0F}, 2, {0, 0, 2}), BodyKind::pole);
  scene.add_actor("parked", scene.scenario.ego.model, 10.0, 1.75);
  scene.add_actor("pole", pole, 22.0, -0.3);
  const RankResult result = scene.ranked();
  const CandidateResult& on = of(result, "on");
  ASSERT_EQ(on.contacts.size(), 2U);
  const Contact& glance = on.contacts[0];
  const Contact& stop = on.contacts[1];
  EXPECT_EQ(glance.actor, 0U);
  EXPECT_EQ(stop.actor, 1U);
  EXPECT_GT(glance.severity.ego.delta_v_mps, 0.3);
  EXPECT_LT(glance.severity.ego.delta_v_mps, 0.6 * speed_mps);
  // What the first takes off the second has not.
  const double left =
      std::hypot(speed_mps + glance.severity.ego.delta_v_x_mps, glance.severity.ego.delta_v_y_mps);
  // Points of a body that turns are faster or slower than its middle.
  EXPECT_NEAR(stop.closing_speed_mps, left, 0.12 * speed_mps);
  EXPECT_GT(stop.severity.ego.delta_v_mps, glance.severity.ego.delta_v_mps);
  EXPECT_NEAR(*on.score, glance.severity.harm + stop.severity.harm, 1e-12);
}

TEST(Aftermath, TwoMetAtOnceAreTakenInTurn) {
  Scene scene = road();
  scene.add_actor("left", scene.scenario.ego.model, 10.0, 0.95);
  scene.add_actor("right", scene.scenario.ego.model, 10.0, -0.95);
  const RankResult result = scene.ranked();
  const CandidateResult& on = of(result, "on");
  ASSERT_EQ(on.contacts.size(), 2U);
  EXPECT_NEAR(on.contacts[1].time_of_impact_s, on.contacts[0].time_of_impact_s, 2e-3);
  // Each crash by itself conserves momentum between equal masses.
  for (const Contact& contact : on.contacts) {
    EXPECT_NEAR(contact.severity.ego.delta_v_mps, contact.severity.other.delta_v_mps, 1e-9);
  }
  EXPECT_LT(on.contacts[1].severity.ego.delta_v_mps, on.contacts[0].severity.ego.delta_v_mps);
  // The second is met before the first has slowed the ego: at the speed of that moment.
  EXPECT_GT(on.contacts[1].closing_speed_mps, 0.9 * speed_mps);
}

TEST(Aftermath, MirrorImagesScoreAlike) {
  const auto score = [](double side) {
    Scene scene = road();
    const std::size_t person = scene.add_model(
        "person", box_mesh({0.2F, 0.3F, 0.85F}, 2, {0, 0, 0.85F}), BodyKind::pedestrian);
    scene.add_actor("car", scene.scenario.ego.model, 10.0, side * 1.2, side * 0.3);
    scene.add_actor("person", person, 16.0, side * -1.0);
    return of(scene.ranked(), "on");
  };
  const CandidateResult left = score(1.0);
  const CandidateResult right = score(-1.0);
  ASSERT_EQ(left.contacts.size(), right.contacts.size());
  EXPECT_NEAR(*left.score, *right.score, 0.05 * *left.score);
  for (std::size_t i = 0; i < left.contacts.size(); ++i) {
    EXPECT_EQ(left.contacts[i].actor, right.contacts[i].actor);
  }
  const BodyOutcome& l = left.contacts[0].severity.ego;
  const BodyOutcome& r = right.contacts[0].severity.ego;
  EXPECT_NEAR(l.delta_v_x_mps, r.delta_v_x_mps, 0.03 * speed_mps);
  EXPECT_NEAR(l.delta_v_y_mps, -r.delta_v_y_mps, 0.03 * speed_mps);
  EXPECT_NEAR(l.yaw_rate_change_radps, -r.yaw_rate_change_radps, 0.3);
}

TEST(Aftermath, HarmAtTheLimitsOfTheMassRatio) {
  const auto crash = [](double other_kg, BodyKind kind) {
    Scene scene = road();
    scene.scenario.harm.after.most_contacts = 1;
    const std::size_t model = scene.add_model("other", car_mesh(), kind, other_kg);
    scene.add_actor("other", model, 10.0, 0.0);
    return of(scene.ranked(), "on").contacts.front().severity;
  };
  Exposure all;
  all.delta_v_mps = speed_mps;
  const double certain = injury_risk(RiskModel::tum, all);
  const ContactSeverity feather = crash(1.0, BodyKind::car);
  EXPECT_LT(feather.ego.harm, 1e-4);
  // All of it, and the rebound.
  EXPECT_GE(feather.other.delta_v_mps, 0.98 * speed_mps);
  EXPECT_LE(feather.other.delta_v_mps, 1.4 * speed_mps);
  const ContactSeverity truck = crash(25000.0, BodyKind::truck);
  EXPECT_GE(truck.ego.delta_v_mps, 0.98 * speed_mps * 25.0 / 26.0);
  EXPECT_LE(truck.ego.delta_v_mps, 1.4 * speed_mps * 25.0 / 26.0);
  EXPECT_NEAR(truck.other.delta_v_mps, truck.ego.delta_v_mps / 25.0, 1e-9);
  EXPECT_GT(truck.ego.harm, 5.0 * truck.other.harm);
  const ContactSeverity mountain = crash(1e6, BodyKind::truck);
  EXPECT_GE(mountain.ego.harm, 0.95 * certain);
  all.delta_v_mps = 1.4 * speed_mps;
  EXPECT_LE(mountain.ego.harm, injury_risk(RiskModel::tum, all));
}

TEST(Aftermath, WithoutOverlapThereIsNoHarm) {
  Scene scene = road();
  scene.add_actor("beside", scene.scenario.ego.model, 10.0, 1.85);
  const RankResult result = scene.ranked();
  EXPECT_FALSE(of(result, "on").collides);
  EXPECT_EQ(*of(result, "on").score, 0.0);
}

TEST(Aftermath, PeopleOutsideCarsHaveNoCage) {
  for (const BodyKind kind : {BodyKind::pedestrian, BodyKind::bicycle, BodyKind::motorcycle}) {
    Scene scene = road();
    const std::size_t person =
        scene.add_model("person", box_mesh({0.3F, 0.3F, 0.85F}, 2, {0, 0, 0.85F}), kind, 80.0);
    scene.add_actor("person", person, 10.0, 0.0);
    const RankResult result = scene.ranked(Measure::intrusion);
    const ContactSeverity& hit = of(result, "on").contacts.front().severity;
    EXPECT_GT(hit.other.crush_m, 0.05);
    EXPECT_EQ(hit.other.intrusion_m, 0.0);
  }
  Scene scene = road();
  scene.scenario.ego.speed_mps = 55.0;
  const std::size_t wall =
      scene.add_model("wall", box_mesh({0.5F, 3.0F, 1.0F}, 2, {0, 0, 1}), BodyKind::building);
  scene.add_actor("wall", wall, 10.0, 0.0);
  const RankResult into_wall = scene.ranked(Measure::intrusion);
  EXPECT_GT(of(into_wall, "on").contacts.front().severity.ego.intrusion_m, 0.0);
}

TEST(Aftermath, TheBonnetsHeightIsThatOfTheMesh) {
  const auto risk = [](float half_height) {
    Scene scene = road();
    const std::size_t vehicle =
        scene.add_model("vehicle", box_mesh({2.0F, 0.9F, half_height}, 8, {0, 0, half_height}),
                        BodyKind::car, 1000.0);
    const std::size_t person = scene.add_model(
        "person", box_mesh({0.2F, 0.3F, 0.85F}, 2, {0, 0, 0.85F}), BodyKind::pedestrian);
    scene.scenario.ego.model = vehicle;
    scene.scenario.ego.speed_mps = 11.0;
    scene.scenario.harm.model = RiskModel::malliaris_monfort;
    scene.add_actor("person", person, 10.0, 0.0);
    return of(scene.ranked(), "on").contacts.front().severity.other.harm;
  };
  // The same speed and mass, the bonnet's edge 0.8 m and 1.1 m over the ground.
  Exposure e;
  e.person = Person::pedestrian;
  e.impact_speed_mps = 11.0;
  e.leading_edge_m = 0.8;
  EXPECT_NEAR(risk(0.4F), injury_risk(RiskModel::malliaris_monfort, e), 0.03);
  e.leading_edge_m = 1.1;
  EXPECT_NEAR(risk(0.55F), injury_risk(RiskModel::malliaris_monfort, e), 0.03);
  EXPECT_GT(risk(0.55F), 1.1 * risk(0.4F));
}

}  // namespace
}  // namespace crashrank

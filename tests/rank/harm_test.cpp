#include "crashrank/rank/harm.hpp"

#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace crashrank {
namespace {

TEST(Harm, WeightsAreTheCallersAndCountAsSuch) {
  HarmExposure e;
  e.kind = BodyKind::car;
  e.delta_v_mps = 15;
  e.crush_energy_j = 2e6;
  HarmOptions options;
  const double one = harm_of(e, options);
  EXPECT_GT(one, 0.0);
  EXPECT_LT(one, 1.0);
  options.weights.people_in_car = 4;
  options.weights.other_occupant = 0.5;
  EXPECT_DOUBLE_EQ(harm_of(e, options), 2 * one);
  e.ego = true;
  EXPECT_DOUBLE_EQ(harm_of(e, options), one);
  options.weights.property_per_mj = 0.25;
  EXPECT_DOUBLE_EQ(harm_of(e, options), one + 0.5);
  e.kind = BodyKind::pole;
  EXPECT_DOUBLE_EQ(harm_of(e, options), 0.5);
}

TEST(Harm, SomebodyOnFootCountsByTheClosingSpeed) {
  HarmExposure e;
  e.kind = BodyKind::pedestrian;
  e.closing_speed_mps = 8;
  const HarmOptions options;
  const double slow = harm_of(e, options);
  e.closing_speed_mps = 14;
  EXPECT_GT(harm_of(e, options), slow);
}

using scenes::box_mesh;
using scenes::of;
using scenes::Scene;

/// At 14 m/s: somebody on foot ahead, a standing car to the left of the lane.
Scene street() {
  Scene scene;
  const std::size_t car =
      scene.add_model("car", box_mesh({2.2F, 0.9F, 0.7F}, 8, {0, 0, 0.7F}), BodyKind::car, 1500.0);
  const std::size_t person = scene.add_model(
      "person", box_mesh({0.2F, 0.3F, 0.85F}, 4, {0, 0, 0.85F}), BodyKind::pedestrian);
  scene.scenario.ego.model = car;
  scene.scenario.ego.speed_mps = 14.0;
  scene.add_actor("person", person, 12.0, 0.0);
  scene.add_actor("standing car", car, 12.0, 3.0);
  scene.add_candidate("straight on", 0.0);
  scene.add_candidate("brake", -4.0);
  scene.add_candidate("into the car", -7.0, 0.1);
  return scene;
}

TEST(Harm, RankPutsMetalBeforeSomebodyOnFoot) {
  const Scene scene = street();
  const RankResult energy = scene.ranked(Measure::closing_energy);
  const RankResult harm = scene.ranked(Measure::harm);
  for (const CandidateResult& candidate : harm.ranking) ASSERT_TRUE(candidate.collides);
  ASSERT_EQ(of(harm, "brake").contacts.front().actor, 0U);
  ASSERT_EQ(of(harm, "into the car").contacts.front().actor, 1U);
  EXPECT_EQ(harm.candidates[harm.ranking[0].candidate].name, "into the car");
  EXPECT_NE(energy.candidates[energy.ranking[0].candidate].name, "into the car");
  EXPECT_LT(*of(harm, "brake").score, *of(harm, "straight on").score);
  for (const CandidateResult& candidate : harm.ranking) {
    const ContactSeverity& crash = candidate.contacts.front().severity;
    EXPECT_TRUE(crash.simulated);
    EXPECT_LE(candidate.score_interval.lowest, *candidate.score);
    EXPECT_GE(candidate.score_interval.highest, *candidate.score);
    EXPECT_NEAR(crash.harm, crash.ego.harm + crash.other.harm, 1e-12);
  }
  // 75 kg against 1500: the person takes nearly all of the change of velocity.
  const ContactSeverity& hit = of(harm, "straight on").contacts.front().severity;
  EXPECT_NEAR(hit.other.delta_v_mps, 14.0 * 1500 / 1575, 0.5);
  EXPECT_NEAR(hit.ego.delta_v_mps, 14.0 * 75 / 1575, 0.1);
  EXPECT_NEAR(std::fmod(hit.ego.pdof_deg + 10, 360.0), 10, 5);
  EXPECT_FALSE(of(energy, "brake").contacts.front().severity.simulated);
  // One story of the change of velocity, whatever is ranked by.
  for (const char* name : {"straight on", "brake", "into the car"}) {
    const ContactSeverity& told = of(energy, name).contacts.front().severity;
    const ContactSeverity& pulse = of(harm, name).contacts.front().severity;
    EXPECT_EQ(told.ego.delta_v_mps, pulse.ego.delta_v_mps) << name;
    EXPECT_EQ(told.other.delta_v_mps, pulse.other.delta_v_mps) << name;
    EXPECT_EQ(told.ego.pdof_deg, pulse.ego.pdof_deg) << name;
  }
}

TEST(Harm, MoreWorkersTellTheSame) {
  const Scene scene = street();
  RankOptions options;
  options.measure = Measure::harm;
  const RankResult one = scene.ranked(options);
  options.workers = 3;
  const RankResult three = scene.ranked(options);
  ASSERT_EQ(one.ranking.size(), three.ranking.size());
  for (std::size_t i = 0; i < one.ranking.size(); ++i) {
    EXPECT_EQ(one.ranking[i].candidate, three.ranking[i].candidate);
    EXPECT_EQ(one.ranking[i].score, three.ranking[i].score);
    EXPECT_EQ(one.ranking[i].score_interval.highest, three.ranking[i].score_interval.highest);
  }
}

TEST(Harm, TheRiskModelIsTheCallers) {
  const Scene scene = street();
  RankOptions options;
  options.measure = Measure::harm;
  HarmOptions harm;
  harm.intervals = false;
  options.harm = harm;
  const double tum = *of(scene.ranked(options), "straight on").score;
  harm.model = RiskModel::malliaris_rosen;
  options.harm = harm;
  const RankResult death = scene.ranked(options);
  EXPECT_LT(*of(death, "straight on").score, tum);
  EXPECT_EQ(death.harm.model, RiskModel::malliaris_rosen);
}

}  // namespace
}  // namespace crashrank

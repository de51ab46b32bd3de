#include "crashrank/internal/rank/harm.hpp"

#include "base/random.hpp"
#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

namespace crashrank {
namespace {

TEST(Harm, WeightsOfTheCallerScaleTheHarm) {
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

TEST(Harm, PedestrianHarmDependsOnTheClosingSpeed) {
  HarmExposure e;
  e.kind = BodyKind::pedestrian;
  e.closing_speed_mps = 8;
  const HarmOptions options;
  const double slow = harm_of(e, options);
  e.closing_speed_mps = 14;
  EXPECT_GT(harm_of(e, options), slow);
}

constexpr BodyKind kinds[] = {BodyKind::car,        BodyKind::truck,   BodyKind::bus,
                              BodyKind::motorcycle, BodyKind::bicycle, BodyKind::pedestrian,
                              BodyKind::barrier,    BodyKind::pole,    BodyKind::building};
constexpr RiskModel models[] = {RiskModel::tum, RiskModel::malliaris_monfort,
                                RiskModel::malliaris_rosen, RiskModel::joksch_monfort};

TEST(Harm, IsPeopleTimesRiskPlusProperty) {
  HarmExposure e;
  e.kind = BodyKind::bus;
  e.delta_v_mps = 9;
  e.intrusion_m = 0.1;
  e.crush_energy_j = 1e5;
  HarmOptions options;
  options.weights.other_occupant = 2.0;
  options.weights.property_per_mj = 3.0;
  const HarmSample sample;
  EXPECT_DOUBLE_EQ(people_weight(e, options.weights), 20.0);
  EXPECT_DOUBLE_EQ(property_harm(e, options.weights), 0.3);
  Exposure person;
  person.delta_v_mps = 9;
  person.intrusion_m = 0.1;
  EXPECT_DOUBLE_EQ(risk_of(e, options, sample), injury_risk(RiskModel::tum, person));
  EXPECT_DOUBLE_EQ(harm_of(e, options), 20.0 * risk_of(e, options, sample) + 0.3);
  e.kind = BodyKind::pole;
  EXPECT_EQ(people_weight(e, options.weights), 0.0);
  EXPECT_EQ(risk_of(e, options, sample), 0.0);
}

TEST(Harm, StatedOccupantsReplaceTheDefaultNumber) {
  HarmExposure e;
  e.delta_v_mps = 15;
  HarmOptions options;
  options.weights.people_in_car = 4;
  const double risk = risk_of(e, options, {});
  e.occupants = 2.5;
  EXPECT_DOUBLE_EQ(harm_of(e, options), 2.5 * risk);
  e.ego = true;
  EXPECT_DOUBLE_EQ(harm_of(e, options), 2.5 * risk);
  e.occupants = 0.0;
  EXPECT_EQ(harm_of(e, options), 0.0);
  EXPECT_EQ(most_harm(e, options), 0.0);
  EXPECT_EQ(risk_of(e, options, {}), risk);
  options.weights.property_per_mj = 1.0;
  e.crush_energy_j = 1e6;
  EXPECT_EQ(harm_of(e, options), 1.0);
  EXPECT_EQ(most_harm(e, options), 1.0);
}

TEST(Harm, ARiderFallsAtRoadSpeedAsTheExposureGrows) {
  EXPECT_EQ(fall_speed_mps(20.0, 0.0), 0.0);
  EXPECT_LT(fall_speed_mps(20.0, 0.5), 0.1);
  EXPECT_NEAR(fall_speed_mps(20.0, fall_exposure_mps), 6.0 * (1.0 - std::exp(-1.0)), 1e-12);
  EXPECT_NEAR(fall_speed_mps(20.0, 9.0), 6.0, 1e-9);
  const HarmOptions options;
  for (const BodyKind kind : {BodyKind::motorcycle, BodyKind::bicycle}) {
    HarmExposure e;
    e.kind = kind;
    e.road_speed_mps = 20.0;
    EXPECT_EQ(risk_of(e, options, {}), 0.0);
    e.delta_v_mps = 3.0;
    const double falls = risk_of(e, options, {});
    EXPECT_GT(falls, 0.0);
    e.closing_speed_mps = 5.0;
    EXPECT_EQ(risk_of(e, options, {}), falls);
    e.closing_speed_mps = 9.0;
    EXPECT_GT(risk_of(e, options, {}), falls);
  }
}

TEST(Harm, AToppledPedestrianFallsFromStandingHeight) {
  // A centre of mass 0.9 m high reaches the ground at sqrt(2·g·h).
  EXPECT_NEAR(standing_fall_mps(100.0), std::sqrt(2.0 * 9.81 * 0.9), 0.01);
  EXPECT_EQ(standing_fall_mps(-1.0), 0.0);
  EXPECT_LT(standing_fall_mps(1.5), 0.07 * standing_fall_mps(100.0));
  const HarmOptions options;
  HarmExposure walking;
  walking.kind = BodyKind::pedestrian;
  walking.road_speed_mps = 20.0;
  EXPECT_EQ(risk_of(walking, options, {}), 0.0);
  walking.delta_v_mps = 3.0;
  EXPECT_GT(risk_of(walking, options, {}), 0.0);
}

TEST(Harm, TheHurtingSpeedRisesAndBecomesTheImpactSpeed) {
  EXPECT_EQ(hurting_speed_mps(0.0), 0.0);
  EXPECT_LT(hurting_speed_mps(1.5), 0.3);
  EXPECT_NEAR(hurting_speed_mps(29.0 / 3.6), 29.0 / 3.6, 0.06);
  double before = 0.0;
  for (double v = 0.0; v < 20.0; v += 0.05) {
    EXPECT_GE(hurting_speed_mps(v), before) << v;
    EXPECT_LE(hurting_speed_mps(v), v);
    before = hurting_speed_mps(v);
  }
}

TEST(Harm, LightContactsCauseLittleHarm) {
  const HarmOptions options;
  HarmExposure wall;
  wall.ego = true;
  wall.delta_v_mps = 0.3;
  EXPECT_LE(harm_of(wall, options), 0.002);
  HarmExposure person;
  person.kind = BodyKind::pedestrian;
  person.delta_v_mps = person.closing_speed_mps = 0.3;
  EXPECT_LE(harm_of(person, options), 0.005);
  person.delta_v_mps = person.closing_speed_mps = 1.0;
  EXPECT_LE(harm_of(person, options), 0.02);
}

TEST(Harm, ThePedestriansAgeIsAnOption) {
  HarmExposure person;
  person.kind = BodyKind::pedestrian;
  person.closing_speed_mps = 12.0;
  HarmOptions options;
  options.model = RiskModel::malliaris_rosen;
  const double mean = harm_of(person, options);
  options.pedestrian.age_years = 80.0;
  EXPECT_GT(harm_of(person, options), mean);
  EXPECT_GE(most_harm(person, options), harm_of(person, options));
}

TEST(Harm, APedestrianOutOfRangeIsRefused) {
  scenes::Scene scene;
  scene.scenario.ego.model =
      scene.add_model("car", scenes::box_mesh({2.0F, 0.9F, 0.7F}, 1), BodyKind::car, 1400.0);
  scene.add_candidate("go on", 0.0);
  const auto fault = [&](std::optional<double> age_years, std::optional<double> male_share) {
    scene.scenario.harm.pedestrian = {age_years, male_share};
    const Result<RankResult> result = rank(scene.scenario, scene.models, {});
    return result ? std::string() : result.error().place;
  };
  EXPECT_EQ(fault(121.0, std::nullopt), "harm.pedestrian.age_years");
  EXPECT_EQ(fault(-1.0, std::nullopt), "harm.pedestrian.age_years");
  EXPECT_EQ(fault(std::nan(""), std::nullopt), "harm.pedestrian.age_years");
  EXPECT_EQ(fault(std::nullopt, 1.1), "harm.pedestrian.male_share");
  EXPECT_EQ(fault(std::nullopt, std::nan("")), "harm.pedestrian.male_share");
  EXPECT_EQ(fault(120.0, 1.0), "");
  EXPECT_EQ(fault(std::nullopt, std::nullopt), "");
}

TEST(Harm, IsMonotoneAndBelowItsUpperBound) {
  constexpr std::uint64_t seed = 33;
  test::Random random(seed);
  for (int i = 0; i < 5000; ++i) {
    const auto name = [i] {
      return "seed " + std::to_string(seed) + ", case " + std::to_string(i);
    };
    HarmOptions options;
    options.model = models[random.below(4)];
    options.weights.property_per_mj = random.uniform(0, 2);
    if (random.below(2) != 0) options.pedestrian.age_years = random.uniform(0, 90);
    HarmExposure e;
    e.kind = kinds[random.below(9)];
    e.ego = random.below(2) != 0;
    e.delta_v_mps = random.uniform(0, 30);
    e.closing_speed_mps = random.uniform(0, 30);
    e.crush_energy_j = random.uniform(0, 1e6);
    e.intrusion_m = random.below(2) != 0 ? random.uniform(0, 0.5) : 0.0;
    e.road_speed_mps = random.uniform(0, 40);
    if (random.below(2) != 0) e.occupants = random.uniform(0, 5);
    const double most = most_harm(e, options) * (1.0 + 1e-14);
    HarmExposure less = e;
    less.delta_v_mps *= random.uniform(0, 1);
    less.closing_speed_mps *= random.uniform(0, 1);
    less.crush_energy_j *= random.uniform(0, 1);
    less.intrusion_m *= random.uniform(0, 1);
    less.road_speed_mps *= random.uniform(0, 1);
    for (int direction = 0; direction < 20; ++direction) {
      e.direction = less.direction = force_direction(random.uniform(-10, 370));
      e.leading_edge_m = less.leading_edge_m = random.uniform(0.2, 1.6);
      ASSERT_LE(harm_of(e, options), most) << name();
      ASSERT_LE(harm_of(less, options), harm_of(e, options)) << name();
      ASSERT_GE(harm_of(less, options), 0.0) << name();
    }
    HarmExposure none = e;
    none.delta_v_mps = none.closing_speed_mps = none.crush_energy_j = none.intrusion_m = 0.0;
    ASSERT_EQ(harm_of(none, options), 0.0) << name();
  }
}

using scenes::box_mesh;
using scenes::of;
using scenes::Scene;

/// At 14 m/s: a person on foot ahead, a parked car to the left of the lane.
Scene street() {
  Scene scene;
  const std::size_t car =
      scene.add_model("car", box_mesh({2.2F, 0.9F, 0.7F}, 8, {0, 0, 0.7F}), BodyKind::car, 1500.0);
  const std::size_t person = scene.add_model(
      "person", box_mesh({0.2F, 0.3F, 0.85F}, 4, {0, 0, 0.85F}), BodyKind::pedestrian);
  scene.scenario.ego.model = car;
  scene.scenario.ego.speed_mps = 14.0;
  scene.scenario.grip = 1.2;
  scene.add_actor("person", person, 12.0, 0.0);
  scene.add_actor("standing car", car, 12.0, 3.0);
  scene.add_candidate("straight on", 0.0);
  scene.add_candidate("brake", -4.0);
  scene.add_candidate("into the car", -7.0, 0.1);
  return scene;
}

TEST(Harm, HittingACarRanksBeforeHittingAPedestrian) {
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
  // 75 kg against 1500 kg: nearly all of the change of velocity is that of the person.
  const ContactSeverity& hit = of(harm, "straight on").contacts.front().severity;
  // While the car pushes the person along, its force also balances that of the road.
  constexpr double push_s = 0.3;
  EXPECT_GT(hit.other.delta_v_mps, 14.0 * 1500 / 1575 - 0.5);
  EXPECT_LT(hit.other.delta_v_mps,
            14.0 * 1500 / 1575 + 0.5 + push_s * scene.scenario.grip * standard_gravity_mps2);
  EXPECT_NEAR(hit.ego.delta_v_mps, 14.0 * 75 / 1575, 0.1);
  EXPECT_NEAR(std::fmod(hit.ego.pdof_deg + 10, 360.0), 10, 5);
  EXPECT_FALSE(of(energy, "brake").contacts.front().severity.simulated);
  // The changes of velocity are the same under every measure.
  for (const char* name : {"straight on", "brake", "into the car"}) {
    const ContactSeverity& told = of(energy, name).contacts.front().severity;
    const ContactSeverity& pulse = of(harm, name).contacts.front().severity;
    EXPECT_EQ(told.ego.delta_v_mps, pulse.ego.delta_v_mps) << name;
    EXPECT_EQ(told.other.delta_v_mps, pulse.other.delta_v_mps) << name;
    EXPECT_EQ(told.ego.pdof_deg, pulse.ego.pdof_deg) << name;
  }
}

TEST(Harm, WorkersDoNotChangeTheResult) {
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

TEST(Harm, TheRiskModelOfTheCallerIsUsed) {
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

#include "crashrank/scenario/candidate.hpp"
#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <numbers>

namespace crashrank {
namespace {

using scenes::box_mesh;
using scenes::of;
using scenes::Scene;

constexpr double speed_mps = 16.0;

TriangleMesh car_mesh() { return box_mesh({2.0F, 0.9F, 0.7F}, 6, {0, 0, 0.7F}); }

/// Almost no friction on the road: motion between contacts is tested separately.
Scene road() { return scenes::car_on_road(0.01); }

/// A post at the corner of the front, hit just before a wall across the lane.
TEST(Aftermath, ForceIsThatOfTheWallAndNotOfThePostTouchedFirst) {
  Scene scene = scenes::car_and_wall();
  scene.scenario.measure = Measure::delta_v;
  const std::size_t post = scene.add_model("post", box_mesh({0.05F, 0.05F, 1.0F}), BodyKind::pole);
  scene.add_actor("post", post, 49.2, 1.04);
  scene.add_candidate("straight on", 0.0);
  const CandidateResult ranked = scene.ranked().ranking.front();
  ASSERT_GE(ranked.contacts.size(), 2U);
  EXPECT_EQ(scene.scenario.actors[ranked.contacts[0].actor].name, "post");
  int walls = 0;
  for (const Contact& contact : ranked.contacts) {
    const double delta_v_mps = contact.severity.ego.delta_v_mps;
    std::printf("%s at %.4f s: %.3f m/s\n", scene.scenario.actors[contact.actor].name.c_str(),
                contact.time_of_impact_s, delta_v_mps);
    EXPECT_GE(contact.time_of_impact_s, ranked.contacts[0].time_of_impact_s);
    if (scene.scenario.actors[contact.actor].name == "post") {
      EXPECT_LT(delta_v_mps, 1.0);
    } else {
      ++walls;
      EXPECT_GT(delta_v_mps, 20.0);
    }
  }
  EXPECT_EQ(walls, 1);
}

/// A listed manoeuvre and the same motion as poses every 50 ms: after the first contact the ego
/// hits the same bodies.
TEST(Aftermath, TimedPosesHoldBrakingAndSteeringLikeManoeuvres) {
  for (const double yaw_rate : {0.0, 0.15}) {
    Scene scene = road();
    scene.scenario.grip = 0.8;
    scene.scenario.ego.max_deceleration_mps2 = 8.0;
    const std::size_t light = scene.add_model(
        "light", box_mesh({0.5F, 0.5F, 0.7F}, 2, {0, 0, 0.7F}), BodyKind::car, 300.0);
    const std::size_t wall =
        scene.add_model("wall", box_mesh({0.5F, 8.0F, 1.5F}, 2, {0, 0, 1.5F}), BodyKind::building);
    scene.add_actor("light", light, 12.0, 0.0);
    scene.add_actor("wall", wall, 16.0, 0.0);
    ListedCandidate& listed = scene.scenario.listed.front();
    listed.acceleration_mps2 = -7.0;
    if (yaw_rate != 0.0) listed.yaw_rate_radps = yaw_rate;
    const std::vector<Candidate> made = *make_candidates(scene.scenario, 4.0);
    const CandidateResult manoeuvre = scene.ranked().ranking.front();
    listed = {};
    listed.name = "poses";
    for (int i = 0; i <= 40; ++i) {
      const double time_s = 0.05 * i;
      listed.poses.push_back({time_s, made.front().motion.pose_at(time_s)});
    }
    scene.scenario.listed.resize(1);
    const CandidateResult poses = scene.ranked().ranking.front();
    ASSERT_EQ(manoeuvre.contacts.size(), poses.contacts.size());
    ASSERT_GE(poses.contacts.size(), 1U);
    EXPECT_NEAR(*poses.score / *manoeuvre.score, 1.0, 0.1) << yaw_rate;
    EXPECT_NEAR(poses.contacts.back().time_of_impact_s, manoeuvre.contacts.back().time_of_impact_s,
                0.03);
    EXPECT_NEAR(poses.contacts.back().closing_speed_mps,
                manoeuvre.contacts.back().closing_speed_mps, 0.4);
    std::printf("yaw rate %.2f: %zu contacts, %.4f and %.4f, last closing %.2f and %.2f m/s\n",
                yaw_rate, poses.contacts.size(), *manoeuvre.score, *poses.score,
                manoeuvre.contacts.back().closing_speed_mps,
                poses.contacts.back().closing_speed_mps);
  }
}

TEST(Aftermath, AChainOfEqualMassesPassesTheSpeedOn) {
  Scene scene = road();
  for (const double x : {10.0, 20.0, 30.0}) {
    scene.add_actor("car at " + std::to_string(x), scene.scenario.ego.model, x, 0.0);
  }
  const RankResult result = scene.ranked();
  const CandidateResult& on = of(result, "on");
  ASSERT_GE(on.contacts.size(), 1U);
  ASSERT_GE(on.further.size(), 2U);
  // Equal masses share their momentum and separate with a restitution of at most 0.35: the struck
  // car takes half of the closing speed plus half of the rebound, and passes it on.
  double closing = speed_mps;
  const BodyOutcome* struck = &on.contacts[0].severity.other;
  EXPECT_EQ(on.contacts[0].actor, 0U);
  double harm = on.contacts[0].severity.harm;
  double before_s = on.contacts[0].time_of_impact_s;
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_GE(struck->delta_v_mps, 0.49 * closing);
    EXPECT_LE(struck->delta_v_mps, 0.5 * 1.35 * closing);
    closing = struck->delta_v_mps;
    const FurtherContact& contact = on.further[i];
    EXPECT_EQ(contact.a, i);
    EXPECT_EQ(contact.b, i + 1);
    EXPECT_GT(contact.time_s, before_s);
    before_s = contact.time_s;
    EXPECT_NEAR(contact.closing_speed_mps, closing, 0.03 * speed_mps);
    EXPECT_NEAR(contact.outcome_a.delta_v_mps, contact.outcome_b.delta_v_mps, 1e-9);
    struck = &contact.outcome_b;
  }
  for (std::size_t i = 1; i < on.contacts.size(); ++i) harm += on.contacts[i].severity.harm;
  for (const FurtherContact& contact : on.further) harm += contact.harm;
  EXPECT_NEAR(*on.score, harm, 1e-12);
}

TEST(Aftermath, AStruckCarIsPushedIntoThePersonBehindIt) {
  Scene scene = road();
  scene.scenario.grip = 0.8;
  const std::size_t person = scene.add_model(
      "person", box_mesh({0.2F, 0.3F, 0.85F}, 2, {0, 0, 0.85F}), BodyKind::pedestrian);
  scene.add_actor("car", scene.scenario.ego.model, 10.0, 0.0);
  const double without = *of(scene.ranked(), "on").score;
  scene.add_actor("person", person, 14.0, 0.0);
  const RankResult result = scene.ranked();
  const CandidateResult& on = of(result, "on");
  ASSERT_GE(on.further.size(), 1U);
  const FurtherContact& pushed = on.further[0];
  EXPECT_EQ(pushed.a + pushed.b, 1U);
  EXPECT_GT((pushed.a == 1 ? pushed.outcome_a : pushed.outcome_b).delta_v_mps, 3.0);
  EXPECT_FALSE(pushed.damage_a.triangles.empty());
  EXPECT_FALSE(pushed.damage_b.triangles.empty());
  EXPECT_GT(*on.score, without + 0.01);
  // A person elsewhere is not injured.
  scene.scenario.actors[1].pose.translation.y() = 8.0;
  EXPECT_EQ(*of(scene.ranked(), "on").score, without);
}

/// A struck car accelerates a person in front of it to the same speed, whether it touches the
/// person at once or after a gap.
TEST(Aftermath, APersonAtTheBumperOfAStruckCarIsHarmedAsAtAGap) {
  std::vector<double> risks;
  for (const double gap_m : {0.005, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5}) {
    Scene scene = road();
    scene.scenario.grip = 0.8;
    const std::size_t person = scene.add_model(
        "person", box_mesh({0.2F, 0.3F, 0.85F}, 2, {0, 0, 0.85F}), BodyKind::pedestrian);
    scene.add_actor("car", scene.scenario.ego.model, 10.0, 0.0);
    scene.add_actor("person", person, 12.2 + gap_m, 0.0);
    const RankResult result = scene.ranked();
    for (const PersonRisk& each : of(result, "on").people) {
      if (each.body == 1) risks.push_back(each.probability);
    }
  }
  ASSERT_EQ(risks.size(), 7U);
  const auto [least, most] = std::minmax_element(risks.begin(), risks.end());
  EXPECT_GT(*least, 0.0);
  EXPECT_LT(*most, 1.15 * *least);
}

/// A car that is pushed against a wall stops the one behind it a second time. The faster crash is
/// the worse one, whatever the time between the two hits, and it
/// does not jump where they become two impacts.
TEST(Aftermath, AFasterCrashIntoACarBeforeAWallIsWorse) {
  for (const double gap_m : {0.02, 0.1, 0.4, 0.8}) {
    Scene scene = road();
    scene.scenario.grip = 0.8;
    const std::size_t wall =
        scene.add_model("wall", box_mesh({0.2F, 5.0F, 1.2F}, 8, {0, 0, 1.2F}), BodyKind::building);
    scene.add_actor("car", scene.scenario.ego.model, 10.0, 0.0);
    scene.add_actor("wall", wall, 12.2 + gap_m, 0.0);
    double before = 0.0;
    for (double speed = 8.0; speed <= 26.0; speed += 0.5) {
      scene.scenario.ego.speed_mps = speed;
      const double score = *of(scene.ranked(), "on").score;
      EXPECT_GE(score, 0.97 * before - 0.001) << "gap " << gap_m << " m, " << speed << " m/s";
      if (speed > 8.0) {
        EXPECT_LT(score, 1.4 * before + 0.01) << "gap " << gap_m << " m, " << speed << " m/s";
      }
      before = score;
    }
  }
}

TEST(Aftermath, BodiesBrakeBetweenContacts) {
  // The struck car brakes with 0.45 of the grip until it hits the second one.
  constexpr double deceleration = 0.45 * 0.8 * 9.80665;
  Scene scene = road();
  scene.scenario.grip = 0.8;
  scene.add_actor("car", scene.scenario.ego.model, 10.0, 0.0);
  scene.add_actor("second", scene.scenario.ego.model, 17.0, 0.0);
  const RankResult result = scene.ranked();
  const CandidateResult& on = of(result, "on");
  ASSERT_GE(on.further.size(), 1U);
  const double struck = on.contacts[0].severity.other.delta_v_mps;
  const double closing = on.further[0].closing_speed_mps;
  // Part of the 3 m between them is crushed or travelled during the crash.
  EXPECT_GE(closing, std::sqrt(struck * struck - 2 * deceleration * 3.2) - 0.3);
  EXPECT_LE(closing, std::sqrt(struck * struck - 2 * deceleration * 2.0) + 0.3);
  // With free-rolling wheels it arrives faster, with locked ones slower.
  scene.scenario.harm.after_contact = AfterContact::releases;
  const RankResult rolls = scene.ranked();
  scene.scenario.harm.after_contact = AfterContact::locks;
  const RankResult slides = scene.ranked();
  ASSERT_GE(of(rolls, "on").further.size(), 1U);
  ASSERT_GE(of(slides, "on").further.size(), 1U);
  EXPECT_GT(of(rolls, "on").further[0].closing_speed_mps, closing + 0.5);
  EXPECT_LT(of(slides, "on").further[0].closing_speed_mps, closing - 0.5);
  // It stops before a car that is farther away.
  scene.scenario.harm.after_contact = AfterContact::brakes;
  scene.scenario.actors[1].pose.translation.x() = 10.0 + 4.0 + struck * struck / deceleration;
  EXPECT_TRUE(of(scene.ranked(), "on").further.empty());
}

TEST(Aftermath, EveryMeasureReportsTheSameContacts) {
  Scene scene = road();
  scene.add_actor("car", scene.scenario.ego.model, 10.0, 0.3);
  scene.add_actor("second", scene.scenario.ego.model, 16.0, 0.0);
  const RankResult harm = scene.ranked(Measure::harm);
  for (const Measure measure : {Measure::polygons, Measure::area, Measure::closing_energy,
                                Measure::delta_v, Measure::energy}) {
    const RankResult other = scene.ranked(measure);
    const CandidateResult& p = of(harm, "on");
    const CandidateResult& q = of(other, "on");
    ASSERT_EQ(p.contacts.size(), q.contacts.size());
    ASSERT_EQ(p.further.size(), q.further.size());
    EXPECT_EQ(p.contacts[0].severity.ego.delta_v_mps, q.contacts[0].severity.ego.delta_v_mps);
    EXPECT_EQ(p.further[0].closing_energy_j, q.further[0].closing_energy_j);
    EXPECT_GT(*q.score, 0.0) << measure_name(measure);
  }
}

/// The exposure can be computed from the recorded motion alone: the greatest change of velocity in
/// steps with a contact force within 0.3 s.
TEST(Aftermath, TheRecordedMotionGivesTheExposure) {
  Scene scene = road();
  scene.add_actor("car", scene.scenario.ego.model, 10.0, 0.4);
  scene.add_actor("second", scene.scenario.ego.model, 16.0, 0.0);
  RankOptions options;
  options.measure = Measure::harm;
  EXPECT_TRUE(of(scene.ranked(options), "on").motion.empty());
  options.records_motion = true;
  const RankResult result = scene.ranked(options);
  const CandidateResult& on = of(result, "on");
  ASSERT_EQ(on.motion.size(), 3U);
  EXPECT_EQ(on.motion[0].body, ego_body);
  for (const BodyMotion& motion : on.motion) {
    ASSERT_EQ(motion.vx_mps.size(), motion.t_s.size());
    std::vector<Eigen::Vector2d> changed{Eigen::Vector2d::Zero()};
    for (std::size_t k = 1; k < motion.t_s.size(); ++k) {
      const Eigen::Vector2d step(motion.vx_mps[k] - motion.vx_mps[k - 1],
                                 motion.vy_mps[k] - motion.vy_mps[k - 1]);
      changed.push_back(changed.back() + (motion.pressed[k] != 0 ? step : step * 0.0));
      // Positions follow the velocities.
      const double step_s = motion.t_s[k] - motion.t_s[k - 1];
      ASSERT_GT(step_s, 0.0);
      EXPECT_NEAR(motion.x_m[k] - motion.x_m[k - 1],
                  0.5 * step_s * (motion.vx_mps[k] + motion.vx_mps[k - 1]), 1e-3);
    }
    double most = 0.0;
    for (std::size_t i = 0; i < changed.size(); ++i) {
      for (std::size_t k = i; k < changed.size() && motion.t_s[k] - motion.t_s[i] <= 0.3; ++k) {
        most = std::max(most, (changed[k] - changed[i]).norm());
      }
    }
    const auto person =
        std::find_if(on.people.begin(), on.people.end(),
                     [&](const PersonRisk& each) { return each.body == motion.body; });
    ASSERT_NE(person, on.people.end());
    EXPECT_NEAR(person->exposure_mps, most, 0.01 * most);
  }
}

TEST(Aftermath, GlancingACarThenAPole) {
  Scene scene = road();
  const std::size_t pole =
      scene.add_model("pole", box_mesh({0.15F, 0.15F, 2.0F}, 2, {0, 0, 2}), BodyKind::pole);
  scene.add_actor("parked", scene.scenario.ego.model, 10.0, 1.75);
  scene.add_actor("pole", pole, 22.0, -0.3);
  const RankResult result = scene.ranked();
  const CandidateResult& on = of(result, "on");
  ASSERT_GE(on.contacts.size(), 2U);
  const Contact& glance = on.contacts[0];
  const Contact& stop = on.contacts[1];
  EXPECT_EQ(glance.actor, 0U);
  EXPECT_EQ(stop.actor, 1U);
  EXPECT_GT(glance.severity.ego.delta_v_mps, 0.3);
  EXPECT_LT(glance.severity.ego.delta_v_mps, 0.6 * speed_mps);
  // Speed that the first contact takes is not available for the second.
  const double left =
      std::hypot(speed_mps + glance.severity.ego.delta_v_x_mps, glance.severity.ego.delta_v_y_mps);
  // Points of a rotating body are faster or slower than its centre.
  EXPECT_NEAR(stop.closing_speed_mps, left, 0.12 * speed_mps);
  EXPECT_GT(stop.severity.ego.delta_v_mps, glance.severity.ego.delta_v_mps);
  double harm = 0.0;
  for (const Contact& contact : on.contacts) harm += contact.severity.harm;
  for (const FurtherContact& contact : on.further) harm += contact.harm;
  EXPECT_NEAR(*on.score, harm, 1e-12);
}

TEST(Aftermath, SimultaneousContactsShareTheImpulseEqually) {
  Scene scene = road();
  scene.add_actor("left", scene.scenario.ego.model, 10.0, 0.95);
  scene.add_actor("right", scene.scenario.ego.model, 10.0, -0.95);
  const RankResult result = scene.ranked();
  const CandidateResult& on = of(result, "on");
  ASSERT_GE(on.contacts.size(), 2U);
  const Contact& p = on.contacts[0];
  const Contact& q = on.contacts[1];
  EXPECT_NE(p.actor, q.actor);
  EXPECT_NEAR(q.time_of_impact_s, p.time_of_impact_s, 0.02);
  // Each of the crashes alone conserves momentum between equal masses.
  for (const Contact& contact : {p, q}) {
    EXPECT_NEAR(contact.severity.ego.delta_v_mps, contact.severity.other.delta_v_mps, 0.02);
  }
  // One of the two separates before the other.
  EXPECT_NEAR(p.severity.ego.delta_v_mps, q.severity.ego.delta_v_mps,
              0.12 * p.severity.ego.delta_v_mps);
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
  EXPECT_NEAR(*left.score, *right.score, 0.05 * *left.score);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(left.contacts.at(i).actor, right.contacts.at(i).actor);
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
    const std::size_t model = scene.add_model("other", car_mesh(), kind, other_kg);
    scene.add_actor("other", model, 10.0, 0.0);
    return of(scene.ranked(), "on").contacts.front().severity;
  };
  Exposure all;
  all.delta_v_mps = speed_mps;
  const double certain = injury_risk(RiskModel::tum, all);
  const ContactSeverity feather = crash(1.0, BodyKind::car);
  EXPECT_LT(feather.ego.harm, 1e-4);
  // The full closing speed plus the rebound.
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

TEST(Aftermath, LeadingEdgeHeightIsThatOfTheMesh) {
  const auto risk = [](float half_height) {
    Scene scene = road();
    const std::size_t vehicle =
        scene.add_model("vehicle", box_mesh({2.0F, 0.9F, half_height}, 8, {0, 0, half_height}),
                        BodyKind::car, 1500.0);
    const std::size_t person = scene.add_model(
        "person", box_mesh({0.2F, 0.3F, 0.85F}, 2, {0, 0, 0.85F}), BodyKind::pedestrian, 75.0);
    scene.scenario.ego.model = vehicle;
    scene.scenario.ego.speed_mps = 11.0;
    scene.scenario.harm.model = RiskModel::malliaris_monfort;
    scene.add_actor("person", person, 10.0, 0.0);
    const RankResult result = scene.ranked();
    const BodyOutcome& hit = of(result, "on").contacts.front().severity.other;
    EXPECT_NEAR(hit.exposure_mps, 11.0 * 1500.0 / 1575.0, 0.4);
    return std::pair(of(result, "on").people.back().probability,
                     hit.exposure_mps * (1.0 + 75.0 / 1500.0));
  };
  // Same speed and mass, leading edge of the bonnet 0.8 m and 1.1 m above the ground.
  Exposure e;
  e.person = Person::pedestrian;
  const auto [low, low_mps] = risk(0.4F);
  const auto [high, high_mps] = risk(0.55F);
  e.impact_speed_mps = low_mps;
  e.leading_edge_m = 0.8;
  EXPECT_NEAR(low, injury_risk(RiskModel::malliaris_monfort, e), 0.005);
  e.impact_speed_mps = high_mps;
  e.leading_edge_m = 1.1;
  EXPECT_NEAR(high, injury_risk(RiskModel::malliaris_monfort, e), 0.005);
  EXPECT_GT(high, 1.1 * low);
}

}  // namespace
}  // namespace crashrank

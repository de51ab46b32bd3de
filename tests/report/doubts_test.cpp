#include "crashrank/model/make_model.hpp"
#include "crashrank/report/ranking.hpp"

#include "told_ranking.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace crashrank {
namespace {

Motion planned(double begin_mps, double end_mps, double end_s) {
  Pose middle;
  middle.translation.x() = 0.5 * end_s * begin_mps;
  Pose last = middle;
  last.translation.x() += 0.5 * end_s * end_mps;
  return *Motion::timed(std::vector<TimedPose>{{0.0, {}}, {0.5 * end_s, middle}, {end_s, last}});
}

/// A closed box with that size, on the ground.
Model box_body(double length_m, double width_m, double height_m) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner(i % 2 * length_m, i / 2 % 2 * width_m, i / 4 * height_m);
    mesh.vertices.push_back(corner.cast<float>());
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {1, 3, 7}, {1, 7, 5}, {3, 2, 6}, {3, 6, 7}, {2, 0, 4}, {2, 4, 6}};
  mesh.parts = {{"body", 0, 12}};
  Result<Model> model = make_model(std::move(mesh));
  EXPECT_TRUE(model.ok());
  return std::move(*model);
}

/// Nothing doubtful: the ego drives 20 m/s, the second candidate hits at 10 m/s after 0.5 s.
struct Sound : Told {
  Sound() {
    scenario.ego.speed_mps = 20.0;
    scenario.horizon_s = 3.0;
    result.measure = Measure::harm;
    models[0] = box_body(4.5, 1.8, 1.4);
  }
  std::vector<std::string> doubts() const { return ranking_doubts(scenario, models, result); }

  /// Lets the second actor be a car of that size and mass at a place.
  void set_car(const Model& car, double mass_kg, const Eigen::Vector3d& at_m) {
    models.push_back(car);
    ScenarioModel model;
    model.name = "other car";
    scenario.models.push_back(model);
    scenario.actors[1].model = models.size() - 1;
    scenario.actors[1].pose.translation = at_m;
    result.actors[1] = {models.size() - 1, mass_kg, false};
  }
  void expect_one(const std::string& beginning) const {
    const std::vector<std::string> all = doubts();
    ASSERT_EQ(all.size(), 1U) << testing::PrintToString(all);
    EXPECT_EQ(all[0].rfind(beginning, 0), 0U) << all[0];
  }
};

TEST(Doubts, ThereAreNoneOfAnOrdinaryRanking) { EXPECT_TRUE(Sound().doubts().empty()); }

TEST(Doubts, ContactsFasterThanTheCrashModelAreTold) {
  Sound told;
  told.result.ranking[1].contacts[1].closing_speed_mps = 140.1;
  ASSERT_EQ(told.doubts().size(), 1U);
  EXPECT_EQ(told.doubts()[0].rfind("1 candidate leads to a contact at more than 140 m/s", 0), 0U);
  told.result.measure = Measure::closing_energy;
  EXPECT_TRUE(told.doubts().empty());
}

TEST(Doubts, ContactsBetweenOthersCountAndCrowdsAreTold) {
  Sound told;
  told.push_into("third");
  EXPECT_TRUE(told.doubts().empty());
  told.result.ranking[1].further.front().closing_speed_mps = 140.1;
  ASSERT_EQ(told.doubts().size(), 1U);
  EXPECT_EQ(told.doubts()[0].rfind("1 candidate leads to a contact at more than 140 m/s", 0), 0U);
  told.result.ranking[1].further.front().closing_speed_mps = 5.0;
  told.result.ranking[1].crowded = true;
  ASSERT_EQ(told.doubts().size(), 1U);
  EXPECT_EQ(told.doubts()[0],
            "1 candidate leads to more bodies or contacts than are simulated, or to contact forces "
            "on a body for more than 9.6 s, after which scores count none, so that they may be too "
            "low: 'hit', in place 2");
}

TEST(Doubts, BodiesThatOverlapAtTheStartAreNamedOnceInEveryAnswer) {
  for (const ImpactState state : {ImpactState::overlapping, ImpactState::contained}) {
    Sound told;
    const std::string mark = "(overlaps at start)";
    EXPECT_EQ(ranking_text(told.scenario, told.models, told.result).find("overlap"),
              std::string::npos);
    told.result.ranking[1].contacts[0].state = state;
    told.result.ranking[2].contacts = told.result.ranking[1].contacts;
    ASSERT_EQ(told.doubts().size(), 1U);
    EXPECT_EQ(
        told.doubts()[0].rfind("the ego overlaps 'wall' at the start (2 of 3 candidates): ", 0), 0U)
        << told.doubts()[0];
    const std::string text = ranking_text(told.scenario, told.models, told.result);
    for (const std::string& part : {"wall " + mark, std::string("overlaps at start: ")}) {
      EXPECT_NE(text.find(part), std::string::npos) << text;
    }
    const std::string page = html_report(told.scenario, told.models, told.result);
    for (const std::string& part :
         {std::string("Doubtful: the ego overlaps"), "wall " + mark + " after",
          std::string("overlaps wall at the start")}) {
      EXPECT_NE(page.find(part), std::string::npos) << part;
    }
    told.result.ranking[1].contacts[1].state = state;
    EXPECT_EQ(told.doubts()[0].rfind("the ego overlaps 'wall'; 'second' at", 0), 0U);
  }
}

/// The ranking with a second future, of that probability, in which the first candidate hits the
/// first actor; `overlapping` and 150 m/s are doubtful.
Sound with_unlikely_contact(double probability, ImpactState state, double closing_mps) {
  Sound told;
  FutureOutcome hit;
  hit.probability = probability;
  hit.collides = true;
  hit.state = state;
  hit.fastest_contact_mps = closing_mps;
  FutureOutcome miss;
  miss.probability = 1.0 - probability;
  miss.is_likeliest = true;
  told.result.ranking[0].futures = {miss, hit};
  return told;
}

TEST(Doubts, WhatIsDoubtfulInAFutureThatIsNotTheLikeliestIsTold) {
  EXPECT_TRUE(with_unlikely_contact(0.25, ImpactState::contact, 30.0).doubts().empty());
  with_unlikely_contact(0.25, ImpactState::contained, 30.0)
      .expect_one(
          "the ego overlaps 'wall' at the start (1 of 3 candidates, with a probability of 25 %): ");
  with_unlikely_contact(0.25, ImpactState::contact, 150.0)
      .expect_one("1 candidate leads to a contact at more than 140 m/s");
}

TEST(Doubts, LeavingTheRoadIsToldWithItsProbability) {
  Sound told = with_unlikely_contact(0.75, ImpactState::contact, 30.0);
  told.scenario.road.drivable = {{{{-1.0, -1.0}, {9.0, -1.0}, {9.0, 1.0}}, {}}};
  told.result.ranking[0].leaves_road = RoadLeaving{2.5, 15.0, {9.0, 0.0}};
  told.result.ranking[0].futures[0].leaves_road = true;
  told.expect_one(
      "the first place leaves the road after 2.50 s at 15.0 m/s with a probability of 25 %, and "
      "what lies beside it counts as harmless");
}

TEST(Doubts, KeysWithoutEffectAreNamed) {
  Sound told;
  told.scenario.keys_without_effect = {"crush"};
  ASSERT_EQ(told.doubts().size(), 1U);
  EXPECT_EQ(told.doubts()[0], "the scenario sets crush, which is without effect; leave it out");
  told.scenario.keys_without_effect.push_back("harm.after_impact");
  EXPECT_EQ(told.doubts()[0],
            "the scenario sets crush, harm.after_impact, which are without effect; leave them "
            "out");
}

TEST(Doubts, NormalisedProbabilitiesAreNamed) {
  Sound told;
  told.scenario.normalised = {"actors[0].predictions"};
  ASSERT_EQ(told.doubts().size(), 1U);
  EXPECT_EQ(told.doubts()[0],
            "probabilities do not sum to 1 and were divided by their sum: actors[0].predictions");
}

TEST(Doubts, ManoeuvresBeyondTheGripAreCountedAndTheFirstThreeDescribed) {
  Sound told;
  told.scenario.grip = 0.8;
  const CandidateResult miss = told.result.ranking[0];
  told.result.ranking.clear();
  for (std::size_t i = 0; i < 5; ++i) {
    Candidate candidate;
    candidate.name = "turn " + std::to_string(i);
    candidate.acceleration_mps2 = i == 1 ? 0.0 : -9.80665 * (1.0 + 0.2 * static_cast<double>(i));
    told.result.candidates.push_back(candidate);
    told.result.ranking.push_back(miss);
    told.result.ranking.back().candidate = told.result.candidates.size() - 1;
    told.result.ranking.back().place = i + 1;
    if (i == 1) continue;
    told.result.ranking.back().feasible = false;
    told.result.ranking.back().demand.grip = 1.25 * (1.0 + 0.2 * static_cast<double>(i));
  }
  const std::string grip =
      " than the vehicle can do and stand behind what it can follow: 'turn 0', in place 1, takes "
      "1.25 times the grip; 'turn 2', in place 3, takes 1.75 times the grip; 'turn 3', "
      "in place 4, takes 2.00 times the grip";
  ASSERT_EQ(told.doubts().size(), 1U);
  EXPECT_EQ(told.doubts()[0], "4 manoeuvres ask for more" + grip + "; and 1 more");
  told.result.ranking.pop_back();
  ASSERT_EQ(told.doubts().size(), 1U);
  EXPECT_EQ(told.doubts()[0], "3 manoeuvres ask for more" + grip);
}

TEST(Doubts, PlansThatEndWhileMovingOrBeginAtAnotherSpeedAreTold) {
  Sound told;
  Candidate& misses = told.result.candidates[0];
  misses.motion = planned(20.0, 20.0, 2.0);
  ASSERT_EQ(told.doubts().size(), 1U);
  EXPECT_NE(told.doubts()[0].find("'miss', in place 1, at 2 s and 20.0 m/s"), std::string::npos);
  misses.motion = planned(20.0, 20.0, 3.0);  // as long as the horizon
  EXPECT_TRUE(told.doubts().empty());
  misses.motion = planned(20.0, 0.0, 2.0);  // it has come to rest
  EXPECT_TRUE(told.doubts().empty());
  misses.motion = planned(1.0, 0.0, 2.0);
  ASSERT_EQ(told.doubts().size(), 1U);
  EXPECT_NE(told.doubts()[0].find("another speed than the ego's 20.0 m/s: 'miss', in place 1, at "
                                  "1.0 m/s"),
            std::string::npos)
      << told.doubts()[0];
  // What ends after the contact is not followed that far.
  misses.motion = Motion();
  told.result.candidates[1].motion = planned(20.0, 20.0, 1.0);
  EXPECT_TRUE(told.doubts().empty());
}

TEST(Doubts, ActorsWhosePosesEndWhileTheyMoveAreTold) {
  Sound told;
  Pose away;
  away.translation.x() = 4.0;
  told.scenario.actors[1].poses = {{0.0, {}}, {0.2, away}};
  ASSERT_EQ(told.doubts().size(), 2U);
  EXPECT_NE(told.doubts()[0].find("'second', at 0.2 s and 20.0 m/s"), std::string::npos);
  EXPECT_NE(told.doubts()[1].find("1 actor has a motion, but its body is fixed"),
            std::string::npos);
}

TEST(Doubts, PredictionsWhosePosesEndWhileTheyMoveAreTold) {
  Sound told;
  told.result.actors[1].mass_kg = 1200.0;
  Pose away;
  away.translation.x() = 4.0;
  Prediction stays;
  stays.probability = 0.9;
  Prediction goes;
  goes.probability = 0.1;
  goes.poses = {{0.0, {}}, {0.2, away}};
  told.scenario.actors[1].predictions = {stays, goes};
  told.expect_one("the poses of 1 actor end before the horizon (3 s) while moving");
}

TEST(Doubts, MeshesThatSeemTurnedAreToldWithTheAxesThatMendIt) {
  const Eigen::Vector3d away(30.0, 0.0, 0.0);
  Sound fine;
  fine.set_car(box_body(4.5, 1.8, 1.4), 1500.0, away);
  EXPECT_TRUE(fine.doubts().empty()) << testing::PrintToString(fine.doubts());
  Sound sideways;
  sideways.set_car(box_body(1.8, 4.5, 1.4), 1500.0, away);
  sideways.expect_one(
      "models.other car: the car is 1.8 x 4.5 x 1.4 m (length x width x height): it seems turned, "
      "by its size; read its mesh with up +z and forward +y or the opposite");
  Sound upright;
  upright.set_car(box_body(1.8, 1.4, 4.5), 1500.0, away);
  upright.expect_one(
      "models.other car: the car is 1.8 x 1.4 x 4.5 m (length x width x height): it seems turned, "
      "by its size; read its mesh with up +y and forward +z or the opposite");
  // Lorries are higher than wide.
  Sound lorry;
  lorry.set_car(box_body(2.5, 4.0, 16.5), 15000.0, away);
  lorry.scenario.models.back().kind = BodyKind::truck;
  EXPECT_NE(lorry.doubts()[0].find("up +y and forward +z or the opposite"), std::string::npos)
      << lorry.doubts()[0];
  // Named in the axes of the file, whatever it was read with.
  upright.scenario.models.back().transform.forward = Axis::plus_y;
  upright.scenario.models.back().transform.up = Axis::plus_x;
  EXPECT_NE(upright.doubts()[0].find("up +z and forward +x or the opposite"), std::string::npos)
      << upright.doubts()[0];
}

TEST(Doubts, SizesAndStatedMassesThatNoBodyOfTheKindHasAreTold) {
  const Eigen::Vector3d away(30.0, 0.0, 0.0);
  Sound huge;
  huge.set_car(box_body(12.0, 2.5, 2.0), 1500.0, away);
  huge.expect_one(
      "models.other car: the car is 12 x 2.5 x 2 m (length x width x height), but such a body is 2 "
      "to 7.5 m long; check its scale");
  huge.scenario.models.back().kind = BodyKind::bus;
  EXPECT_TRUE(huge.doubts().empty());
  Sound tram;
  tram.set_car(box_body(30.0, 2.3, 3.6), 46800.0, away);
  tram.scenario.models.back().kind = BodyKind::bus;
  EXPECT_TRUE(tram.doubts().empty()) << testing::PrintToString(tram.doubts());
  Sound light;
  light.set_car(box_body(4.5, 1.8, 1.4), 1.7, away);
  light.expect_one(
      "models.other car: the car has a mass of 1.7 kg, but such a body has 250 to 6000 kg");
  light.result.actors[1].mass_guessed = true;
  EXPECT_TRUE(light.doubts().empty());
}

TEST(Doubts, BodiesThatFloatAreTold) {
  Sound told;
  told.set_car(box_body(4.5, 1.8, 1.4), 1500.0, {30.0, 0.0, 1.0});
  EXPECT_TRUE(told.doubts().empty()) << "the road may climb";
  told.scenario.actors[1].pose.translation = {6.0, 0.0, 1.2};
  told.expect_one("1 body floats above the ground that the ego stands on: 'second' by 1.2 m");
  told.scenario.actors[1].pose.translation.z() = -1.3;
  told.expect_one("the ego floats: it stands 1.3 m or more above the other");
}

TEST(Doubts, BodiesThatTheirPoseLaysDownAreTold) {
  Sound told;
  told.set_car(box_body(4.5, 1.8, 1.4), 1500.0, {30.0, 0.0, 0.9});
  Pose& pose = told.scenario.actors[1].pose;
  pose.rotation = pose_from_angles({0, 0, 0}, 0.3, 0.0, 0.6).rotation;
  EXPECT_TRUE(told.doubts().empty()) << testing::PrintToString(told.doubts());
  pose.rotation = pose_from_angles({0, 0, 0}, 0.3, 0.0, 1.5707963267948966).rotation;
  told.expect_one(
      "1 body is turned out of the upright by the pose, but crashes as if it stood: 'second' by 90 "
      "degrees (models.other car); give the model the axes up and forward that lay its mesh");
}

TEST(Doubts, BodiesOnOneSlopeDoNotFloat) {
  constexpr double rad_per_deg = 0.017453292519943295;
  for (const double pitch : {-8.0 * rad_per_deg, 8.0 * rad_per_deg}) {
    Sound told;
    const auto on_slope = [pitch](double along_m, double above_m) {
      return pose_from_angles({along_m * std::cos(pitch), 0.0, above_m - along_m * std::sin(pitch)},
                              0.0, pitch, 0.0);
    };
    told.set_car(box_body(4.5, 1.8, 1.4), 1500.0, {50.0, 0.0, 0.0});
    Pose& second = told.scenario.actors[1].pose;
    // A level wall among the others.
    told.scenario.actors[0].pose.translation = on_slope(30.0, 0.0).translation;
    for (const double turned : {0.0, 3.141592653589793}) {
      told.scenario.ego.pose = on_slope(0.0, 0.0);
      second = on_slope(50.0, 0.0);
      second.rotation = second.rotation * pose_from_angles({0, 0, 0}, turned, 0.0, 0.0).rotation;
      EXPECT_TRUE(told.doubts().empty()) << testing::PrintToString(told.doubts());
      // The slope begins before a level ego.
      told.scenario.ego.pose = {};
      EXPECT_TRUE(told.doubts().empty()) << testing::PrintToString(told.doubts());
    }
    told.scenario.ego.pose = on_slope(0.0, 0.0);
    second = on_slope(20.0, 3.0);
    told.expect_one("1 body floats above the ground that the ego stands on: 'second' by 3 m");
  }
}

TEST(Doubts, ContactsWithoutForceAreNamedAndTheFirstPlaceThatRestsOnOne) {
  Sound told;
  told.result.ranking[1].contacts[1].contact_without_force = true;
  told.expect_one(
      "1 candidate has bodies that touch at more than 0.5 m/s, but the crash model finds no force "
      "in time, so that scores may be too low: 'hit', in place 2, with 'second' at 10.0 m/s (up to "
      "3 persons)");
  told.result.ranking[1].place = 1;
  ASSERT_EQ(told.doubts().size(), 2U);
  EXPECT_EQ(told.doubts()[0],
            "the first place rests on a contact without force: 'hit', in place 1, with 'second' at "
            "10.0 m/s (up to 3 persons)");
  told.result.ranking[1].contacts[0].contact_without_force = true;
  const std::string text = ranking_text(told.scenario, told.models, told.result);
  EXPECT_NE(text.find("wall (no force)"), std::string::npos) << text;
  const std::string page = html_report(told.scenario, told.models, told.result);
  EXPECT_NE(page.find("wall (no force)"), std::string::npos);
  EXPECT_NE(page.find("Doubtful: the first place rests on"), std::string::npos);
  EXPECT_NE(page.find("second (no force)"), std::string::npos);
  EXPECT_NE(ranking_json(told.scenario, told.models, told.result, {})
                .find(R"("contact_without_force": true)"),
            std::string::npos);
}

TEST(Doubts, ContactsWithoutForceInAnotherFutureCount) {
  Sound told = with_unlikely_contact(0.25, ImpactState::contact, 30.0);
  told.result.ranking[0].futures[1].contact_without_force = true;
  told.result.ranking[0].score_interval.highest = 1.5;
  ASSERT_EQ(told.doubts().size(), 2U);
  EXPECT_EQ(told.doubts()[0],
            "the first place rests on a contact without force: 'miss', in place 1, with 'wall' "
            "in a future that is not the likeliest (up to 1.5 persons)");
}

TEST(Doubts, BodiesWithoutOutlineAreNamedAndMayHangOverTheRoad) {
  Sound told;
  told.set_car(box_body(4.5, 1.8, 1.4), 1500.0, {6.0, 0.0, 5.0});
  told.result.actors[1].has_outline = false;
  told.expect_one(
      "1 body has no material between 0.1 and 4 m over the ground of its model, so that nothing "
      "presses on it and it adds no harm: 'second'; if that is wrong");
  // A contact with it has no force for that reason, and is told here alone.
  told.result.ranking[1].contacts[1].contact_without_force = true;
  told.expect_one(
      "1 body has no material between 0.1 and 4 m over the ground of its model, so that nothing "
      "presses on it and it adds no harm: 'second' (touched by 1 candidate); if that is wrong");
  told.result.ranking[1].place = 1;
  told.expect_one(
      "1 body has no material between 0.1 and 4 m over the ground of its model, so that nothing "
      "presses on it and it adds no harm: 'second' (touched by 1 candidate, the first place among "
      "them); if that is wrong");
  told.result.ranking[1].contacts[0].contact_without_force = true;
  EXPECT_EQ(told.doubts().size(), 3U);
}

TEST(Doubts, AStepThatWheelsMayMountIsTold) {
  constexpr double fixed = std::numeric_limits<double>::infinity();
  Sound told;
  told.set_car(box_body(4.0, 0.3, 0.2), fixed, {30.0, 0.0, 0.0});
  told.expect_one(
      "1 body is hit, fixed and no higher than a wheel's radius, so that wheels may mount it: ");
  told.set_car(box_body(4.0, 0.3, 0.5), fixed, {30.0, 0.0, 0.0});
  for (const std::string& doubt : told.doubts()) {
    EXPECT_EQ(doubt.find("wheels may mount"), std::string::npos) << doubt;
  }
}

TEST(Doubts, TwoOthersThatOverlapAtTimeZeroAreTold) {
  Sound told;
  told.set_car(box_body(4.5, 1.8, 1.4), 1500.0, {30.0, 0.0, 0.0});
  told.scenario.actors.push_back(told.scenario.actors[1]);
  told.scenario.actors[2].name = "third";
  told.result.actors.push_back(told.result.actors[1]);
  const std::string words = "1 pair of bodies overlaps at time 0: 'second' and 'third'";
  told.expect_one(words);
  told.scenario.actors[2].pose.translation = {34.4, 1.7, 0.0};
  told.expect_one(words);
  told.scenario.actors[2].pose.translation = {34.6, 1.7, 0.0};
  EXPECT_TRUE(told.doubts().empty());
  // One wholly inside the other: no triangles meet.
  told.models.push_back(box_body(2.1, 1.0, 0.8));
  told.scenario.models.push_back(told.scenario.models.back());
  told.scenario.actors[2].model = told.result.actors[2].model = told.models.size() - 1;
  told.scenario.actors[2].pose.translation = {31.0, 0.4, 0.3};
  told.expect_one(words);
}

TEST(Doubts, JsonListsThemAfterTheWarningsGiven) {
  Sound told;
  told.scenario.keys_without_effect = {"crush"};
  const std::vector<std::string> given{"car.obj: \"odd\""};
  const std::string json = ranking_json(told.scenario, told.models, told.result, given);
  EXPECT_NE(json.find(R"("warnings": [
    "car.obj: \"odd\"",
    "the scenario sets crush, which is without effect; leave it out"
  ])"),
            std::string::npos)
      << json;
}

TEST(Doubts, ThePageTellsThem) {
  Sound told;
  EXPECT_EQ(html_report(told.scenario, told.models, told.result).find("Doubtful"),
            std::string::npos);
  told.result.ranking[1].contacts[0].closing_speed_mps = 150.0;
  EXPECT_NE(html_report(told.scenario, told.models, told.result)
                .find("Doubtful: 1 candidate leads to a contact"),
            std::string::npos);
}

}  // namespace
}  // namespace crashrank

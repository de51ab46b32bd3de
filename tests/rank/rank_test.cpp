#include "crashrank/rank/rank.hpp"

#include "crashrank/model/make_model.hpp"

#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using scenes::box_mesh;
using scenes::car_and_wall;
using scenes::of;
using scenes::Scene;

using Names = std::vector<std::string>;

// Contact is reported at a gap of 0.1 mm.
constexpr double tolerance_m = 1e-4;

TEST(Rank, ABoxHitsAWallAfterDistanceOverSpeed) {
  Scene scene = car_and_wall();
  scene.scenario.grip = 1.0;
  scene.add_candidate("keep going", 0.0);
  scene.add_candidate("brake", -3.0);
  scene.add_candidate("stop", -8.0);
  const RankResult result = scene.ranked();

  const CandidateResult& keep = of(result, "keep going");
  ASSERT_EQ(keep.contacts.size(), 1U);
  const Contact& contact = keep.contacts[0];
  EXPECT_EQ(contact.actor, 0U);
  EXPECT_EQ(contact.state, ImpactState::contact);
  EXPECT_LE(contact.time_of_impact_s, 47.5 / 20.0);
  EXPECT_GE(contact.time_of_impact_s, (47.5 - 2 * tolerance_m) / 20.0);
  EXPECT_LE(contact.gap_m, tolerance_m);
  EXPECT_NEAR(contact.closing_speed_mps, 20.0, 1e-9);
  EXPECT_NEAR(contact.normal_speed_mps, 20.0, 1e-3);
  EXPECT_NEAR(contact.normal.x(), 1.0, 1e-6);
  EXPECT_NEAR(contact.point_m.x(), 49.5, tolerance_m);
  EXPECT_NEAR(contact.closing_energy_j, 0.5 * 1500.0 * 400.0, 1e-3);
  EXPECT_EQ(contact.crush_s, contact.severity.duration_s);
  EXPECT_GT(contact.crush_s, 0.0);
  EXPECT_NEAR(contact.ego.pose.translation.x(), 47.5, 2 * tolerance_m);

  const double braked = std::sqrt(400.0 - 2.0 * 3.0 * 47.5);
  const CandidateResult& brake = of(result, "brake");
  ASSERT_EQ(brake.contacts.size(), 1U);
  EXPECT_NEAR(brake.contacts[0].time_of_impact_s, (20.0 - braked) / 3.0, 1e-4);
  EXPECT_NEAR(brake.contacts[0].closing_speed_mps, braked, 1e-3);

  // 20² / (2·8) = 25 m are enough to stop.
  const CandidateResult& stop = of(result, "stop");
  EXPECT_FALSE(stop.collides);
  EXPECT_EQ(stop.score, 0.0);
  EXPECT_EQ(&stop, &result.ranking.front());
}

/// Turns everything about the line across the road through the origin.
void tilt(Scenario& scenario, double pitch_rad) {
  const Pose slope = pose_from_angles({0.0, 0.0, 0.0}, 0.0, pitch_rad, 0.0);
  const auto turn = [&slope](Pose& pose) {
    pose = {slope.rotation * pose.rotation, slope.rotation * pose.translation};
  };
  turn(scenario.ego.pose);
  for (ScenarioActor& actor : scenario.actors) turn(actor.pose);
}

TEST(Rank, ASceneOnASlopeHasTheContactsOfTheLevelOne) {
  Scene level = car_and_wall(1800.0);
  level.scenario.measure = Measure::closing_energy;
  level.scenario.actors[0].pose = pose_from_angles({50.0, 0.5, 0.0}, M_PI, 0.0, 0.0);
  level.scenario.actors[0].speed_mps = 5.0;
  level.add_candidate("keep going", 0.0);
  level.add_candidate("brake", -3.0);
  level.add_candidate("steer", -1.0, 0.02);
  const RankResult expected = level.ranked();
  for (const double pitch_rad : {0.14, -0.1}) {
    Scene slope = level;
    tilt(slope.scenario, pitch_rad);
    const RankResult result = slope.ranked();
    for (const char* name : {"keep going", "brake", "steer"}) {
      const CandidateResult& on_level = of(expected, name);
      const CandidateResult& on_slope = of(result, name);
      ASSERT_FALSE(on_level.contacts.empty());
      ASSERT_FALSE(on_slope.contacts.empty()) << name;
      const Contact& contact = on_slope.contacts.front();
      EXPECT_NEAR(contact.time_of_impact_s, on_level.contacts.front().time_of_impact_s, 1e-4);
      EXPECT_NEAR(contact.closing_speed_mps, on_level.contacts.front().closing_speed_mps, 1e-3);
      EXPECT_NEAR(contact.normal_speed_mps, on_level.contacts.front().normal_speed_mps, 1e-3);
      EXPECT_NEAR(*on_slope.score, *on_level.score, 1e-3 * *on_level.score) << name;
    }
  }
}

TEST(Rank, ClosingEnergyUsesTheReducedMass) {
  for (const double other_kg : {75.0, 1500.0, 40000.0}) {
    Scene scene = car_and_wall(other_kg);
    scene.scenario.actors[0].pose = pose_from_angles({50.0, 0.0, 0.0}, M_PI, 0.0, 0.0);
    scene.scenario.actors[0].speed_mps = 10.0;
    scene.add_candidate("keep going", 0.0);
    const RankResult result = scene.ranked(Measure::closing_energy);
    const double reduced = 1500.0 * other_kg / (1500.0 + other_kg);
    ASSERT_TRUE(result.ranking[0].score.has_value());
    EXPECT_NEAR(*result.ranking[0].score, 0.5 * reduced * 900.0, 1e-6 * reduced * 900.0);
    EXPECT_NEAR(result.ranking[0].contacts[0].time_of_impact_s, 47.5 / 30.0, 1e-5);
  }
}

TEST(Rank, DamageExtendsAsFarAsTheCrush) {
  Scene scene = car_and_wall();
  scene.add_candidate("keep going", 0.0);
  const RankResult result = scene.ranked(Measure::area);
  ASSERT_EQ(result.ranking[0].contacts.size(), 1U);
  const Contact& contact = result.ranking[0].contacts[0];
  const Model& car = scene.models[0];
  const Model& wall = scene.models[1];
  // The front is inside the wall, the four sides extend into it, the rear does not.
  EXPECT_EQ(scenes::part_names(car, contact.ego),
            (Names{"front", "right", "left", "bottom", "top"}));
  EXPECT_EQ(contact.ego.triangles.size(), 10U);
  EXPECT_NEAR(contact.ego.area_m2, 2 * 1.5 + 2 * (4 * 1.5) + 2 * (4 * 2), 1e-6);
  // The car touches only the near side of the wall.
  EXPECT_EQ(scenes::part_names(wall, contact.other), (Names{"rear"}));
  EXPECT_GT(contact.travel_m, 0.3);
  EXPECT_LT(contact.travel_m, 0.9);
  ASSERT_TRUE(result.ranking[0].score.has_value());
  EXPECT_NEAR(*result.ranking[0].score, contact.ego.area_m2 + contact.other.area_m2, 1e-9);
  // The region of contact: the crushed part of the front of the car, and the middle 2 × 1.5 m of
  // the wall.
  EXPECT_NEAR(contact.ego.region.min.x(), 2.0 - contact.travel_m, 1e-3);
  EXPECT_NEAR(contact.ego.region.max.x(), 2.0, 1e-3);
  EXPECT_NEAR(contact.other.region.extent().y(), 2.0, 1e-3);
  EXPECT_NEAR(contact.other.region.extent().z(), 1.5, 1e-3);
}

TEST(Rank, HigherSpeedNeverMeansLessDamage) {
  double before = 0.0;
  for (const double speed : {1.0, 4.0, 8.0, 14.0, 20.0, 30.0}) {
    Scene scene = car_and_wall();
    scene.models.clear();
    scene.models.push_back(*make_model(box_mesh({2, 1, 0.75}, 12)));
    scene.models.push_back(*make_model(box_mesh({0.5F, 10, 3}, 20)));
    scene.scenario.ego.speed_mps = speed;
    scene.scenario.horizon_s = 50.0;
    scene.add_candidate("keep going", 0.0);
    const RankResult result = scene.ranked(Measure::area);
    ASSERT_TRUE(result.ranking[0].score.has_value());
    EXPECT_GT(*result.ranking[0].score, 0.0) << speed;
    EXPECT_GE(*result.ranking[0].score, before) << speed;
    before = *result.ranking[0].score;
  }
}

// A pole that is pressed deep into the car leaves a furrow from the front edge to its deepest
// position, not only damage at that position.
TEST(Rank, AThinBodyLeavesAFurrow) {
  Scene scene;
  scene.scenario.ego.model =
      scene.add_model("car", box_mesh({2, 1, 0.75}, 40), BodyKind::car, 1500.0);
  scene.scenario.ego.speed_mps = 30.0;
  const std::size_t pole = scene.add_model("pole", box_mesh({0.05F, 0.05F, 3}), BodyKind::pole);
  scene.add_actor("pole", pole, 20.0, 0.3);
  scene.add_candidate("keep going", 0.0);
  const RankResult result = scene.ranked();
  const Contact& contact = result.ranking[0].contacts.at(0);
  const TriangleMesh& mesh = scene.models[0].mesh;
  const auto top_damaged = [&](double x) {
    return std::any_of(contact.ego.triangles.begin(), contact.ego.triangles.end(),
                       [&](std::uint32_t index) {
                         Box box;
                         for (const auto v : mesh.triangles[index]) box.grow(mesh.vertices[v]);
                         return box.min.z() > 0.74F && box.min.x() <= x && x <= box.max.x() &&
                                std::abs(box.center().y() - 0.3F) < 0.1F;
                       });
  };
  ASSERT_GT(contact.travel_m, 0.5);
  const double end = 2.0 - contact.travel_m;
  for (double x = 1.95; x > end + 0.05; x -= 0.1) EXPECT_TRUE(top_damaged(x)) << x;
  EXPECT_FALSE(top_damaged(end - 0.3));
}

TEST(Rank, ABodyInsideAnotherIsAContactAtTimeZero) {
  Scene scene;
  scene.scenario.ego.model = scene.add_model("car", box_mesh({2, 1, 0.75}), BodyKind::car, 1500.0);
  scene.scenario.ego.speed_mps = 5.0;
  const std::size_t hall = scene.add_model("hall", box_mesh({60, 60, 9}), BodyKind::building);
  const std::size_t ball =
      scene.add_model("bag", box_mesh({0.2F, 0.2F, 0.2F}), BodyKind::pedestrian, 10.0);
  scene.add_candidate("keep going", 0.0);

  scene.add_actor("hall", hall, 0.0, 0.0);
  RankResult result = scene.ranked();
  ASSERT_EQ(result.ranking[0].contacts.size(), 1U);
  EXPECT_EQ(result.ranking[0].contacts[0].state, ImpactState::contained);
  EXPECT_EQ(result.ranking[0].contacts[0].time_of_impact_s, 0.0);
  EXPECT_EQ(result.ranking[0].contacts[0].ego.triangles.size(), 12U);
  EXPECT_TRUE(result.ranking[0].contacts[0].other.triangles.empty());
  EXPECT_EQ(result.ranking[0].score, 12.0);

  scene.scenario.actors.clear();
  scene.add_actor("bag", ball, 0.5, 0.0);
  result = scene.ranked();
  ASSERT_EQ(result.ranking[0].contacts.size(), 1U);
  EXPECT_EQ(result.ranking[0].contacts[0].state, ImpactState::contained);
  EXPECT_EQ(result.ranking[0].contacts[0].other.triangles.size(), 12U);
  EXPECT_NEAR(result.ranking[0].contacts[0].closing_speed_mps, 5.0, 1e-12);
}

TEST(Rank, BodiesThatOverlapAtTheStartCollideAtTimeZero) {
  Scene scene = car_and_wall();
  scene.scenario.actors[0].pose.translation.x() = 2.2;
  scene.add_candidate("keep going", 0.0);
  scene.add_candidate("back out", -8.0);
  const RankResult result = scene.ranked();
  for (const CandidateResult& candidate : result.ranking) {
    ASSERT_EQ(candidate.contacts.size(), 1U);
    EXPECT_EQ(candidate.contacts[0].state, ImpactState::overlapping);
    EXPECT_EQ(candidate.contacts[0].time_of_impact_s, 0.0);
    EXPECT_GT(*candidate.score, 0.0);
  }
}

TEST(Rank, CandidatesWithoutContactRankFirst) {
  Scene scene = car_and_wall();
  scene.scenario.horizon_s = 3.0;
  scene.scenario.grip = 1.0;
  scene.add_candidate("hit", 0.0);
  scene.add_candidate("stop", -9.0);
  scene.add_candidate("stop gently", -5.0);
  const RankResult result = scene.ranked();
  ASSERT_EQ(result.ranking.size(), 3U);
  // Equal in all respects and more than 5 m from the wall: the order of the candidates decides.
  EXPECT_EQ(result.candidates[result.ranking[0].candidate].name, "stop");
  EXPECT_EQ(result.candidates[result.ranking[1].candidate].name, "stop gently");
  EXPECT_EQ(result.candidates[result.ranking[2].candidate].name, "hit");
  for (int i = 0; i < 2; ++i) {
    const CandidateResult& clear = result.ranking[static_cast<std::size_t>(i)];
    EXPECT_FALSE(clear.collides);
    EXPECT_TRUE(clear.contacts.empty());
    EXPECT_EQ(clear.score, 0.0);
    EXPECT_EQ(clear.score_interval.highest, 0.0);
    EXPECT_TRUE(clear.ego.triangles.empty());
  }
  EXPECT_TRUE(result.complete);
  EXPECT_TRUE(result.proved);
  EXPECT_EQ(result.in_race, std::vector<std::size_t>{1U});
}

TEST(Rank, AScenarioWithoutActorsHarmsNobody) {
  Scene scene = car_and_wall();
  scene.scenario.actors.clear();
  scene.scenario.grid = CandidateGrid{};
  const RankResult result = scene.ranked();
  EXPECT_EQ(result.ranking.size(), 225U);
  for (const CandidateResult& candidate : result.ranking) EXPECT_FALSE(candidate.collides);
  EXPECT_EQ(result.work.body_pairs, 0U);
}

TEST(Rank, TheHorizonEndsTheSearch) {
  Scene scene = car_and_wall();
  scene.add_candidate("keep going", 0.0);
  scene.scenario.horizon_s = 2.3;
  EXPECT_FALSE(scene.ranked().ranking[0].collides);
  scene.scenario.horizon_s = 2.4;
  EXPECT_TRUE(scene.ranked().ranking[0].collides);
}

TEST(Rank, TiesAreBrokenByLaterThenSlowerContact) {
  // The same damage of a car with few triangles, at different times and speeds.
  Scene scene = car_and_wall();
  scene.add_candidate("as it is", 0.0);
  scene.add_candidate("later", -2.0);
  scene.add_candidate("sooner", 2.0);
  const RankResult result = scene.ranked();
  EXPECT_EQ(result.ranking[0].score, result.ranking[2].score);
  EXPECT_EQ(result.candidates[result.ranking[0].candidate].name, "later");
  EXPECT_EQ(result.candidates[result.ranking[1].candidate].name, "as it is");
  EXPECT_EQ(result.candidates[result.ranking[2].candidate].name, "sooner");
}

TEST(Rank, AllBodiesHitAtOnceCount) {
  Scene scene;
  scene.scenario.ego.model = scene.add_model("car", box_mesh({2, 1, 0.75}), BodyKind::car, 1500.0);
  scene.scenario.ego.speed_mps = 20.0;
  const std::size_t block =
      scene.add_model("block", box_mesh({0.3F, 0.3F, 0.5F}), BodyKind::pedestrian, 75.0);
  scene.add_candidate("keep going", 0.0);
  scene.add_actor("behind", block, 40.0, 0.0);
  scene.add_actor("second", block, 20.5, 0.6);
  scene.add_actor("first", block, 20.0, -0.6);
  const RankResult result = scene.ranked(Measure::closing_energy);
  const CandidateResult& keep = result.ranking[0];
  ASSERT_GE(keep.contacts.size(), 2U);
  EXPECT_EQ(keep.contacts[0].actor, 2U);
  EXPECT_EQ(keep.contacts[1].actor, 1U);
  EXPECT_NEAR(keep.contacts[1].time_of_impact_s - keep.contacts[0].time_of_impact_s, 0.025, 2e-3);
  const double one = 0.5 * (1500.0 * 75.0 / 1575.0) * 400.0;
  EXPECT_NEAR(keep.contacts[0].closing_energy_j, one, 1e-6 * one);
  // The first contact took a twentieth of the speed by then.
  EXPECT_LT(keep.contacts[1].closing_energy_j, one);
  EXPECT_GT(keep.contacts[1].closing_energy_j, 0.8 * one);
  double sum = 0.0;
  // The first contact of every pair.
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  for (const Contact& contact : keep.contacts) {
    if (pairs.insert({ego_body, contact.actor}).second) sum += contact.closing_energy_j;
  }
  for (const FurtherContact& contact : keep.further) {
    if (pairs.insert({contact.a, contact.b}).second) sum += contact.closing_energy_j;
  }
  EXPECT_NEAR(*keep.score, sum, 1e-9 * sum);
  // The triangles of the car count once for all bodies that it touches.
  std::vector<std::uint32_t> both;
  for (const Contact& contact : keep.contacts) {
    both.insert(both.end(), contact.ego.triangles.begin(), contact.ego.triangles.end());
  }
  std::sort(both.begin(), both.end());
  both.erase(std::unique(both.begin(), both.end()), both.end());
  EXPECT_EQ(keep.ego.triangles, both);
}

TEST(Rank, MassesAreGivenOrDerivedFromSize) {
  Scene scene = car_and_wall();
  scene.scenario.models[0].mass_kg.reset();
  scene.add_candidate("keep going", 0.0);
  const RankResult result = scene.ranked();
  EXPECT_TRUE(result.ego.mass_guessed);
  EXPECT_EQ(result.ego.mass_kg, guess_mass_kg(BodyKind::car, {4.0, 2.0, 1.5}));
  EXPECT_TRUE(std::isinf(result.actors.at(0).mass_kg));
}

TEST(Rank, UndecidedSearchesGiveAnInterval) {
  Scene scene = car_and_wall();
  scene.models[0] = *make_model(box_mesh({2, 1, 0.75}, 12));
  scene.add_candidate("keep going", 0.0);
  scene.add_candidate("stop", -9.0);
  for (const Measure measure :
       {Measure::polygons, Measure::area, Measure::closing_energy, Measure::delta_v,
        Measure::energy, Measure::intrusion, Measure::harm}) {
    const RankResult full = scene.ranked(measure);
    RankOptions options;
    options.measure = measure;
    options.impact.max_steps = 1;
    const RankResult cut = scene.ranked(options);
    EXPECT_FALSE(cut.complete);
    for (const CandidateResult& candidate : cut.ranking) {
      const std::string& name = cut.candidates[candidate.candidate].name;
      const double score = *of(full, name).score;
      EXPECT_LE(candidate.score_interval.lowest, score) << name;
      EXPECT_GE(candidate.score_interval.highest, score) << name;
      EXPECT_TRUE(std::isfinite(candidate.score_interval.highest));
      EXPECT_EQ(candidate.score.value_or(score), score);
    }
    // The first candidate of the complete answer is still in the race.
    const std::size_t first = full.ranking[0].candidate;
    EXPECT_NE(std::find(cut.in_race.begin(), cut.in_race.end(), first), cut.in_race.end());
  }
}

}  // namespace
}  // namespace crashrank

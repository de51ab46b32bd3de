// Guarantees of docs/guide/faults.md for unreasonable input.

#include "crashrank/model/make_model.hpp"
#include "crashrank/rank/anytime/ranker.hpp"

#include "oracle/random.hpp"
#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

namespace crashrank {
namespace {

using scenes::box_mesh;
using scenes::of;
using scenes::Scene;

Scene car_and_wall(double gap_m) {
  Scene scene;
  for (const char* name : {"car", "wall"}) {
    scene.scenario.models.emplace_back();
    scene.scenario.models.back().name = name;
    scene.scenario.models.back().mass_kg = 1500.0;
    scene.models.push_back(*make_model(box_mesh({2, 1, 0.75})));
  }
  scene.scenario.grid.reset();
  scene.scenario.add_straight_braking = false;
  scene.add_actor("wall", 1, 4.0 + gap_m, 0.0);
  return scene;
}

TEST(Fault, AHundredThousandCandidatesAreRanked) {
  Scene scene = car_and_wall(50.0);
  scene.scenario.ego.speed_mps = 10.0;
  scene.scenario.horizon_s = 1.0;
  for (int i = 0; i < 100'000; ++i) scene.add_candidate(std::to_string(i), -1e-5 * i);
  const RankResult result = scene.ranked();
  ASSERT_EQ(result.ranking.size(), 100'000U);
  EXPECT_TRUE(result.complete);
  EXPECT_EQ(*result.ranking.back().score, 0.0);
}

/// A thousand cars, posts and walls piled up before the ego.
Scene thousand_in_a_pile(double around_m) {
  Scene scene = car_and_wall(0.0);
  scene.scenario.actors.clear();
  scene.scenario.models[0].kind = BodyKind::car;
  scene.scenario.models[1].kind = BodyKind::car;
  scene.add_model("post", box_mesh({0.1F, 0.1F, 1.0F}), BodyKind::pole);
  scene.add_model("person", box_mesh({0.2F, 0.25F, 0.9F}), BodyKind::pedestrian);
  oracle::Random random(451);
  for (std::size_t i = 0; i < scenario_limits::actors; ++i) {
    scene.add_actor(std::to_string(i), 1 + i % 3, 12.0 + random.real(0.0, around_m),
                    random.real(-0.5, 0.5) * around_m, random.real(-3.0, 3.0));
  }
  scene.scenario.ego.speed_mps = 20.0;
  scene.scenario.horizon_s = 2.0;
  scene.add_candidate("on", 0.0);
  return scene;
}

TEST(Fault, AThousandActorsInOnePileAreRanked) {
  for (const double around_m : {0.5, 30.0}) {
    for (const double grip : {0.8, scenario_limits::min_grip}) {
      Scene scene = thousand_in_a_pile(around_m);
      scene.scenario.grip = grip;
      for (const Measure measure : {Measure::harm, Measure::delta_v, Measure::energy}) {
        scene.scenario.harm.intervals = false;
        const RankResult result = scene.ranked(measure);
        ASSERT_EQ(result.ranking.size(), 1U);
        const CandidateResult& on = result.ranking.front();
        EXPECT_TRUE(on.collides);
        ASSERT_TRUE(on.score.has_value());
        EXPECT_TRUE(std::isfinite(*on.score));
        EXPECT_GT(*on.score, 0.0);
        // A step is at least 1/8 ms and a scene at most 30 s long.
        EXPECT_LE(result.work.crash_steps, 240'002U);
        EXPECT_LE(on.contacts.size() + on.further.size(), 65U);
        if (measure != Measure::harm) continue;
        std::printf("1,000 actors within %.1f m, grip %.2f: %llu steps, %zu contacts, %s\n",
                    around_m, grip, static_cast<unsigned long long>(result.work.crash_steps),
                    on.contacts.size() + on.further.size(), on.crowded ? "crowded" : "");
      }
    }
  }
}

TEST(Fault, AnEgoAtRestCanBeHit) {
  Scene scene = car_and_wall(10.0);
  scene.scenario.horizon_s = 2.0;
  scene.add_candidate("stand", 0.0);
  EXPECT_FALSE(of(scene.ranked(), "stand").collides) << "both stand";
  scene.scenario.actors[0].speed_mps = -10.0;
  const RankResult result = scene.ranked();
  const CandidateResult& hit = of(result, "stand");
  ASSERT_TRUE(hit.collides);
  EXPECT_NEAR(hit.contacts[0].time_of_impact_s, 1.0, 1e-4);
  EXPECT_NEAR(hit.contacts[0].closing_speed_mps, 10.0, 1e-9);
  EXPECT_GT(*hit.score, 0.0);
  // Nothing moves and the surfaces touch: a contact at time 0 without speed, for every measure.
  Scene resting = car_and_wall(-0.5);
  resting.add_candidate("stand", 0.0);
  for (const Measure measure :
       {Measure::polygons, Measure::area, Measure::closing_energy, Measure::delta_v,
        Measure::energy, Measure::intrusion, Measure::harm}) {
    const RankResult still = resting.ranked(measure);
    const CandidateResult& stand = of(still, "stand");
    ASSERT_EQ(stand.contacts.size(), 1U);
    EXPECT_EQ(stand.contacts[0].state, ImpactState::overlapping);
    EXPECT_EQ(stand.contacts[0].time_of_impact_s, 0.0);
    EXPECT_EQ(stand.contacts[0].closing_speed_mps, 0.0);
    ASSERT_TRUE(stand.score.has_value());
    EXPECT_TRUE(std::isfinite(*stand.score));
  }
}

TEST(Fault, AnEgoWithoutAnOutlineIsRefusedByNameAndAnActorIsNoCrashPartner) {
  TriangleMesh point;
  point.vertices = {{0, 0, 0}};
  point.triangles = {{0, 0, 0}};
  TriangleMesh plate;
  plate.vertices = {{0, -1, 0}, {0, 1, 0}, {1, 0, 0}};
  plate.triangles = {{0, 1, 2}};
  for (const TriangleMesh& mesh : {point, plate}) {
    Scene scene = car_and_wall(10.0);
    scene.models[1] = *make_model(mesh);
    scene.add_candidate("keep going", 0.0);
    Result<RankResult> result = rank(scene.scenario, scene.models);
    ASSERT_TRUE(result.ok());
    EXPECT_FALSE(result->actors[0].has_outline);
    EXPECT_EQ(*result->ranking.front().score, 0.0);
    std::swap(scene.models[0], scene.models[1]);
    result = rank(scene.scenario, scene.models);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, ErrorCode::bad_input);
    EXPECT_EQ(result.error().place, "models.car.mesh");
    EXPECT_NE(result.error().reason.find("no material"), std::string::npos);
    EXPECT_FALSE(result.error().remedy.empty());
  }
}

TEST(Fault, APoseWithNaNIsRefused) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Pose pose;
  pose.rotation(1, 2) = nan;
  EXPECT_FALSE(rigidity_error(pose) <= max_rigidity_error);
  Scene scene = car_and_wall(10.0);
  scene.scenario.ego.speed_mps = 10.0;
  scene.add_candidate("poses", 0.0).poses = {{0.0, {}}, {1.0, pose}};
  const Result<RankResult> refused = rank(scene.scenario, scene.models);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::bad_input);
  EXPECT_EQ(refused.error().place, "candidates.listed[0].poses[1] of 'poses'");
  pose = {};
  pose.translation.x() = nan;
  scene.scenario.listed[0].poses[1].pose = pose;
  EXPECT_FALSE(rank(scene.scenario, scene.models).ok());
  scene.scenario.listed[0].poses[1] = {nan, {}};
  const Result<RankResult> timeless = rank(scene.scenario, scene.models);
  ASSERT_FALSE(timeless.ok());
  EXPECT_EQ(timeless.error().place, "candidates.listed[0].poses[1].t_s of 'poses'");
}

TEST(Fault, TooManyWorkersAreRefused) {
  Scene scene = car_and_wall(10.0);
  scene.add_candidate("keep going", 0.0);
  for (const auto& [workers, fine] : {std::pair(0U, true), {64U, true}, {65U, false}}) {
    RankOptions options;
    options.workers = workers;
    EXPECT_EQ(rank(scene.scenario, scene.models, options).ok(), fine) << workers;
    RankerOptions ranker;
    ranker.rank.workers = workers;
    const Result<Ranker> prepared = Ranker::prepare(scene.scenario, scene.models, ranker);
    EXPECT_EQ(prepared.ok(), fine) << workers;
  }
}

}  // namespace
}  // namespace crashrank

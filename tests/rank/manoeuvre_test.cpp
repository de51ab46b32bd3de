#include "oracle/measured_acceleration.hpp"
#include "oracle/random.hpp"
#include "rank/scenes.hpp"

#include "crashrank/rank/anytime/ranker.hpp"
#include "crashrank/scenario/candidate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace crashrank;
using scenes::box_mesh;
using scenes::of;
using scenes::Scene;

/// A single car of 4 × 2 m on a plane.
Scene alone(double speed_mps) {
  Scene scene;
  scene.scenario.measure = Measure::closing_energy;
  scene.scenario.ego.model =
      scene.add_model("car", box_mesh({2, 1, 0.7F}, 1, {0, 0, 0.75F}), BodyKind::car, 1500.0);
  scene.scenario.ego.speed_mps = speed_mps;
  return scene;
}

/// Poses of a motion every `step_s` until `until_s`, as a planner lists them.
std::vector<TimedPose> sampled(const Motion& motion, double step_s, double until_s) {
  std::vector<TimedPose> poses;
  const auto count = static_cast<int>(std::lround(until_s / step_s));
  for (int i = 0; i <= count; ++i) poses.push_back({i * step_s, motion.pose_at(i * step_s)});
  return poses;
}

void add_planned(Scene& scene, const std::string& name, std::vector<TimedPose> poses) {
  scene.add_candidate(name, 0.0).poses = std::move(poses);
}

TEST(Demand, OfPathsIsTheLargestAcceleration) {
  double hardest_of_grids = 0.0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    oracle::Random random(seed);
    Scene scene = alone(random.real(-20.0, 45.0));
    Scenario& scenario = scene.scenario;
    scenario.grip = random.real(0.05, 1.2);
    scenario.horizon_s = random.real(0.2, 8.0);
    scenario.grid = CandidateGrid{3, 3};
    scene.add_candidate("steers", random.real(-12.0, 12.0), random.real(-0.5, 0.5));
    scene.add_candidate("turns", random.real(-12.0, 12.0)).yaw_rate_radps = random.real(-1.0, 1.0);
    const double whole = scenario.grip * standard_gravity_mps2;
    const double until = scenario.horizon_s;
    const RankResult result = scene.ranked();
    for (const CandidateResult& ranked : result.ranking) {
      const Candidate& candidate = result.candidates[ranked.candidate];
      double hardest = 0.0;
      for (int k = 0; k <= 4000; ++k) {
        const double t = 1e-4 + (until - 2e-4) * k / 4000.0;
        if (std::abs(t - candidate.motion.rest_time()) < 1e-3) continue;
        hardest = std::max(hardest, oracle::measured_acceleration(candidate.motion, t) / whole);
      }
      EXPECT_NEAR(ranked.demand.grip, hardest, 2e-3 * (1.0 + hardest)) << candidate.name;
      if (candidate.origin != CandidateOrigin::grid) continue;
      EXPECT_TRUE(ranked.feasible) << candidate.name << " " << ranked.demand.greatest();
      hardest_of_grids = std::max(hardest_of_grids, ranked.demand.grip);
    }
  }
  EXPECT_NEAR(hardest_of_grids, 1.0, 1e-9);
}

/// The demand of poses is that of a plan through them that a driver can follow: it is not
/// overstated.
TEST(Demand, OfPosesIsThatOfTheirPathAndNotMore) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    oracle::Random random(seed);
    Scene scene = alone(random.real(5.0, 40.0));
    Scenario& scenario = scene.scenario;
    scenario.horizon_s = 3.0;
    // Demand of the centre of mass, which for a box car moves almost like the origin.
    scenario.models[0].center_of_mass_m = Eigen::Vector3d(0.0, 0.0, 0.5);
    const double speed = scenario.ego.speed_mps;
    const double across = random.real(-9.0, 9.0);
    const double along = random.real(-9.0, std::min(9.0, 0.3 * speed));
    ArcMotion arc;
    arc.speed_mps = speed;
    arc.curvature_per_m = across / (speed * speed);
    arc.acceleration_mps2 = along;
    scenario.ego.yaw_rate_radps = arc.curvature_per_m * speed;
    const double step = random.chance(0.5) ? 0.1 : 0.25;
    add_planned(scene, "planned", sampled(arc, step, scenario.horizon_s));
    const CandidateResult ranked = scene.ranked().ranking.front();
    const double whole = scenario.grip * standard_gravity_mps2;
    double hardest = 0.0;
    const Motion motion = arc;
    for (double t = 0.0; t < 3.0; t += 0.01) {
      if (t > motion.rest_time()) break;
      hardest = std::max(hardest, oracle::measured_acceleration(motion, t) / whole);
    }
    EXPECT_LE(ranked.demand.grip, hardest * 1.001 + 1e-9);
    // For braking to a stop and for increasing curvature the mean includes a fraction of a second
    // at the ends. The effect of 1 cm rounding is subtracted.
    constexpr double open_mps2 = 0.25;
    EXPECT_GE(ranked.demand.grip, 0.6 * hardest - open_mps2 / whole);
    if (along > 0.0) {
      EXPECT_LE(ranked.demand.engine, 1.001 * along / scenario.ego.max_acceleration_mps2);
      EXPECT_GE(ranked.demand.engine,
                (0.85 * along - open_mps2) / scenario.ego.max_acceleration_mps2);
    }
    const double angle = std::atan(0.6 * 4.0 * arc.curvature_per_m);
    EXPECT_NEAR(ranked.demand.steering, std::abs(angle) / scenario.ego.max_steering_rad,
                0.02 * std::abs(angle) + 1e-3);
  }
}

TEST(Demand, OfPosesWithIncreasingCurvature) {
  // Steering at a constant rate from straight ahead at constant speed: a clothoid.
  for (const double rate : {0.05, 0.2, 0.6}) {
    Scene scene = alone(5.0);
    scene.scenario.horizon_s = 1.5;
    scene.scenario.grip = 1.5;
    scene.scenario.ego.wheelbase_m = 2.5;
    std::vector<TimedPose> poses;
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    double heading = 0.0;
    constexpr double tick = 1e-4;
    for (int i = 0; i * tick <= 1.5 + 0.5 * tick; ++i) {
      if (i % 1000 == 0) poses.push_back({i * tick, pose_from_angles(at, heading, 0, 0)});
      at += 5.0 * tick * Eigen::Vector3d(std::cos(heading), std::sin(heading), 0.0);
      heading += tick * 5.0 * std::tan(rate * i * tick) / 2.5;
    }
    add_planned(scene, "planned", poses);
    const CandidateResult ranked = scene.ranked().ranking.front();
    EXPECT_NEAR(ranked.demand.steering_rate, rate / 0.4, 0.05 * rate / 0.4) << rate;
  }
}

TEST(Demand, OfPosesThatStartAtAnotherSpeed) {
  Scene scene = alone(20.0);
  ArcMotion slow;
  slow.speed_mps = 10.0;
  ArcMotion same;
  same.speed_mps = 20.0;
  add_planned(scene, "slow", sampled(slow, 0.1, 4.0));
  add_planned(scene, "same", sampled(same, 0.1, 4.0));
  const RankResult result = scene.ranked();
  EXPECT_FALSE(of(result, "slow").feasible);
  EXPECT_TRUE(of(result, "same").feasible);
  EXPECT_LT(of(result, "same").demand.greatest(), 1e-6);
}

TEST(Demand, IsLimitedByTheBrakes) {
  Scene scene = alone(20.0);
  scene.scenario.ego.max_deceleration_mps2 = 5.0;
  scene.scenario.grid = CandidateGrid{5, 3};
  scene.add_candidate("brakes as grip allows", -7.0);
  const RankResult result = scene.ranked();
  EXPECT_NEAR(of(result, "brakes as grip allows").demand.brakes, 1.4, 1e-12);
  EXPECT_FALSE(of(result, "brakes as grip allows").feasible);
  for (const CandidateResult& ranked : result.ranking) {
    const Candidate& candidate = result.candidates[ranked.candidate];
    if (candidate.origin != CandidateOrigin::grid) continue;
    EXPECT_GE(candidate.acceleration_mps2, -5.0);
    EXPECT_TRUE(ranked.feasible);
  }
}

/// A wall ahead that only a manoeuvre beyond the grip avoids.
Scene wall_and_miracle() {
  Scene scene = alone(20.0);
  scene.add_actor("wall",
                  scene.add_model("wall", box_mesh({0.5F, 8, 1}, 1, {0, 0, 1}), BodyKind::barrier),
                  30.0, 0.0);
  scene.add_candidate("brakes", -7.0);
  scene.add_candidate("stops at once", -30.0);
  scene.add_candidate("keeps going", 0.0);
  return scene;
}

TEST(Infeasible, IsDemotedDroppedOrKept) {
  const Scene scene = wall_and_miracle();
  const auto order = [](const RankResult& result) {
    std::vector<std::string> names;
    for (const CandidateResult& each : result.ranking) {
      names.push_back(result.candidates[each.candidate].name);
    }
    return names;
  };
  RankOptions options;
  const RankResult demoted = scene.ranked(options);
  EXPECT_EQ(order(demoted), (std::vector<std::string>{"brakes", "keeps going", "stops at once"}));
  EXPECT_EQ(of(demoted, "stops at once").score, 0.0);
  EXPECT_EQ(of(demoted, "stops at once").place, 3U);
  EXPECT_TRUE(demoted.dropped.empty());
  options.infeasible = Infeasible::drop;
  const RankResult dropped = scene.ranked(options);
  EXPECT_EQ(order(dropped), (std::vector<std::string>{"brakes", "keeps going"}));
  EXPECT_EQ(dropped.dropped, std::vector<std::size_t>{1});
  options.infeasible = Infeasible::keep;
  const RankResult kept = scene.ranked(options);
  EXPECT_EQ(order(kept), (std::vector<std::string>{"stops at once", "brakes", "keeps going"}));
  EXPECT_FALSE(of(kept, "stops at once").feasible);
}

TEST(Demand, CountsUpToTheFirstContact) {
  // About 25 m/s at the contact, 60 m/s at the horizon.
  Scene scene = alone(20.0);
  scene.scenario.ego.max_acceleration_mps2 = 10.0;
  scene.scenario.ego.wheelbase_m = 2.5;
  scene.add_actor("wall",
                  scene.add_model("wall", box_mesh({0.5F, 8, 1}, 1, {0, 0, 1}), BodyKind::barrier),
                  13.75, 0.0);
  scene.add_candidate("hits", 10.0, std::atan(2.5 * 0.01));
  for (const bool enough : {true, false}) {
    const CandidateResult free = scene.ranked().ranking.front();
    ASSERT_TRUE(free.collides);
    const double speed = 20.0 + 10.0 * free.contacts[0].time_of_impact_s;
    const double grip = std::hypot(10.0, 0.01 * speed * speed) / standard_gravity_mps2;
    EXPECT_NEAR(speed, 25.0, 0.5);
    scene.scenario.grip = enough ? 0.97 * grip : 0.94 * grip;
    const CandidateResult ranked = scene.ranked().ranking.front();
    EXPECT_NEAR(ranked.demand.grip, grip / scene.scenario.grip, 1e-9);
    EXPECT_EQ(ranked.feasible, enough);
  }
}

TEST(Infeasible, CountsAsFarAsThePlanIsFollowed) {
  // Accelerating in the curve it exceeds the grip after a second; the wall comes first.
  Scene scene = wall_and_miracle();
  scene.scenario.listed.clear();
  scene.add_candidate("swerves", 3.0, 0.03);
  const RankResult near = scene.ranked();
  EXPECT_TRUE(of(near, "swerves").collides);
  EXPECT_TRUE(of(near, "swerves").feasible);
  // A future in which nothing stops it counts by its probability.
  for (const double exists : {1.0 - 1e-9, 0.1}) {
    for (ScenarioActor& actor : scene.scenario.actors) actor.existence_probability = exists;
    const RankResult ranked = scene.ranked();
    EXPECT_EQ(of(ranked, "swerves").collides, exists > 0.5);
    EXPECT_EQ(of(ranked, "swerves").feasible, exists > 0.5);
    const Result<RankResult> within =
        rank_within(scene.scenario, scene.models, RankOptions{}, RankBudget{});
    ASSERT_TRUE(within.ok());
    EXPECT_EQ(of(*within, "swerves").feasible, exists > 0.5);
  }
  scene.scenario.actors.clear();
  const RankResult far = scene.ranked();
  EXPECT_FALSE(of(far, "swerves").feasible);
}

TEST(Infeasible, AllAreRankedIfNoneIsFeasible) {
  Scene scene = wall_and_miracle();
  scene.scenario.listed.erase(scene.scenario.listed.begin());
  scene.scenario.listed.pop_back();
  RankOptions options;
  options.infeasible = Infeasible::drop;
  const RankResult result = scene.ranked(options);
  ASSERT_EQ(result.ranking.size(), 1U);
  EXPECT_TRUE(result.dropped.empty());
  EXPECT_EQ(result.in_race.size(), 1U);
}

TEST(Infeasible, IsDemotedInEverySample) {
  Scene scene = wall_and_miracle();
  scene.scenario.measure = Measure::harm;
  const RankResult result = scene.ranked();
  ASSERT_GT(result.samples.size(), 100U);
  const CandidateResult& last = result.ranking.back();
  EXPECT_FALSE(last.feasible);
  EXPECT_EQ(last.best_place, 2U);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_LE(result.ranking[i].worst_place, 1U);
  EXPECT_TRUE(result.ranking[1].separable);
  EXPECT_EQ(result.ranking[1].overtaken, 0.0);
}

TEST(Infeasible, AListedBrakeBeyondTheGripDoesNotReplaceStraightBraking) {
  Scene scene = alone(20.0);
  scene.scenario.add_straight_braking = true;
  scene.add_candidate("brake 12", -12.0);
  EXPECT_EQ(scene.ranked().candidates.size(), 2U);
  scene.add_candidate("brake 8", -8.0);  // 7.85 m/s², rounded
  const RankResult rounded = scene.ranked();
  EXPECT_EQ(rounded.candidates.size(), 2U);
  EXPECT_TRUE(of(rounded, "brake 8").feasible);
}

/// Plans that no car can follow, each at 20 m/s.
TEST(Infeasible, StoppingInstantlyAndDrivingSidewaysAreInfeasible) {
  const auto at = [](double time_s, double x, double y = 0.0, double yaw = 0.0) {
    return TimedPose{time_s, pose_from_angles({x, y, 0.0}, yaw, 0.0, 0.0)};
  };
  Scene scene = alone(20.0);
  add_planned(scene, "one pose", {at(0, 0)});
  add_planned(scene, "ends at 1 s", {at(0, 0), at(1, 20)});
  add_planned(scene, "stands from 1 s on", {at(0, 0), at(1, 20), at(5, 20)});
  add_planned(scene, "stops dead at last",
              {at(0, 0), at(1, 20), at(2, 40), at(3, 60), at(3.8, 76), at(4, 76)});
  add_planned(
      scene, "jumps aside at last",
      {at(0, 0), at(1, 20), at(2, 40), at(3, 60), at(3.8, 76), at(3.82, 76.4, 3), at(4, 80, 3)});
  add_planned(scene, "half sideways",
              {at(0, 0, 0, 0.45), at(1, 20, 0, 0.45), at(2, 40, 0, 0.45), at(4, 80, 0, 0.45)});
  add_planned(scene, "drives on", {at(0, 0), at(1, 20), at(2, 40), at(4, 80)});
  const RankResult result = scene.ranked();
  for (const CandidateResult& ranked : result.ranking) {
    const std::string& name = result.candidates[ranked.candidate].name;
    EXPECT_EQ(ranked.feasible, name == "drives on") << name << " " << ranked.demand.greatest();
  }
}

/// Steering that ramps up within the limit, described by poses far apart.
TEST(Demand, OfSparsePosesIsNotOverstated) {
  for (const double apart : {0.1, 0.3, 0.5, 1.0, 1.333, 2.0}) {
    Scene scene = alone(8.0);
    scene.scenario.grip = 1.5;
    scene.scenario.ego.wheelbase_m = 2.5;
    scene.scenario.ego.max_acceleration_mps2 = 0.5;
    std::vector<TimedPose> poses;
    Eigen::Vector3d where = Eigen::Vector3d::Zero();
    double heading = 0.0;
    constexpr double tick = 1e-4;
    const auto every = std::lround(apart / tick);
    for (long i = 0; static_cast<double>(i) * tick <= 4.0 + 0.5 * tick; ++i) {
      if (i % every == 0) {
        poses.push_back({static_cast<double>(i) * tick, pose_from_angles(where, heading, 0, 0)});
      }
      const double steering = std::min(0.3 * static_cast<double>(i) * tick, 0.26);
      where += 8.0 * tick * Eigen::Vector3d(std::cos(heading), std::sin(heading), 0.0);
      heading += tick * 8.0 * std::tan(steering) / 2.5;
    }
    scene.scenario.horizon_s = poses.back().time_s;
    add_planned(scene, "ramps", poses);
    const CandidateResult ranked = scene.ranked().ranking.front();
    EXPECT_LE(ranked.demand.steering_rate, 1.02 * 0.75) << apart;
    EXPECT_LE(ranked.demand.engine, 0.1) << apart;
    EXPECT_TRUE(ranked.feasible) << apart << " " << ranked.demand.greatest();
  }
}

}  // namespace

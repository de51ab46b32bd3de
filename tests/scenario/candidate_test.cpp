#include "crashrank/scenario/candidate.hpp"

#include "oracle/measured_acceleration.hpp"
#include "oracle/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace crashrank {
namespace {

constexpr double length_m = 4.5;

Scenario scenario_at(double speed_mps) {
  Scenario scenario;
  scenario.models.resize(1);
  scenario.ego.speed_mps = speed_mps;
  return scenario;
}

std::vector<Candidate> candidates_of(const Scenario& scenario) {
  Result<std::vector<Candidate>> candidates = make_candidates(scenario, length_m);
  EXPECT_TRUE(candidates.ok());
  return candidates.ok() ? std::move(*candidates) : std::vector<Candidate>{};
}

ListedCandidate listed(const std::string& name, double acceleration_mps2) {
  ListedCandidate candidate;
  candidate.name = name;
  candidate.acceleration_mps2 = acceleration_mps2;
  return candidate;
}

TEST(CandidateGrid, StaysInsideTheGripCircleUntilTheHorizon) {
  double hardest = 0.0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    oracle::Random random(seed);
    Scenario scenario = scenario_at(random.real(-20.0, 45.0));
    scenario.grip = random.real(0.05, 1.2);
    scenario.horizon_s = random.real(0.2, 8.0);
    scenario.ego.max_acceleration_mps2 = random.real(0.0, 12.0);
    scenario.grid = CandidateGrid{static_cast<std::size_t>(random.integer(1, 9)),
                                  static_cast<std::size_t>(random.integer(1, 9))};
    const double limit = scenario.grip * standard_gravity_mps2;
    for (const Candidate& candidate : candidates_of(scenario)) {
      for (int k = 1; k < 40; ++k) {
        const double t = scenario.horizon_s * k / 40.0;
        // Standing still begins with a jump of the acceleration, which differences blur.
        if (std::abs(t - candidate.motion.rest_time()) < 1e-3) continue;
        const double asked = oracle::measured_acceleration(candidate.motion, t);
        ASSERT_LE(asked, limit * (1.0 + 1e-6) + 1e-6) << candidate.name << " at " << t;
        hardest = std::max(hardest, asked / limit);
      }
    }
  }
  EXPECT_GT(hardest, 0.99);
}

TEST(CandidateGrid, KeepsToTheVehiclesSteeringAndPower) {
  for (const double speed : {0.0, 0.5, 3.0, 30.0}) {
    Scenario scenario = scenario_at(speed);
    scenario.ego.wheelbase_m = 2.8;
    scenario.ego.max_steering_rad = 0.5;
    scenario.ego.max_acceleration_mps2 = 2.0;
    for (const Candidate& candidate : candidates_of(scenario)) {
      EXPECT_LE(std::abs(candidate.curvature_per_m), std::tan(0.5) / 2.8 + 1e-12);
      EXPECT_LE(candidate.acceleration_mps2, 2.0);
    }
  }
}

TEST(CandidateGrid, HasFifteenByFifteenDistinctManoeuvres) {
  const std::vector<Candidate> candidates = candidates_of(scenario_at(25.0));
  ASSERT_EQ(candidates.size(), 225U);
  std::set<std::string> names;
  std::set<std::pair<double, double>> manoeuvres;
  for (const Candidate& c : candidates) {
    EXPECT_EQ(c.origin, CandidateOrigin::grid);
    names.insert(c.name);
    manoeuvres.emplace(c.acceleration_mps2, c.curvature_per_m);
  }
  EXPECT_EQ(names.size(), 225U);
  EXPECT_EQ(manoeuvres.size(), 225U);
  // The middle of the grid does nothing; full braking straight ahead is a member.
  EXPECT_EQ(candidates.front().name, "hold speed, straight (a07 s07)");
  const auto braking = std::find_if(candidates.begin(), candidates.end(), [](const Candidate& c) {
    return c.name == "brake 7.85 m/s2, straight (a00 s07)";
  });
  ASSERT_NE(braking, candidates.end());
  EXPECT_EQ(braking->acceleration_mps2, -0.8 * standard_gravity_mps2);
  EXPECT_EQ(braking->curvature_per_m, 0.0);
}

TEST(CandidateGrid, IsTheSameEveryTimeAndGentlestFirst) {
  const Scenario scenario = scenario_at(25.0);
  const std::vector<Candidate> once = candidates_of(scenario);
  const std::vector<Candidate> again = candidates_of(scenario);
  ASSERT_EQ(once.size(), again.size());
  const auto level = [](const std::string& name, std::size_t from_end) {
    return (std::stod(name.substr(name.size() - from_end, 2)) - 7.0) / 7.0;
  };
  double before = 0.0;
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].name, again[i].name);
    EXPECT_EQ(once[i].motion.pose_at(1.0).translation, again[i].motion.pose_at(1.0).translation);
    const double u = level(once[i].name, 7);
    const double w = level(once[i].name, 3);
    EXPECT_GE(u * u + w * w, before - 1e-12);
    before = u * u + w * w;
  }
}

TEST(CandidateGrid, NamesSayWhatTheVehicleDoes) {
  for (const double speed : {25.0, -6.0, 0.0}) {
    const double forward = speed < 0.0 ? -1.0 : 1.0;
    for (const Candidate& c : candidates_of(scenario_at(speed))) {
      if (c.origin != CandidateOrigin::grid) continue;
      const double along_way = c.acceleration_mps2 * forward;
      const std::string pace = along_way < -0.005  ? "brake "
                               : along_way > 0.005 ? "speed up "
                               : speed == 0.0      ? "stand, "
                                                   : "hold speed, ";
      EXPECT_EQ(c.name.rfind(pace, 0), 0U) << c.name;
      const bool left = c.name.find(" deg left (a") != std::string::npos;
      const bool right = c.name.find(" deg right (a") != std::string::npos;
      const bool straight = c.name.find(", straight (a") != std::string::npos;
      EXPECT_EQ(left, c.curvature_per_m > 1e-4) << c.name;
      EXPECT_EQ(right, c.curvature_per_m < -1e-4) << c.name;
      EXPECT_EQ(straight, c.curvature_per_m == 0.0) << c.name;
      if (std::abs(along_way) < 0.005) continue;
      EXPECT_NEAR(std::stod(c.name.substr(pace.size())), std::abs(along_way), 0.005001) << c.name;
    }
  }
}

TEST(CandidateGrid, HoldsTheMirrorImageOfEveryManoeuvre) {
  for (const double speed : {0.0, 4.0, 30.0, -6.0}) {
    std::multiset<std::pair<double, double>> manoeuvres;
    std::multiset<std::pair<double, double>> mirrored;
    for (const Candidate& c : candidates_of(scenario_at(speed))) {
      manoeuvres.emplace(c.acceleration_mps2, c.curvature_per_m);
      mirrored.emplace(c.acceleration_mps2, -c.curvature_per_m);
    }
    EXPECT_EQ(manoeuvres, mirrored);
  }
}

TEST(CandidateGrid, BrakesInEitherDirectionAndNeverReverses) {
  for (const double speed : {-8.0, 0.0, 8.0}) {
    for (const Candidate& c : candidates_of(scenario_at(speed))) {
      for (const double t : {0.5, 1.5, 4.0}) {
        const Pose pose = c.motion.pose_at(t);
        const double along = c.motion.velocity_at(t).linear_mps.dot(pose.rotation.col(0));
        EXPECT_GE(along * (speed < 0.0 ? -1.0 : 1.0), -1e-9) << c.name << " from " << speed;
      }
    }
  }
}

TEST(StraightBraking, IsAddedOnlyWhereItIsMissing) {
  Scenario scenario = scenario_at(20.0);
  scenario.grid.reset();
  scenario.listed = {listed("keep going", 0.0), listed("ease off", -1.0)};
  std::vector<Candidate> candidates = candidates_of(scenario);
  ASSERT_EQ(candidates.size(), 3U);
  EXPECT_EQ(candidates[2].name, "brake straight ahead");
  EXPECT_EQ(candidates[2].origin, CandidateOrigin::added_braking);
  EXPECT_EQ(candidates[2].acceleration_mps2, -0.8 * standard_gravity_mps2);
  EXPECT_EQ(candidates[2].curvature_per_m, 0.0);

  scenario.add_straight_braking = false;
  EXPECT_EQ(candidates_of(scenario).size(), 2U);
  scenario.add_straight_braking = true;

  scenario.listed.push_back(listed("brake", -6.0));
  EXPECT_EQ(candidates_of(scenario).size(), 3U);
  scenario.listed.back().steering_rad = 0.1;  // not straight ahead
  EXPECT_EQ(candidates_of(scenario).size(), 4U);
  scenario.listed.back().steering_rad = 0.0;
  EXPECT_EQ(candidates_of(scenario).size(), 3U);

  // A grid without a middle column does not brake straight ahead.
  scenario.listed.clear();
  scenario.grid = CandidateGrid{3, 4};
  EXPECT_EQ(candidates_of(scenario).size(), 13U);
  scenario.grid = CandidateGrid{4, 3};
  EXPECT_EQ(candidates_of(scenario).size(), 12U);
}

TEST(StraightBraking, FollowsTheDirectionAndTheNamesTaken) {
  Scenario scenario = scenario_at(-5.0);
  scenario.grid.reset();
  scenario.listed = {listed("brake straight ahead", -1.0)};  // which speeds up in reverse
  const std::vector<Candidate> candidates = candidates_of(scenario);
  ASSERT_EQ(candidates.size(), 2U);
  EXPECT_EQ(candidates[1].name, "brake straight ahead 2");
  EXPECT_EQ(candidates[1].acceleration_mps2, 0.8 * standard_gravity_mps2);
}

TEST(ListedCandidate, SteeringHoldsTheCurvatureAndYawRateTheRate) {
  Scenario scenario = scenario_at(10.0);
  scenario.grid.reset();
  scenario.add_straight_braking = false;
  scenario.ego.yaw_rate_radps = 0.05;
  scenario.listed = {listed("steer", -2.0), listed("turn", -2.0), listed("neither", -2.0)};
  scenario.listed[0].steering_rad = 0.1;
  scenario.listed[1].yaw_rate_radps = 0.2;
  const std::vector<Candidate> c = candidates_of(scenario);
  ASSERT_EQ(c.size(), 3U);
  const double curvature = std::tan(0.1) / (0.6 * length_m);
  for (const double t : {0.0, 1.0, 3.0}) {
    const double speed = 10.0 - 2.0 * t;
    EXPECT_NEAR(c[0].motion.velocity_at(t).angular_radps.z(), curvature * speed, 1e-12);
    EXPECT_NEAR(c[1].motion.velocity_at(t).angular_radps.z(), 0.2, 1e-12);
    EXPECT_NEAR(c[2].motion.velocity_at(t).angular_radps.z(), 0.005 * speed, 1e-12);
  }
}

TEST(ListedCandidate, APathFromTheYawRateIsOneThatTheSteeringCanHold) {
  Scenario scenario = scenario_at(0.0);
  scenario.grid.reset();
  scenario.add_straight_braking = false;
  scenario.ego.yaw_rate_radps = 0.002;
  scenario.listed = {listed("go", 2.0)};
  // A sensor's noise while the ego stands: the turn that is measured, held.
  for (const double speed : {0.0, 1e-310, 1e-6, 0.001, 0.49}) {
    scenario.ego.speed_mps = speed;
    const std::vector<Candidate> c = candidates_of(scenario);
    ASSERT_EQ(c.size(), 1U);
    EXPECT_NEAR(c[0].motion.velocity_at(3.0).angular_radps.z(), 0.002, 1e-12) << speed;
    EXPECT_EQ(c[0].curvature_per_m, 0.0);
  }
  // Moving, no path is tighter than the steering makes it.
  scenario.ego.speed_mps = 1.0;
  const double tightest = std::tan(scenario.ego.max_steering_rad) / (0.6 * length_m);
  for (const double yaw_rate : {-5.0, 5.0}) {
    scenario.ego.yaw_rate_radps = yaw_rate;
    const std::vector<Candidate> c = candidates_of(scenario);
    ASSERT_EQ(c.size(), 1U);
    EXPECT_NEAR(c[0].curvature_per_m, std::copysign(tightest, yaw_rate), 1e-12);
  }
}

TEST(ListedCandidate, ANumberThatIsNoneIsToldByItsKey) {
  Scenario scenario = scenario_at(10.0);
  scenario.grip = NAN;
  const Result<std::vector<Candidate>> bad = make_candidates(scenario, length_m);
  ASSERT_FALSE(bad.ok());
  EXPECT_EQ(bad.error().place, "grip");
}

TEST(ListedCandidate, WhatNoVehicleFollowsIsRefused) {
  Scenario scenario = scenario_at(60.0);
  scenario.listed = {listed("spins", 0.0)};
  scenario.listed[0].steering_rad = 1.2;
  const Result<std::vector<Candidate>> bad = make_candidates(scenario, length_m);
  ASSERT_FALSE(bad.ok());
  EXPECT_EQ(bad.error().place, "candidate 'spins'");
  EXPECT_EQ(bad.error().reason, "its motion turns faster than 720 deg/s");
}

TEST(ListedCandidate, TimedPosesAreFollowedAndChecked) {
  Scenario scenario = scenario_at(10.0);
  scenario.grid.reset();
  scenario.add_straight_braking = false;
  ListedCandidate planned = listed("planned", 0.0);
  planned.poses = {{0.0, {}}, {2.0, {}}};
  planned.poses[1].pose.translation.x() = 8.0;
  scenario.listed = {planned};
  const std::vector<Candidate> c = candidates_of(scenario);
  ASSERT_EQ(c.size(), 1U);
  EXPECT_NEAR(c[0].motion.pose_at(0.5).translation.x(), 2.0, 1e-12);

  scenario.listed[0].poses[1].time_s = 0.0;
  const Result<std::vector<Candidate>> bad = make_candidates(scenario, length_m);
  ASSERT_FALSE(bad.ok());
  EXPECT_EQ(bad.error().code, ErrorCode::bad_input);
  EXPECT_EQ(bad.error().place.rfind("candidates.listed[0].poses", 0), 0U) << bad.error().place;
}

TEST(ActorMotion, FollowsSpeedYawRateAndBraking) {
  ScenarioActor actor;
  actor.speed_mps = 6.0;
  actor.acceleration_mps2 = -2.0;
  const Result<Motion> braking = make_motion(actor);
  ASSERT_TRUE(braking.ok());
  EXPECT_NEAR(braking->pose_at(10.0).translation.x(), 9.0, 1e-12);
  actor.acceleration_mps2 = 0.0;
  actor.yaw_rate_radps = 0.5;
  const Result<Motion> turning = make_motion(actor);
  ASSERT_TRUE(turning.ok());
  EXPECT_NEAR(turning->pose_at(M_PI).translation.x(), 12.0, 1e-9);
  EXPECT_NEAR(turning->pose_at(M_PI).translation.y(), 12.0, 1e-9);
}

}  // namespace
}  // namespace crashrank

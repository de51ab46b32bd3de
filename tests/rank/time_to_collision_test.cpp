#include "oracle/random.hpp"
#include "rank/scenes.hpp"

#include "crashrank/rank/anytime/ranker.hpp"
#include "crashrank/scenario/candidate.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace {

using namespace crashrank;
using Eigen::Vector2d;
using scenes::box_mesh;
using scenes::of;
using scenes::Scene;

constexpr double pi = std::numbers::pi;
constexpr double none = std::numeric_limits<double>::infinity();

/// Angle between the box of model 3 and its body's x axis, so that its bounding rectangle is larger
/// than its outline.
constexpr double turned_rad = 0.35;

/// An ego of 4 × 2 m (model 0), a car of that size (1), a lorry of 12 × 2.4 m (2) and a turned box
/// of the car's size (3), origins in the middle.
Scene drivers(double speed_mps, double horizon_s) {
  Scene scene;
  scene.scenario.measure = Measure::closing_energy;
  const TriangleMesh car = box_mesh({2, 1, 0.7F}, 1, {0, 0, 0.75F});
  scene.scenario.ego.model = scene.add_model("ego", car, BodyKind::car, 1500.0);
  scene.add_model("car", car, BodyKind::car, 1500.0);
  scene.add_model("lorry", box_mesh({6, 1.2F, 1.5F}, 1, {0, 0, 1.6F}), BodyKind::truck, 14000.0);
  TriangleMesh turned = car;
  const Eigen::AngleAxisf turn(static_cast<float>(turned_rad), Eigen::Vector3f::UnitZ());
  for (Eigen::Vector3f& vertex : turned.vertices) vertex = turn * vertex;
  scene.add_model("turned", turned, BodyKind::car, 1500.0);
  scene.scenario.ego.speed_mps = speed_mps;
  scene.scenario.horizon_s = horizon_s;
  return scene;
}

CandidateResult only(const Scene& scene) { return scene.ranked().ranking.front(); }

TEST(TimeToCollision, HeadOnIsTheGapOverTheClosingSpeed) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    oracle::Random random(seed);
    const double own = random.real(1.0, 30.0);
    const double other = random.real(0.0, 30.0);
    const double horizon = random.real(0.5, 5.0);
    const double gap = random.real(0.05, 2.9 * (own + other));
    Scene scene = drivers(own, horizon);
    scene.add_actor("far behind", 1, -100.0, 0.0);
    scene.add_actor("lorry", 2, 8.0 + gap + (own + other) * horizon, 0.0, pi, other);
    scene.add_candidate("keeps going", 0.0);
    const CandidateResult ranked = only(scene);
    ASSERT_FALSE(ranked.collides);
    ASSERT_TRUE(ranked.time_to_collision_s.has_value());
    EXPECT_NEAR(*ranked.time_to_collision_s, gap / (own + other), 0.01 / (own + other));
    EXPECT_EQ(ranked.imminent, 1U);
  }
}

TEST(TimeToCollision, OfAStandingEgoIsThatOfTheApproachingLorry) {
  // It stops after 10 m, and the lorry is 1.66 m from it at the horizon.
  Scene scene = drivers(10.0, 3.0);
  scene.add_actor("lorry", 2, 10.0 + 8.0 + 1.66 + 60.0, 0.0, pi, 20.0);
  scene.add_candidate("stops", -5.0);
  const CandidateResult ranked = only(scene);
  EXPECT_EQ(ranked.at_horizon->speed_mps, 0.0);
  EXPECT_NEAR(*ranked.time_to_collision_s, 1.66 / 20.0, 0.01 / 20.0);
}

TEST(TimeToCollision, IsAbsentBesideAndBehindOthersAndBeyondThreeSeconds) {
  const auto time = [](double x, double y, double yaw, double speed, double acceleration = 0.0) {
    Scene scene = drivers(20.0, 2.0);
    scene.add_actor("other", 1, x, y, yaw, speed);
    scene.add_candidate("goes", acceleration);
    const CandidateResult ranked = only(scene);
    EXPECT_FALSE(ranked.collides);
    EXPECT_EQ(ranked.time_to_collision_s.has_value(), ranked.imminent.has_value());
    return ranked.time_to_collision_s.value_or(none);
  };
  EXPECT_EQ(time(0.0, 2.1, 0.0, 20.0), none);         // beside
  EXPECT_EQ(time(60.0, 2.1, pi, 20.0), none);         // passed in the next lane
  EXPECT_EQ(time(100.0, 2.1, pi, 20.0), none);        // will be passed there
  EXPECT_EQ(time(4.3, 0.0, 0.0, 20.0), none);         // ahead at the same speed
  EXPECT_EQ(time(5.0, 0.0, 0.0, 25.0), none);         // ahead and faster
  EXPECT_EQ(time(60.0, 0.0, 0.0, 0.0, -10.0), none);  // stood at the horizon
  EXPECT_NEAR(time(44.0 + 2.99 * 20.0, 0.0, 0.0, 0.0), 2.99, 1e-3);
  EXPECT_EQ(time(44.0 + 3.01 * 20.0, 0.0, 0.0, 0.0), none);
  // From behind: 4 m gap at the horizon, 5 m/s faster.
  EXPECT_NEAR(time(-18.0, 0.0, 0.0, 25.0), 0.8, 0.002);
}

/// Separation of the ego's box and a turned one along the worst of their axes, m: negative if they
/// overlap, and no more than their distance. Bodies move on from their state at the horizon.
class BoxesAfterHorizon {
public:
  BoxesAfterHorizon(const Motion& ego, double ego_mps2, const Motion& turned, double turned_mps2,
                    double horizon_s)
      : deceleration_mps2_{std::max(-ego_mps2, 0.0), std::max(-turned_mps2, 0.0)} {
    for (const Motion* motion : {&ego, &turned}) {
      const Pose pose = motion->pose_at(horizon_s);
      at_.emplace_back(pose.translation.head<2>());
      const double turn = motion == &turned ? turned_rad : 0.0;
      const Eigen::Vector3d ahead(std::cos(turn), std::sin(turn), 0.0);
      ahead_.emplace_back((pose.rotation * ahead).head<2>());
      velocity_.emplace_back(motion->velocity_at(horizon_s - 1e-9).linear_mps.head<2>());
    }
  }
  double separation_m(double time_s) const {
    const Vector2d apart = at_[1] + driven_m(1, time_s) - at_[0] - driven_m(0, time_s);
    double most = -none;
    for (const Vector2d& ahead : ahead_) {
      for (const Vector2d& axis : {ahead, Vector2d(-ahead.y(), ahead.x())}) {
        double reach = 0.0;
        for (const Vector2d& own : ahead_) {
          reach += 2.0 * std::abs(own.dot(axis)) + std::abs(Vector2d(-own.y(), own.x()).dot(axis));
        }
        most = std::max(most, std::abs(apart.dot(axis)) - reach);
      }
    }
    return most;
  }

private:
  Vector2d driven_m(std::size_t body, double time_s) const {
    const double speed = velocity_[body].norm();
    if (speed == 0.0) return Vector2d::Zero();
    const double deceleration = deceleration_mps2_[body];
    const double until = deceleration > 0.0 ? std::min(time_s, speed / deceleration) : time_s;
    return velocity_[body] / speed * (speed * until - 0.5 * deceleration * until * until);
  }

  std::vector<double> deceleration_mps2_;
  std::vector<Vector2d> at_;
  std::vector<Vector2d> ahead_;
  std::vector<Vector2d> velocity_;
};

TEST(TimeToCollision, IsTheFirstOverlapOfBoxesThatDriveOn) {
  int hits = 0;
  int misses = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    oracle::Random random(seed);
    Scene scene = drivers(random.real(0.0, 25.0), random.real(0.1, 0.6));
    const auto others = static_cast<std::size_t>(random.integer(1, 3));
    for (std::size_t i = 0; i < others; ++i) {
      ScenarioActor& actor =
          scene.add_actor("box " + std::to_string(i), 3, random.real(-20.0, 50.0),
                          random.real(-20.0, 20.0), random.real(0.0, 6.3), random.real(0.0, 20.0));
      actor.yaw_rate_radps = random.real(-0.4, 0.4);
      actor.acceleration_mps2 = random.real(-4.0, 2.0);
    }
    const double ego_mps2 = random.real(-6.0, 3.0);
    scene.add_candidate("steers", ego_mps2, random.real(-0.1, 0.1));
    const RankResult result = scene.ranked();
    const CandidateResult& ranked = result.ranking.front();
    if (ranked.collides) {
      EXPECT_FALSE(ranked.time_to_collision_s || ranked.imminent);
      continue;
    }
    const double time = ranked.time_to_collision_s.value_or(none);
    (time < none ? hits : misses) += 1;
    for (std::size_t i = 0; i < others; ++i) {
      const Result<Motion> motion = make_motion(scene.scenario.actors[i]);
      ASSERT_TRUE(motion.ok());
      const BoxesAfterHorizon boxes(result.candidates[0].motion, ego_mps2, *motion,
                                    scene.scenario.actors[i].acceleration_mps2,
                                    scene.scenario.horizon_s);
      double deepest = none;
      for (double t = 0.0; t < std::min(time, longest_time_to_collision_s); t += 1e-3) {
        deepest = std::min(deepest, boxes.separation_m(t));
      }
      EXPECT_GT(deepest, -0.005) << i;
      if (ranked.imminent == i) {
        EXPECT_LT(boxes.separation_m(time), 0.015);
      }
    }
    std::reverse(scene.scenario.actors.begin(), scene.scenario.actors.end());
    const CandidateResult turned = only(scene);
    EXPECT_EQ(turned.time_to_collision_s, ranked.time_to_collision_s);
    if (ranked.imminent) {
      EXPECT_EQ(*turned.imminent, others - 1 - *ranked.imminent);
    }
  }
  EXPECT_GT(hits, 30);
  EXPECT_GT(misses, 40);
}

TEST(TimeToCollision, CrossingPathsThatMissAreAbsent) {
  // The ego's front is at x = 22 m at the horizon; it is in the way of the other, 30 to 32 m, from
  // 0.8 to 1.4 s. The other, at `y`, is in the way of the ego, -3 to 3 m, for 0.3 s.
  for (const auto& [y, collides] : {std::pair(-14.0, true), std::pair(-30.0, true),
                                    std::pair(-12.0, false), std::pair(-32.0, false)}) {
    Scene scene = drivers(10.0, 2.0);
    scene.add_actor("crosses", 1, 31.0, y - 40.0, 0.5 * pi, 20.0);
    scene.add_candidate("keeps going", 0.0);
    EXPECT_EQ(only(scene).time_to_collision_s.has_value(), collides) << y;
  }
}

TEST(TimeToCollision, TimedPosesThatEndAtTheHorizonKeepTheirVelocity) {
  for (const double end_s : {2.0, 1.9}) {
    Scene scene = drivers(0.0, 2.0);
    ScenarioActor& lorry = scene.add_actor("lorry", 2, 100.0, 0.0, pi);
    for (const double time : {0.0, 1.0, end_s}) {
      lorry.poses.push_back(
          {time, pose_from_angles({8.0 + 4.0 + 20.0 * (end_s - time), 0, 0}, pi, 0, 0)});
    }
    scene.add_candidate("stands", 0.0);
    const CandidateResult ranked = only(scene);
    // Poses that end before leave the lorry at rest.
    EXPECT_EQ(ranked.time_to_collision_s.has_value(), end_s == 2.0);
    if (ranked.time_to_collision_s) {
      EXPECT_NEAR(*ranked.time_to_collision_s, 0.2, 0.001);
    }
  }
}

TEST(TimeToCollision, BodiesAboveEachOtherAreIgnored) {
  Scene scene = drivers(20.0, 2.0);
  ScenarioActor& bridge = scene.add_actor("on a bridge", 1, 60.0, 0.0);
  bridge.pose.translation.z() = 6.0;
  scene.add_candidate("keeps going", 0.0);
  EXPECT_FALSE(only(scene).time_to_collision_s.has_value());
}

TEST(TimeToCollision, WhatBrakesGoesOnBraking) {
  // After 1 s at -5 m/s2 from 20 m/s the ego is at 17.5 m with 15 m/s and needs 22.5 m more.
  for (const double room : {10.0, 22.0, 23.0}) {
    Scene scene = drivers(20.0, 1.0);
    scene.add_actor("queue", 1, 17.5 + 4.0 + room, 0.0);
    scene.add_candidate("brakes", -5.0);
    const CandidateResult ranked = only(scene);
    ASSERT_EQ(ranked.time_to_collision_s.has_value(), room < 22.5) << room;
    // room = 15 t - 2.5 t^2
    if (room > 22.5) continue;
    const double time = (15.0 - std::sqrt(15.0 * 15.0 - 10.0 * room)) / 5.0;
    const double slowest = 15.0 - 5.0 * time;
    EXPECT_NEAR(*ranked.time_to_collision_s, time, 0.02 / slowest) << room;
  }
  // What is followed brakes, the ego does not: 10 m = 5 t^2 / 2.
  Scene scene = drivers(20.0, 1.0);
  ScenarioActor& leader = scene.add_actor("leader", 1, 4.0 + 10.0 + 2.5, 0.0);
  leader.speed_mps = 20.0;
  leader.acceleration_mps2 = -5.0;
  scene.add_candidate("keeps on", 0.0);
  // At the horizon the leader has lost 2.5 m and is 5 m/s slower.
  const double time = (-5.0 + std::sqrt(25.0 + 10.0 * 10.0)) / 5.0;
  EXPECT_NEAR(*only(scene).time_to_collision_s, time, 0.01 / 5.0);
}

TEST(TimeToCollision, IsTheLeastOverAllFuturesAndAbsentWithAContactInOne) {
  const auto with = [](double nearer_x) {
    Scene scene = drivers(10.0, 2.0);
    ScenarioActor& car = scene.add_actor("car", 1, 50.0, 0.0);
    Prediction far;
    far.pose = pose_from_angles({50.0, 0.0, 0.0}, 0.0, 0.0, 0.0);
    far.probability = 0.9;
    Prediction near = far;
    near.pose = pose_from_angles({nearer_x, 0.0, 0.0}, 0.0, 0.0, 0.0);
    near.probability = 0.1;
    car.predictions = {far, near};
    scene.add_candidate("keeps going", 0.0);
    return only(scene);
  };
  EXPECT_NEAR(*with(45.0).time_to_collision_s, 2.1, 0.002);
  EXPECT_NEAR(*with(30.0).time_to_collision_s, 0.6, 0.002);
  const CandidateResult hit = with(20.0);
  EXPECT_GT(hit.collision_probability, 0.0);
  EXPECT_FALSE(hit.collides || hit.time_to_collision_s || hit.imminent);
}

/// A car ahead at the ego's speed, a lorry that comes towards both in the left lane, and a plan
/// that ends in that lane, 6 m before the lorry at 4 s.
Scene pull_out(double horizon_s) {
  Scene scene = drivers(15.0, horizon_s);
  scene.scenario.measure = Measure::harm;
  scene.add_actor("car ahead", 1, 32.0, 0.0, 0.0, 15.0);
  scene.add_actor("lorry", 2, 60.0 + 8.0 + 6.0 + 80.0, 3.5, pi, 20.0);
  scene.add_candidate("follows", 0.0);
  std::vector<TimedPose>& poses = scene.add_candidate("pulls out", 0.0).poses;
  for (int i = 0; i <= 60; ++i) {
    const double time = 0.1 * i;
    const double share = std::clamp(time / 2.5, 0.0, 1.0);
    const double y = 3.5 * share * share * (3.0 - 2.0 * share);
    poses.push_back({time, pose_from_angles({15.0 * time, y, 0.0}, 0.0, 0.0, 0.0)});
  }
  return scene;
}

TEST(TimeToCollision, IsDecidedBeforeDistanceAndTimeGap) {
  const Scene scene = pull_out(4.0);
  const RankResult result = scene.ranked();
  const CandidateResult& pulls = of(result, "pulls out");
  const CandidateResult& follows = of(result, "follows");
  ASSERT_TRUE(pulls.feasible);
  EXPECT_EQ(pulls.score, 0.0);
  EXPECT_EQ(follows.score, 0.0);
  // The other quantities speak for the head-on course.
  EXPECT_FALSE(pulls.least_time_gap_s.has_value());
  EXPECT_NEAR(*follows.least_time_gap_s, 28.0 / 15.0, 0.01);
  EXPECT_NEAR(*pulls.time_to_collision_s, 6.0 / 35.0, 0.002);
  EXPECT_EQ(pulls.imminent, 1U);
  EXPECT_FALSE(follows.time_to_collision_s.has_value());
  EXPECT_EQ(follows.place, 1U);
  EXPECT_EQ(pulls.place, 2U);
  const RankResult later = pull_out(4.4).ranked();
  EXPECT_TRUE(of(later, "pulls out").collides);
}

TEST(TimeToCollision, IsTheSameInTheRanker) {
  const Scene scene = pull_out(4.0);
  const RankResult result = scene.ranked();
  Result<Ranker> ranker = Ranker::prepare(scene.scenario, scene.models, {});
  ASSERT_TRUE(ranker.ok());
  for (const bool first_place_only : {false, true}) {
    RankBudget budget;
    budget.first_place_only = first_place_only;
    const RankerAnswer answer = ranker->rank(result.candidates, budget);
    ASSERT_TRUE(answer.status.ok() && answer.proved);
    EXPECT_EQ(answer.ranking[0].candidate, result.ranking[0].candidate);
    for (std::size_t i = 0; answer.complete && i < result.ranking.size(); ++i) {
      EXPECT_EQ(answer.ranking[i].time_to_collision_s,
                result.ranking[i].time_to_collision_s.value_or(none));
    }
  }
}

TEST(TimeToCollision, DecidesBeforeStayingOnTheRoadWhereACrashIsImminent) {
  for (const double place_m : {60.0, 70.0}) {
    Scene scene = drivers(20.0, 2.0);
    scene.add_actor("stands", 1, place_m, 0.0);
    scene.add_candidate("right", 0.0, -0.02);
    scene.add_candidate("on", 0.0);
    const double time_s = of(scene.ranked(), "on").time_to_collision_s.value();
    const bool imminent = place_m == 60.0;
    EXPECT_EQ(time_s < imminent_crash_s, imminent);
    EXPECT_FALSE(of(scene.ranked(), "right").time_to_collision_s.has_value());
    scene.scenario.road.drivable = {{{{-20, -1.2}, {200, -1.2}, {200, 10}, {-20, 10}}, {}}};
    EXPECT_EQ(scene.ranked().ranking[0].candidate, imminent ? 0U : 1U);
  }
}

/// With more time than an imminent crash leaves, the distance to others counts.
TEST(TimeToCollision, OfMoreThanASecondDoesNotDecide) {
  Scene scene = drivers(20.0, 2.0);
  scene.add_actor("stands", 1, 90.0, 0.0);
  scene.add_actor("beside", 1, 20.0, -4.6);
  scene.add_candidate("right", 0.0, -0.004);
  scene.add_candidate("on", 0.0);
  const RankResult result = scene.ranked();
  ASSERT_EQ(*result.ranking[0].score, 0.0);
  ASSERT_EQ(*result.ranking[1].score, 0.0);
  EXPECT_GT(of(result, "on").time_to_collision_s.value(), 2.0);
  EXPECT_GT(*of(result, "on").least_distance_m, *of(result, "right").least_distance_m + 0.1);
  EXPECT_EQ(result.ranking[0].candidate, 1U);
}

/// Rolling up to a standing car is no crash, driving into it is.
TEST(TimeToCollision, OfASlowApproachIsNone) {
  for (const double speed_mps : {0.5, 1.9, 2.1, 5.0}) {
    Scene scene = drivers(speed_mps, 1.0);
    scene.add_actor("stands", 1, 4.5 + speed_mps, 0.0);
    scene.add_candidate("on", 0.0);
    EXPECT_EQ(only(scene).time_to_collision_s.has_value(), speed_mps > slow_crash_mps) << speed_mps;
  }
}

}  // namespace

#include "crashrank/rank/anytime/ranker.hpp"

#include "rank/anytime/ranker_case.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

namespace crashrank {
namespace {

TEST(RankerRefusal, AnOrderByUpperEndsNeedsSamples) {
  const Case c(302, Measure::harm);
  RankerOptions options;
  options.rank.order = RankOrder::upper;
  const Result<Ranker> refused = Ranker::prepare(c.scene.scenario, c.scene.models, options);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::usage);
}

TEST(RankerRefusal, MotionsThatAreNotFiniteAreRefused) {
  const Case c(302, Measure::harm);
  Ranker ranker = c.ranker(Measure::harm, 2);
  const std::uint64_t whole = ranker.rank(c.candidates).hash;
  const std::vector<Motion> motions = c.motions();
  const Pose& start = c.scene.scenario.ego.pose;
  for (const double wrong : {static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    FreeMotion somewhere;
    somewhere.start.translation.x() = wrong;
    FreeMotion somehow;
    somehow.velocity.angular_radps.z() = wrong;
    TurnMotion turn;
    turn.yaw_rate_radps = wrong;
    ArcMotion arc;
    arc.acceleration_mps2 = wrong;
    ArcMotion fast;
    fast.speed_mps = wrong;
    for (const Motion& motion :
         {Motion(somewhere), Motion(somehow), Motion(turn), Motion(arc), Motion(fast)}) {
      EXPECT_FALSE(motion.is_finite());
      std::vector<Motion> others = motions;
      others.back() = motion;
      const Status moved = ranker.move_actors(start, others);
      ASSERT_FALSE(moved.ok());
      EXPECT_EQ(moved.error().code, ErrorCode::bad_input);
      std::vector<Candidate> candidates = c.candidates;
      candidates.back().motion = motion;
      const RankerAnswer answer = ranker.rank(candidates);
      ASSERT_FALSE(answer.status.ok());
      EXPECT_EQ(answer.status.error().code, ErrorCode::bad_input);
      EXPECT_TRUE(answer.ranking.empty());
      EXPECT_FALSE(answer.proved);
    }
    Pose nowhere = start;
    nowhere.rotation(0, 0) = wrong;
    EXPECT_FALSE(ranker.move_actors(nowhere, motions).ok());
  }
  RankBudget never;
  never.deadline_s = NAN;
  EXPECT_FALSE(ranker.rank(c.candidates, never).status.ok());
  for (const Motion& motion : motions) EXPECT_TRUE(motion.is_finite());
  EXPECT_EQ(ranker.rank(c.candidates).hash, whole);  // the Ranker is unchanged
}

TEST(RankerRefusal, MotionsBeyondScenarioLimitsAreRefused) {
  const Case c(303, Measure::harm);
  Ranker ranker = c.ranker(Measure::harm, 2);
  const std::uint64_t whole = ranker.rank(c.candidates).hash;
  const std::vector<Motion> motions = c.motions();
  const Pose& start = c.scene.scenario.ego.pose;
  TurnMotion spins;
  spins.start = start;
  spins.yaw_rate_radps = 1.01 * scenario_limits::yaw_rate_dps * std::numbers::pi / 180.0;
  TurnMotion races;
  races.start = start;
  races.speed_mps = 1e308;
  TurnMotion gains;
  gains.start = start;
  gains.acceleration_mps2 = 1e308;
  TurnMotion gains_at_once = gains;
  gains_at_once.top_speed_mps = 30.0;
  TurnMotion stops_at_once;
  stops_at_once.start = start;
  stops_at_once.speed_mps = 20.0;
  stops_at_once.acceleration_mps2 = -1e308;
  TurnMotion brakes = stops_at_once;
  brakes.acceleration_mps2 = -1.01 * scenario_limits::acceleration_mps2;
  ArcMotion curls;
  curls.start = start;
  curls.speed_mps = 1e-4;
  curls.curvature_per_m = 2e5;
  FreeMotion flies;
  flies.start = start;
  flies.velocity.linear_mps.z() = 1.01 * scenario_limits::fastest_mps;
  TurnMotion far;
  far.start.translation.y() = 1.01 * scenario_limits::position_m;
  const auto timed = [&](const Pose& from, double speed_mps) {
    Pose to = from;
    to.translation.x() += 0.1 * speed_mps;
    return *Motion::timed(std::vector<TimedPose>{{0.0, from}, {0.1, to}});
  };
  TurnMotion mirrored;
  mirrored.start = start;
  mirrored.start.rotation.col(1) *= -1.0;
  TurnMotion doubled;
  doubled.start = start;
  doubled.start.rotation *= 2.0;
  EXPECT_FALSE(Motion(mirrored).is_finite());
  EXPECT_FALSE(Motion(doubled).is_finite());
  Pose away = start;
  away.translation.x() += 1.0;
  const Motion late = *Motion::timed(std::vector<TimedPose>{{5.0, start}, {6.0, away}});
  const std::vector<Motion> beyond{Motion(mirrored),
                                   Motion(doubled),
                                   late,
                                   Motion(spins),
                                   Motion(races),
                                   Motion(gains),
                                   Motion(gains_at_once),
                                   Motion(stops_at_once),
                                   Motion(brakes),
                                   Motion(curls),
                                   Motion(flies),
                                   Motion(far),
                                   timed(start, 1.01 * scenario_limits::fastest_mps),
                                   timed(far.start, 0.0)};
  for (std::size_t i = 0; i < beyond.size(); ++i) {
    SCOPED_TRACE(i);
    std::vector<Motion> others = motions;
    others.back() = beyond[i];
    const Status moved = ranker.move_actors(start, others);
    ASSERT_FALSE(moved.ok());
    EXPECT_EQ(moved.error().code, ErrorCode::bad_input);
    EXPECT_EQ(moved.error().place, "actors[" + std::to_string(motions.size() - 1) + "]");
    std::vector<Candidate> candidates = c.candidates;
    candidates.front().motion = beyond[i];
    const RankerAnswer answer = ranker.rank(candidates);
    ASSERT_FALSE(answer.status.ok());
    EXPECT_EQ(answer.status.error().place, "candidates[0]");
    EXPECT_TRUE(answer.ranking.empty());
  }
  EXPECT_FALSE(ranker.move_actors(far.start, motions).ok());
  spins.yaw_rate_radps /= 1.02;
  brakes.acceleration_mps2 /= 1.02;
  for (const Motion& within :
       {Motion(spins), Motion(brakes), timed(start, 0.99 * scenario_limits::fastest_mps)}) {
    std::vector<Motion> others = motions;
    others.back() = within;
    EXPECT_TRUE(ranker.move_actors(start, others).ok());
  }
  EXPECT_TRUE(ranker.move_actors(start, motions).ok());
  EXPECT_EQ(ranker.rank(c.candidates).hash, whole);
}

TEST(RankerRefusal, TieBreakNumbersMustBeFinite) {
  const Case c(304, Measure::harm);
  Ranker ranker = c.ranker(Measure::harm);
  for (double Candidate::*const told :
       {&Candidate::acceleration_mps2, &Candidate::curvature_per_m}) {
    std::vector<Candidate> candidates = c.candidates;
    candidates.back().*told = NAN;
    EXPECT_FALSE(ranker.rank(candidates).status.ok());
  }
}

TEST(RankerRefusal, CandidatesMustStartAtTheEgoPose) {
  const Case c(305, Measure::harm);
  Ranker ranker = c.ranker(Measure::harm);
  const std::vector<Motion> motions = c.motions();
  Pose start = c.scene.scenario.ego.pose;
  start.translation.x() += 0.9;
  ASSERT_TRUE(ranker.move_actors(start, motions).ok());
  EXPECT_TRUE(ranker.rank(c.candidates).status.ok());
  // Candidates made for an earlier situation.
  start.translation.x() += 100.0;
  ASSERT_TRUE(ranker.move_actors(start, motions).ok());
  const RankerAnswer stale = ranker.rank(c.candidates);
  ASSERT_FALSE(stale.status.ok());
  EXPECT_EQ(stale.status.error().code, ErrorCode::bad_input);
  for (const double yaw_deg : {-29.0, 29.0, 31.0, 180.0}) {
    const double yaw = yaw_deg * std::numbers::pi / 180.0;
    ASSERT_TRUE(ranker.move_actors(c.scene.scenario.ego.pose, motions).ok());
    std::vector<Candidate> candidates = c.candidates;
    Pose turned = c.scene.scenario.ego.pose;
    turned.rotation = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * turned.rotation;
    candidates.front().motion = Motion::at_rest(turned);
    EXPECT_EQ(ranker.rank(candidates).status.ok(), std::abs(yaw_deg) < 30.0) << yaw_deg;
  }
}

}  // namespace
}  // namespace crashrank

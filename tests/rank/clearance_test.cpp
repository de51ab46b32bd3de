#include "oracle/random.hpp"
#include "rank/scenes.hpp"

#include "crashrank/rank/anytime/ranker.hpp"
#include "crashrank/scenario/candidate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
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

constexpr double half_length_m = 2.0;
constexpr double half_width_m = 1.0;

/// A car of 4 × 2 m with its origin in the middle, and a second model.
Scene two_cars(double speed_mps) {
  Scene scene;
  scene.scenario.measure = Measure::closing_energy;
  const TriangleMesh mesh = box_mesh({2, 1, 0.7F}, 1, {0, 0, 0.75F});
  scene.scenario.ego.model = scene.add_model("ego", mesh, BodyKind::car, 1500.0);
  scene.add_model("car", mesh, BodyKind::car, 1500.0);
  scene.scenario.ego.speed_mps = speed_mps;
  return scene;
}

std::array<Vector2d, 4> corners(const Pose& pose) {
  std::array<Vector2d, 4> all;
  std::size_t k = 0;
  for (const auto& [x, y] :
       {std::pair(-half_length_m, -half_width_m), std::pair(half_length_m, -half_width_m),
        std::pair(half_length_m, half_width_m), std::pair(-half_length_m, half_width_m)}) {
    all[k++] = (pose.rotation * Eigen::Vector3d(x, y, 0.0) + pose.translation).head<2>();
  }
  return all;
}

/// Distance of two disjoint rectangles: the nearest points are a corner of one and an edge of the
/// other.
double apart(const Pose& a, const Pose& b) {
  double least = 1e9;
  for (const auto& [points, edges] :
       {std::pair(corners(a), corners(b)), std::pair(corners(b), corners(a))}) {
    for (const Vector2d& point : points) {
      for (std::size_t i = 0; i < 4; ++i) {
        const Vector2d along = edges[(i + 1) % 4] - edges[i];
        const double share =
            std::clamp((point - edges[i]).dot(along) / along.squaredNorm(), 0.0, 1.0);
        least = std::min(least, (edges[i] + share * along - point).norm());
      }
    }
  }
  return least;
}

TEST(Clearance, DistanceIsTheMinimumBetweenOutlinesAlongThePlans) {
  int near = 0;
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    oracle::Random random(seed);
    Scene scene = two_cars(random.real(0.0, 30.0));
    scene.scenario.horizon_s = 3.0;
    const auto others = random.integer(1, 3);
    for (int i = 0; i < others; ++i) {
      ScenarioActor& actor =
          scene.add_actor("car " + std::to_string(i), 1, random.real(-20.0, 70.0),
                          random.real(-30.0, 30.0), random.real(0.0, 6.3), random.real(0.0, 20.0));
      actor.yaw_rate_radps = random.real(-0.5, 0.5);
      actor.acceleration_mps2 = random.real(-4.0, 2.0);
    }
    scene.add_candidate("steers", random.real(-7.0, 3.0), random.real(-0.1, 0.1));
    const RankResult result = scene.ranked();
    const CandidateResult& ranked = result.ranking.front();
    if (ranked.collides) {
      EXPECT_EQ(ranked.least_distance_m, 0.0);
      EXPECT_EQ(ranked.least_time_gap_s, 0.0);
      EXPECT_FALSE(ranked.nearest.has_value() || ranked.soonest.has_value());
      EXPECT_FALSE(ranked.at_horizon.has_value());
      continue;
    }
    double expected = farthest_clearance_m;
    std::vector<double> by_actor;
    for (const ScenarioActor& actor : scene.scenario.actors) {
      const Result<Motion> motion = make_motion(actor);
      ASSERT_TRUE(motion.ok());
      by_actor.push_back(farthest_clearance_m);
      for (double t = 0.0; t <= 3.0; t += 1e-3) {
        by_actor.back() = std::min(
            by_actor.back(), apart(result.candidates[0].motion.pose_at(t), motion->pose_at(t)));
      }
      expected = std::min(expected, by_actor.back());
    }
    EXPECT_EQ(ranked.nearest.has_value(), ranked.least_distance_m.has_value());
    if (ranked.nearest) {
      EXPECT_NEAR(by_actor[*ranked.nearest], expected, 0.03);
    }
    if (expected < farthest_clearance_m - 0.05) {
      ++near;
      ASSERT_TRUE(ranked.least_distance_m.has_value());
      EXPECT_NEAR(*ranked.least_distance_m, expected, 0.03);
    } else if (expected == farthest_clearance_m) {
      EXPECT_FALSE(ranked.least_distance_m.has_value());
    }
    // The order of the actors does not matter.
    std::reverse(scene.scenario.actors.begin(), scene.scenario.actors.end());
    const CandidateResult turned = scene.ranked().ranking.front();
    EXPECT_EQ(turned.least_distance_m, ranked.least_distance_m);
    EXPECT_EQ(turned.least_time_gap_s, ranked.least_time_gap_s);
  }
  EXPECT_GT(near, 60);
}

TEST(Clearance, TimeGapOfCrossingPaths) {
  int crossed = 0;
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    oracle::Random random(seed);
    const double speed = random.real(5.0, 30.0);
    const double other_speed = random.real(5.0, 30.0);
    const double x = random.real(15.0, 60.0);
    const double y = random.real(10.0, 60.0);
    Scene scene = two_cars(speed);
    scene.scenario.horizon_s = 6.0;
    scene.add_actor("crosses", 1, x, -y, 0.5 * std::numbers::pi, other_speed);
    scene.add_candidate("keeps going", 0.0);
    const CandidateResult ranked = scene.ranked().ranking.front();
    if (ranked.collides) continue;
    // The flanks of the ego are at ±1 m, those of the other at x ± 1 m.
    const double clear = half_length_m + half_width_m;
    const double gap = std::max((y - clear) / other_speed - (x + clear) / speed,
                                (x - clear) / speed - (y + clear) / other_speed);
    const double last_s = std::max((y - clear) / other_speed, (x - clear) / speed);
    if (last_s > 5.9) continue;
    ++crossed;
    ASSERT_TRUE(ranked.least_time_gap_s.has_value());
    EXPECT_NEAR(*ranked.least_time_gap_s, gap, 0.02);
  }
  EXPECT_GT(crossed, 60);
}

TEST(Clearance, TimeGapToALeadingCar) {
  Scene scene = two_cars(20.0);
  scene.add_actor("ahead", 1, 24.0, 0.0, 0.0, 20.0);
  scene.add_actor("stands beside", 1, 30.0, 3.0);
  scene.add_candidate("keeps going", 0.0);
  const CandidateResult ranked = scene.ranked().ranking.front();
  // 20 m of free road at 20 m/s.
  EXPECT_NEAR(*ranked.least_time_gap_s, 1.0, 0.005);
  EXPECT_NEAR(*ranked.least_distance_m, 1.0, 0.01);
  EXPECT_EQ(ranked.soonest, 0U);
  EXPECT_EQ(ranked.nearest, 1U);
}

TEST(Clearance, BodiesAboveEachOtherAreIgnored) {
  Scene scene = two_cars(20.0);
  ScenarioActor& bridge = scene.add_actor("on a bridge", 1, 30.0, 0.0);
  bridge.pose.translation.z() = 6.0;
  scene.add_candidate("keeps going", 0.0);
  EXPECT_FALSE(scene.ranked().ranking.front().least_distance_m.has_value());
}

TEST(Clearance, IsTheMinimumOverAllFutures) {
  Scene scene = two_cars(10.0);
  ScenarioActor& car = scene.add_actor("car", 1, 20.0, 5.0);
  Prediction far;
  far.pose = pose_from_angles({20.0, 5.0, 0.0}, 0.0, 0.0, 0.0);
  far.probability = 0.9;
  Prediction near = far;
  near.pose = pose_from_angles({20.0, 3.0, 0.0}, 0.0, 0.0, 0.0);
  near.probability = 0.1;
  car.predictions = {far, near};
  scene.add_candidate("keeps going", 0.0);
  EXPECT_NEAR(*scene.ranked().ranking.front().least_distance_m, 1.0, 0.01);
}

/// Names in the order of the ranking, tied ones joined by "=".
std::string order(const RankResult& result) {
  std::string names;
  for (std::size_t i = 0; i < result.ranking.size(); ++i) {
    const CandidateResult& each = result.ranking[i];
    const bool tied = i > 0 && each.place == result.ranking[i - 1].place;
    names += (i == 0 ? "" : tied ? "=" : " ") + result.candidates[each.candidate].name;
  }
  return names;
}

TEST(OrderOfHarmless, PrefersRoadThenDistanceThenLowSpeed) {
  Scene scene = two_cars(10.0);
  scene.add_actor("parked", 1, 25.0, 3.0);
  scene.add_candidate("on", 0.0);
  scene.add_candidate("right", 0.0, -0.01);
  scene.add_candidate("brakes", -4.0);
  scene.add_candidate("brakes, too", -4.0);
  // "brakes" stops before the parked car; steering to the right keeps a larger distance than
  // straight on.
  EXPECT_EQ(order(scene.ranked()), "brakes=brakes, too right on");
  std::reverse(scene.scenario.listed.begin(), scene.scenario.listed.end());
  EXPECT_EQ(order(scene.ranked()), "brakes, too=brakes right on");
  // The border of the road is to the right of the lane.
  scene.scenario.road.drivable = {{{{-20, -1.2}, {200, -1.2}, {200, 10}, {-20, 10}}, {}}};
  EXPECT_EQ(order(scene.ranked()), "brakes, too=brakes on right");
  // Without actors the slower candidate is first.
  scene.scenario.actors.clear();
  scene.scenario.road = {};
  EXPECT_EQ(order(scene.ranked()), "brakes, too=brakes right=on");
}

/// For any deadline the values marked as known equal those of the complete answer.
TEST(OrderOfHarmless, InterruptedSearchesReportNoPartialClearance) {
  std::size_t cut_short = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    oracle::Random random(seed);
    Scene scene = two_cars(random.real(5.0, 25.0));
    for (int i = 0; i < 6; ++i) {
      scene.add_actor("car " + std::to_string(i), 1, random.real(10.0, 60.0), random.real(4.0, 9.0),
                      random.real(0.0, 6.3), random.real(0.0, 15.0));
    }
    scene.scenario.road.drivable = {{{{-20, -4}, {100, -4}, {100, 4}, {-20, 4}}, {}}};
    scene.scenario.road.harm_per_leaving = 0.05;
    if (seed % 2 == 0) scene.scenario.ego.uncertainty = {0.1, 0.01, 0.2};
    scene.scenario.grid = CandidateGrid{3, 5};
    RankerOptions options;
    options.rank.measure = Measure::harm;
    options.rank.sampled_futures = 8;
    Result<Ranker> ranker = Ranker::prepare(scene.scenario, scene.models, options);
    ASSERT_TRUE(ranker.ok());
    const RankResult plain = scene.ranked(options.rank);
    const RankerAnswer answer = ranker->rank(plain.candidates, {});
    ASSERT_TRUE(answer.complete);
    std::vector<RankedCandidate> whole(plain.candidates.size());
    for (const RankedCandidate& each : answer.ranking) whole[each.candidate] = each;
    for (double deadline_s = 2e-6; deadline_s < 0.1; deadline_s *= 1.25) {
      RankBudget budget;
      budget.deadline_s = deadline_s;
      const RankerAnswer cut = ranker->rank(plain.candidates, budget);
      if (!cut.complete) ++cut_short;
      for (const RankedCandidate& each : cut.ranking) {
        const RankedCandidate& all = whole[each.candidate];
        EXPECT_LE(each.interval.lowest, all.score);
        EXPECT_GE(each.interval.highest, all.score);
        if (!each.known) continue;
        EXPECT_EQ(each.score, all.score);
        EXPECT_EQ(each.least_distance_m, all.least_distance_m);
        EXPECT_EQ(each.least_time_gap_s, all.least_time_gap_s);
        EXPECT_EQ(each.time_to_collision_s, all.time_to_collision_s);
        EXPECT_EQ(each.leaves_road, all.leaves_road);
      }
    }
  }
  EXPECT_GT(cut_short, 6U);
}

TEST(OrderOfHarmless, IsTheSameInTheRanker) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    oracle::Random random(seed);
    Scene scene = two_cars(random.real(5.0, 25.0));
    for (int i = 0; i < 3; ++i) {
      scene.add_actor("car " + std::to_string(i), 1, random.real(10.0, 60.0),
                      random.real(-9.0, 9.0), random.real(0.0, 6.3), random.real(0.0, 15.0));
    }
    scene.scenario.road.drivable = {{{{-20, -4}, {100, -4}, {100, 4}, {-20, 4}}, {}}};
    scene.scenario.road.harm_per_leaving = random.chance(0.5) ? 0.05 : 0.0;
    scene.scenario.grid = CandidateGrid{3, 5};
    scene.add_candidate("beyond the grip", -12.0, 0.02);
    scene.scenario.measure = random.chance(0.5) ? Measure::harm : Measure::energy;
    RankerOptions options;
    options.rank.infeasible = random.chance(0.3) ? Infeasible::keep : Infeasible::demote;
    const RankResult expected = scene.ranked(options.rank);
    Result<Ranker> ranker = Ranker::prepare(scene.scenario, scene.models, options);
    ASSERT_TRUE(ranker.ok());
    const RankerAnswer whole = ranker->rank(expected.candidates, {});
    ASSERT_TRUE(whole.status.ok() && whole.complete);
    for (std::size_t i = 0; i < expected.ranking.size(); ++i) {
      const CandidateResult& one = expected.ranking[i];
      EXPECT_EQ(whole.ranking[i].candidate, one.candidate) << "place " << i;
      EXPECT_EQ(whole.ranking[i].score, *one.score);
      EXPECT_EQ(whole.ranking[i].leaves_road, one.leaves_road.has_value());
      EXPECT_EQ(whole.ranking[i].time_to_collision_s,
                one.time_to_collision_s.value_or(std::numeric_limits<double>::infinity()));
      EXPECT_EQ(whole.ranking[i].feasible,
                one.feasible || options.rank.infeasible == Infeasible::keep);
    }
    RankBudget first;
    first.first_place_only = true;
    const RankerAnswer quick = ranker->rank(expected.candidates, first);
    EXPECT_TRUE(quick.proved);
    EXPECT_EQ(quick.ranking[0].candidate, expected.ranking[0].candidate);
    for (std::uint64_t work = 100; work < 1'000'000; work *= 7) {
      RankBudget budget;
      budget.work = work;
      const RankerAnswer cut = ranker->rank(expected.candidates, budget);
      const bool can_win =
          std::any_of(cut.ranking.begin(), cut.ranking.end(), [&](const RankedCandidate& each) {
            return each.in_race && each.candidate == expected.ranking[0].candidate;
          });
      EXPECT_TRUE(can_win) << "after " << work;
      if (cut.proved) {
        EXPECT_EQ(cut.ranking[0].candidate, expected.ranking[0].candidate);
      }
      for (const RankedCandidate& each : cut.ranking) {
        const auto same =
            std::find_if(expected.ranking.begin(), expected.ranking.end(),
                         [&](const CandidateResult& c) { return c.candidate == each.candidate; });
        EXPECT_LE(each.interval.lowest, *same->score);
        EXPECT_GE(each.interval.highest, *same->score);
      }
    }
  }
}

}  // namespace

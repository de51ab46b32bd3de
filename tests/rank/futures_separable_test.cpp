// Whether places can be told from each other where futures are sampled.
#include "rank/futures_cases.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

namespace crashrank {
namespace {

using scenes::Scene;

/// Two ways, one the mirror image of the other, each towards six cars that exist independently.
/// The names of the actors determine which futures are drawn.
RankResult two_ways(double left_exists, double right_exists, const std::string& names,
                    const char* risk = "expected") {
  Scene scene;
  scene.scenario.measure = Measure::delta_v;
  scene.scenario.ego.model =
      scene.add_model("car", scenes::box_mesh({2, 1, 0.75}), BodyKind::car, 1500.0);
  scene.scenario.ego.speed_mps = 20.0;
  for (const double side : {1.0, -1.0}) {
    ListedCandidate& way = scene.add_candidate(side > 0.0 ? "left" : "right", 0.0);
    way.poses.push_back({0.0, {}});
    way.poses.push_back({0.5, pose_from_angles({10.0, side * 4.0, 0.0}, 0.0, 0.0, 0.0)});
    way.poses.push_back({1.5, pose_from_angles({28.0, side * 4.0, 0.0}, 0.0, 0.0, 0.0)});
    way.poses.push_back({2.5, pose_from_angles({38.0, side * 4.0, 0.0}, 0.0, 0.0, 0.0)});
    way.poses.push_back({3.5, pose_from_angles({43.0, side * 4.0, 0.0}, 0.0, 0.0, 0.0)});
    for (int k = 0; k < 6; ++k) {
      ScenarioActor& car =
          scene.add_actor(names + (side > 0.0 ? " left " : " right ") + std::to_string(k), 0,
                          14.0 + 5.0 * k, side * 4.0);
      car.existence_probability = side > 0.0 ? left_exists : right_exists;
    }
  }
  RankOptions options = futures::options_with(false);
  options.measure = Measure::delta_v;
  options.sampled_futures = 32;  // 12 improbable choices: at most half of them
  options.infeasible = Infeasible::keep;
  options.risk = *risk_from_name(risk);
  return scene.ranked(options);
}

TEST(FuturesSeparable, ScoresWithEqualExpectationsAreSeldomSeparable) {
  constexpr int repeats = 40;
  int equal_separable = 0;
  int other_separable = 0;
  int reversed = 0;
  for (int i = 0; i < repeats; ++i) {
    const RankResult equal = two_ways(0.4, 0.4, "sample " + std::to_string(i));
    ASSERT_EQ(equal.futures.method, FutureMethod::sampled);
    ASSERT_EQ(equal.ranking.size(), 2U);
    ASSERT_EQ(equal.ranking[0].drawn_scores.size(), 32U);
    if (equal.ranking[0].separable) ++equal_separable;
    EXPECT_NE(equal.ranking[0].separable, equal.ranking[0].within_sampling_error);
    if (equal.ranking[0].candidate == 1) ++reversed;
    const RankResult other = two_ways(0.05, 0.9, "sample " + std::to_string(i));
    if (other.ranking[0].separable) ++other_separable;
    EXPECT_EQ(other.ranking[0].candidate, 0U);
  }
  std::printf(
      "of %d samples: equal expectations separable %d times, first place reversed %d times,"
      " different ones separable %d times\n",
      repeats, equal_separable, reversed, other_separable);
  // Sampling noise decides the order of equal expectations.
  EXPECT_GT(reversed, repeats / 5);
  EXPECT_LT(reversed, repeats - repeats / 5);
  EXPECT_LE(equal_separable, repeats / 8);
  EXPECT_GE(other_separable, repeats - repeats / 8);
}

TEST(FuturesSeparable, WorstCasesOfASampleAreNotSeparable) {
  for (const char* const risk : {"worst", "quantile:0.5", "cvar:0.9"}) {
    const RankResult result = two_ways(0.05, 0.9, "names", risk);
    const CandidateResult& first = result.ranking[0];
    if (*first.score == *result.ranking[1].score) continue;
    EXPECT_FALSE(first.sampling_error_to_next.has_value()) << risk;
    EXPECT_TRUE(first.within_sampling_error) << risk;
    EXPECT_FALSE(first.separable) << risk;
  }
}

}  // namespace
}  // namespace crashrank

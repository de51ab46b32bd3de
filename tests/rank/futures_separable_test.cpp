// Whether places can be told from each other where futures are sampled.
#include "rank/futures_cases.hpp"

#include "rank/risk.hpp"

#include <gtest/gtest.h>

#include <cmath>
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

std::vector<DrawnFuture> equal_draws() { return std::vector<DrawnFuture>(64, {1.0 / 64.0, 0}); }

TEST(FuturesSeparable, TheErrorOfADifferenceIsThatOfItsMean) {
  const RiskMeasure mean = *risk_from_name("expected");
  std::vector<double> a;
  std::vector<double> b;
  for (int f = 0; f < 64; ++f) {
    a.push_back(f);
    b.push_back(f + (f % 2 == 0 ? 1.0 : -1.0));
  }
  // The differences are 1 and -1, half each: their variance is 1.
  EXPECT_NEAR(*detail::difference_error(mean, a, b, equal_draws()), 1.0 / std::sqrt(63.0), 1e-12);
  for (std::size_t f = 0; f < b.size(); ++f) b[f] = a[f] + 3.0;
  EXPECT_EQ(*detail::difference_error(mean, a, b, equal_draws()), 0.0);
  for (const char* const risk : {"worst", "quantile:0.9", "cvar:0.9"}) {
    EXPECT_EQ(*detail::difference_error(*risk_from_name(risk), a, b, equal_draws()), 0.0) << risk;
    b.front() += 1.0;
    EXPECT_FALSE(detail::difference_error(*risk_from_name(risk), a, b, equal_draws()).has_value())
        << risk;
    b.front() -= 1.0;
  }
  // Above the median of 0 to 63 and of 0 a tail of 32 remains: 2 (f - 31) there, 0 elsewhere.
  std::fill(b.begin(), b.end(), 0.0);
  double sum = 0.0;
  double squares = 0.0;
  for (int f = 32; f < 64; ++f) {
    sum += 2.0 * (f - 31);
    squares += 4.0 * (f - 31) * (f - 31);
  }
  const double variance = squares / 64.0 - (sum / 64.0) * (sum / 64.0);
  EXPECT_NEAR(*detail::difference_error(*risk_from_name("cvar:0.5"), a, b, equal_draws()),
              std::sqrt(variance / 63.0), 1e-12);
}

TEST(FuturesSeparable, OnlyWhatVariesWithinAStratumIsASamplingError) {
  const RiskMeasure mean = *risk_from_name("expected");
  // A stratum of 48 futures with probability 0.9 and one of 16 with 0.1.
  std::vector<DrawnFuture> drawn(48, {0.9 / 48.0, 0});
  drawn.resize(64, {0.1 / 16.0, 1});
  std::vector<double> a(48, 0.0);
  a.resize(64, 0.5);
  const std::vector<double> b(64, 0.25);
  EXPECT_FALSE(detail::sampling_error(mean, a, drawn).has_value());
  EXPECT_EQ(*detail::difference_error(mean, a, b, drawn), 0.0);
  // In the second: 0.25 and 0.75, half each.
  for (std::size_t f = 48; f < 64; ++f) a[f] += f % 2 == 0 ? 0.25 : -0.25;
  const double expected = 0.1 * 0.25 / std::sqrt(15.0);
  EXPECT_NEAR(*detail::sampling_error(mean, a, drawn), expected, 1e-15);
  EXPECT_NEAR(*detail::difference_error(mean, a, b, drawn), expected, 1e-15);
}

TEST(FuturesSeparable, RoundingIsNoSamplingError) {
  const RiskMeasure mean = *risk_from_name("expected");
  const std::vector<double> a(64, 0.3);
  std::vector<double> b = a;
  b.back() = std::nextafter(0.3, 1.0);
  const auto error = [&mean](const std::vector<double>& scores) {
    return detail::sampling_error(mean, scores, equal_draws());
  };
  EXPECT_FALSE(error(a).has_value());
  EXPECT_FALSE(error(b).has_value());
  EXPECT_EQ(detail::difference_error(mean, a, b, equal_draws()), 0.0);
  b.back() = 0.3 + 1e-6;
  EXPECT_GT(error(b), 0.0);
  EXPECT_GT(detail::difference_error(mean, a, b, equal_draws()), 0.0);
}

}  // namespace
}  // namespace crashrank

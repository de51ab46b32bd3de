#include "crashrank/rank/rank.hpp"
#include "rank/drawn_scenarios.hpp"
#include "rank/futures_cases.hpp"
#include "rank/random_scene.hpp"
#include "rank/scenes.hpp"
#include "rank/strata.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using futures::drawn;
using futures::drawn_of_ego;
using futures::scores_of;
using scenes::Scene;

constexpr std::size_t sampled = 12;

/// Cumulative normal distribution, by the complementary error function of the standard library.
double normal_share(double deviate) { return 0.5 * std::erfc(-deviate / std::numbers::sqrt2); }

RankOptions harm_of(std::size_t futures) {
  RankOptions options;
  options.measure = Measure::harm;
  options.harm.emplace();
  options.harm->intervals = false;
  options.sampled_futures = futures;
  return options;
}

TEST(StateErrors, NormalDeviateInvertsTheNormalDistribution) {
  for (double p = 1e-16; p < 0.5; p *= 1.07) {
    const double z = detail::normal_deviate(p);
    EXPECT_NEAR(normal_share(z) / p, 1.0, 1e-13 * (1.0 + z * z)) << p;
    if (p > 1e-9) {
      EXPECT_NEAR(detail::normal_deviate(1.0 - p), -z, 1e-6) << p;
    }
  }
  EXPECT_EQ(detail::normal_deviate(0.5), 0.0);
  EXPECT_NEAR(detail::normal_deviate(0.975), 1.959963984540054, 1e-14);
}

TEST(StateErrors, SamplesAreStratifiedWithTheStatedMeanAndDeviation) {
  const StateUncertainty uncertainty{0.3, 0.05, 2.0};
  for (const std::size_t count : {64U, 1000U}) {
    const std::vector<StateError> errors = drawn(detail::seed_of("name"), uncertainty, count);
    std::vector<std::vector<double>> units(4);
    for (const StateError& e : errors) {
      units[0].push_back(e.x_m / 0.3);
      units[1].push_back(e.y_m / 0.3);
      units[2].push_back(e.heading_rad / 0.05);
      units[3].push_back(e.speed_mps / 2.0);
    }
    const auto mean_of = [count](const std::vector<double>& p, const std::vector<double>& q) {
      double sum = 0.0;
      for (std::size_t f = 0; f < count; ++f) sum += p[f] * q[f];
      return sum / static_cast<double>(count);
    };
    const std::vector<double> ones(count, 1.0);
    for (std::size_t i = 0; i < units.size(); ++i) {
      std::vector<bool> hit(count, false);
      for (const double z : units[i]) {
        const auto stratum = static_cast<std::size_t>(normal_share(z) * static_cast<double>(count));
        EXPECT_FALSE(hit.at(stratum));
        hit.at(stratum) = true;
      }
      // Stratified: far below the 1/sqrt(count) of independent draws.
      EXPECT_NEAR(mean_of(units[i], ones), 0.0, 1.0 / static_cast<double>(count));
      EXPECT_NEAR(std::sqrt(mean_of(units[i], units[i])), 1.0, 4.0 / static_cast<double>(count));
      for (std::size_t k = 0; k < i; ++k) {
        EXPECT_LT(std::abs(mean_of(units[i], units[k])), 4.0 / std::sqrt(count)) << i << k;
      }
    }
  }
  EXPECT_NE(detail::seed_of("ego"), detail::reserved_seed("ego"));
}

/// Traffic whose candidates do not depend on the speed of the ego.
Scene uncertain_traffic(std::uint64_t seed) {
  Scene scene = seed % 2 == 0 ? scenes::traffic(seed) : scenes::congestion(seed);
  scene.scenario.grid.reset();
  scene.add_candidate("coast", 0.0, 0.0);
  scene.add_candidate("brake", -6.0, 0.0);
  scene.add_candidate("left", -2.0, 0.03);
  scene.add_candidate("right", 1.0, -0.03);
  scene.scenario.ego.uncertainty = {0.4, 0.03, 1.5};
  for (std::size_t i = 0; i < scene.scenario.actors.size(); ++i) {
    ScenarioActor& actor = scene.scenario.actors[i];
    if (actor.model < scenes::pole_model && i % 3 != 2) actor.perception = {0.3, 0.05, 1.0};
  }
  return scene;
}

void expect_mean_of_singles(const Scene& scene, double tolerance) {
  const RankResult whole = scene.ranked(harm_of(sampled));
  ASSERT_EQ(whole.futures.method, FutureMethod::sampled);
  EXPECT_TRUE(whole.futures.has_state_errors);
  EXPECT_EQ(whole.futures.sampled, sampled);
  EXPECT_EQ(whole.futures.futures, sampled + 1);
  std::vector<double> mean(whole.ranking.size(), 0.0);
  std::vector<double> collides(whole.ranking.size(), 0.0);
  for (const futures::SingleFuture& single : futures::single_scenarios(scene.scenario, sampled)) {
    const Result<RankResult> part = rank(single.scenario, scene.models, harm_of(1));
    ASSERT_TRUE(part.ok()) << part.error().message();
    for (const CandidateResult& c : part->ranking) {
      mean[c.candidate] += single.probability * c.score.value_or(-1e9);
      if (c.collides) collides[c.candidate] += single.probability;
    }
  }
  const RankResult likeliest = [&] {
    Scene exact = scene;
    exact.scenario = likeliest_future(scene.scenario);
    return exact.ranked(harm_of(1));
  }();
  for (const CandidateResult& c : whole.ranking) {
    EXPECT_NEAR(c.score.value_or(-1.0), mean[c.candidate],
                tolerance * std::max(1.0, mean[c.candidate]));
    EXPECT_NEAR(c.collision_probability, collides[c.candidate], 1e-12);
    ASSERT_FALSE(c.futures.empty());
    EXPECT_TRUE(c.futures.front().is_likeliest);
    EXPECT_EQ(c.futures.front().score, scores_of(likeliest)[c.candidate]);
    futures::expect_all_futures(c, sampled + 1);
  }
}

TEST(StateErrors, ScoresAreTheMeanOfTheDisplacedScenarios) {
  for (std::uint64_t seed = 8100; seed < 8108; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    oracle::Random random(seed);
    Scene scene = uncertain_traffic(seed);
    if (seed % 4 > 1) scenes::add_predictions(random, scene, 2);
    expect_mean_of_singles(scene, 1e-9);
    // Without rotations the poses have the same bits.
    scene.scenario.ego.uncertainty.heading_rad = 0.0;
    for (ScenarioActor& actor : scene.scenario.actors) actor.perception.heading_rad = 0.0;
    expect_mean_of_singles(scene, 1e-12);
    // With errors of the actors only: futures can share a simulation.
    scene.scenario.ego.uncertainty = {};
    if (is_uncertain(scene.scenario) && !scene.scenario.actors.front().perception.any()) continue;
    expect_mean_of_singles(scene, 1e-12);
    if (HasFatalFailure()) return;
  }
}

TEST(StateErrors, JointFuturesAreDrawnByTheirProbability) {
  Scene scene = uncertain_traffic(8201);
  Scenario& scenario = scene.scenario;
  for (const double probability : {0.25, 0.75}) {
    JointFuture future;
    future.probability = probability;
    for (std::size_t i = 0; i < scenario.actors.size(); i += 2) {
      if (scenario.actors[i].model >= scenes::pole_model) continue;
      FutureMotion moved{i, scenario.actors[i]};
      moved.motion.speed_mps += 4.0 * probability;
      future.motions.push_back(moved);
    }
    scenario.futures.push_back(future);
  }
  expect_mean_of_singles(scene, 1e-9);
}

TEST(StateErrors, NoOrderOfActorsAndNoNumberOfWorkersChangesABit) {
  const Scene scene = uncertain_traffic(8301);
  const RankResult one = scene.ranked(harm_of(sampled));
  Scene turned = scene;
  std::reverse(turned.scenario.actors.begin(), turned.scenario.actors.end());
  EXPECT_EQ(scores_of(turned.ranked(harm_of(sampled))), scores_of(one));
  for (const unsigned workers : {2U, 3U, 5U}) {
    RankOptions options = harm_of(sampled);
    options.workers = workers;
    EXPECT_EQ(scores_of(scene.ranked(options)), scores_of(one));
  }
}

/// A gap between two bodies, 10 cm wider than the ego: straight through at 20 m/s, or braking
/// before it. A following car hits the braking ego gently.
Scene gap_scene(bool of_cars) {
  Scene scene = scenes::car_and_wall();
  scene.scenario.actors.clear();
  scene.scenario.measure = Measure::delta_v;
  scene.scenario.harm.intervals = false;
  constexpr double free_m = 0.05;
  const double aside = 1.0 + free_m + (of_cars ? 1.0 : 10.0);
  const std::size_t model = of_cars ? 0 : 1;
  scene.add_actor("left", model, 35.0, aside);
  scene.add_actor("right", model, 35.0, -aside);
  scene.add_actor("follower", 0, -10.0, 0.0, 0.0, 20.0).acceleration_mps2 = -5.5;
  scene.add_candidate("through", 0.0, 0.0);
  scene.add_candidate("brake", -7.0, 0.0);
  return scene;
}

TEST(StateErrors, SmoothScoresAreThoseOfSmallStatedErrors) {
  Scene scene = gap_scene(false);
  RankOptions smooth;
  smooth.smooth = true;
  const RankResult result = scene.ranked(smooth);
  EXPECT_TRUE(result.futures.smooth);
  EXPECT_EQ(result.futures.sampled, smooth_futures);
  EXPECT_EQ(result.candidates[result.ranking.front().candidate].name, "brake");
  const std::optional<std::size_t> exact = first_without_errors(result);
  ASSERT_TRUE(exact.has_value());
  EXPECT_EQ(result.candidates[result.ranking[*exact].candidate].name, "through");
  EXPECT_FALSE(first_without_errors(scene.ranked()).has_value());

  // The walls at both sides do not move, so they have no errors.
  scene.scenario.ego.uncertainty = small_errors;
  for (ScenarioActor& actor : scene.scenario.actors) {
    if (actor.name == "follower") actor.perception = small_errors;
  }
  RankOptions stated;
  stated.sampled_futures = smooth_futures;
  EXPECT_EQ(scores_of(scene.ranked(stated)), scores_of(result));
  // Stated errors remain, and as many futures as asked.
  scene.scenario.ego.uncertainty.position_m = 0.2;
  smooth.sampled_futures = 32;
  stated.sampled_futures = 32;
  EXPECT_EQ(scores_of(scene.ranked(smooth)), scores_of(scene.ranked(stated)));
}

TEST(StateErrors, ATightGapLosesItsFirstPlace) {
  Scene scene = gap_scene(false);
  const RankResult exact = scene.ranked();
  ASSERT_EQ(exact.candidates[exact.ranking.front().candidate].name, "through");
  EXPECT_EQ(*exact.ranking.front().score, 0.0);
  EXPECT_EQ(exact.futures.method, FutureMethod::certain);

  scene.scenario.ego.uncertainty.position_m = 0.2;
  const RankResult result = scene.ranked();
  EXPECT_EQ(result.candidates[result.ranking.front().candidate].name, "brake");
  const CandidateResult& through = scenes::of(result, "through");
  // |y| > 5 cm. At each of the two borders one stratum is undetermined.
  const double expected = 2.0 * normal_share(-0.25);
  EXPECT_NEAR(through.collision_probability, expected, 2.0 / 64.0);
  EXPECT_FALSE(through.collides);
  std::size_t outside = 0;
  for (const StateError& error : drawn_of_ego(scene.scenario, 64)) {
    outside += std::abs(error.y_m) > 0.05 ? 1U : 0U;
  }
  EXPECT_NEAR(through.collision_probability, static_cast<double>(outside) / 64.0, 1e-12);
  ASSERT_TRUE(through.sampling_error.has_value());

  RankOptions many;
  many.sampled_futures = 1000;
  EXPECT_NEAR(scenes::of(scene.ranked(many), "through").collision_probability, expected,
              2.0 / 1000.0);
}

TEST(StateErrors, AnUncertainBodyNearThePathIsAvoided) {
  Scene scene = gap_scene(true);
  ASSERT_EQ(scene.ranked().ranking.front().candidate, 0U);
  scene.scenario.actors.front().perception.position_m = 0.2;
  const RankResult result = scene.ranked();
  EXPECT_EQ(result.candidates[result.ranking.front().candidate].name, "brake");
  EXPECT_NEAR(scenes::of(result, "through").collision_probability, normal_share(-0.25), 1.0 / 64.0);
}

TEST(StateErrors, ErrorsOfZeroChangeNothing) {
  Scene scene = uncertain_traffic(8400);
  const Scenario exact = likeliest_future(scene.scenario);
  EXPECT_TRUE(is_uncertain(scene.scenario));
  EXPECT_FALSE(is_uncertain(exact));
  scene.scenario.ego.uncertainty = {0.0, 0.0, 0.0};
  for (ScenarioActor& actor : scene.scenario.actors) actor.perception = {0.0, 0.0, 0.0};
  const RankResult result = scene.ranked(harm_of(sampled));
  EXPECT_EQ(result.futures.method, FutureMethod::certain);
  EXPECT_FALSE(result.futures.has_state_errors);
  scene.scenario = exact;
  EXPECT_EQ(scores_of(scene.ranked(harm_of(sampled))), scores_of(result));
}

TEST(StateErrors, LeavingTheRoadUsesTheDisplacedEgo) {
  // The right wheels are 0.1 m from the border.
  Scene scene = gap_scene(false);
  scene.scenario.actors.clear();
  scene.scenario.measure = Measure::harm;
  scene.scenario.ego.uncertainty.position_m = 0.2;
  Area road;
  road.outer = {{-50, -3}, {500, -3}, {500, 3}, {-50, 3}};
  scene.scenario.road.drivable = {road};
  scene.scenario.road.harm_per_leaving = 2.0;
  const auto least_y = [&](double y) {
    scene.scenario.ego.pose.translation.y() = y;
    Scene exact = scene;
    exact.scenario.ego.uncertainty = {};
    return exact.ranked(harm_of(64)).ranking.front().leaves_road.has_value();
  };
  double off = -3.0;
  double on = 0.0;
  ASSERT_TRUE(least_y(off));
  ASSERT_FALSE(least_y(on));
  for (int i = 0; i < 40; ++i) (least_y(0.5 * (off + on)) ? off : on) = 0.5 * (off + on);
  scene.scenario.ego.pose.translation.y() = on + 0.1;
  const RankResult result = scene.ranked(harm_of(64));
  EXPECT_NEAR(scenes::of(result, "through").score.value_or(-1.0), 2.0 * normal_share(-0.5),
              2.0 / 64.0);
}

TEST(StateErrors, BadDeviationsAreRefusedByKey) {
  const Scene good = gap_scene(true);
  const auto place = [&](auto change) {
    Scenario scenario = good.scenario;
    change(scenario);
    const Result<RankResult> result = rank(scenario, good.models);
    EXPECT_FALSE(result.ok());
    if (result.ok()) return std::string();
    EXPECT_EQ(result.error().code, ErrorCode::bad_input);
    EXPECT_FALSE(result.error().remedy.empty());
    return result.error().place;
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {-0.1, 10.5, nan, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(place([&](Scenario& s) { s.ego.uncertainty.position_m = bad; }),
              "ego.uncertainty.position_m");
    EXPECT_EQ(place([&](Scenario& s) { s.actors[1].perception.position_m = bad; }),
              "actors[1].perception.position_m");
  }
  for (const double bad : {-0.1, 0.79, nan}) {
    EXPECT_EQ(place([&](Scenario& s) { s.ego.uncertainty.heading_rad = bad; }),
              "ego.uncertainty.heading_deg");
  }
  for (const double bad : {-0.1, 20.1, nan}) {
    EXPECT_EQ(place([&](Scenario& s) { s.actors[0].perception.speed_mps = bad; }),
              "actors[0].perception.speed_mps");
  }
  Scene walls = gap_scene(false);
  walls.scenario.actors.front().perception.position_m = 0.1;
  const Result<RankResult> result = rank(walls.scenario, walls.models);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().place, "actors[0] \"left\".perception");
  EXPECT_NE(result.error().remedy.find("ego.uncertainty"), std::string::npos);
}

}  // namespace
}  // namespace crashrank

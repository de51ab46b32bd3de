// Samples of futures: every choice is drawn, with its probability, and sums over them are unbiased.
#include "rank/future_sample.hpp"

#include "rank/futures_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace crashrank {
namespace {

using detail::FutureSample;
using detail::Strata;
using scenes::Scene;

using Probabilities = std::vector<std::vector<double>>;

/// Draws futures of variables with these probabilities.
class Drawn {
public:
  Drawn(const Probabilities& variables, std::size_t futures, std::uint64_t seed = 1)
      : variables_(variables) {
    std::size_t choices = 0;
    for (const std::vector<double>& each : variables) choices += each.size();
    strata_.prepare(futures);
    sample_.prepare(futures, variables.size(), choices);
    for (std::size_t v = 0; v < variables.size(); ++v) {
      sample_.add_variable(1000 * seed + v);
      for (const double probability : variables[v]) sample_.add_choice(probability);
    }
    sample_.draw(strata_);
  }

  const FutureSample& sample() const { return sample_; }
  /// Sum of the probabilities of the futures for which `holds` is true.
  template <class Holds> double probability(const Holds& holds) const {
    double sum = 0.0;
    for (std::size_t f = 0; f < sample_.futures(); ++f) {
      if (holds(f)) sum += sample_.drawn()[f].probability;
    }
    return sum;
  }
  void expect_stated_probabilities(double tolerance) const {
    EXPECT_NEAR(probability([](std::size_t) { return true; }), 1.0, 1e-12);
    for (std::size_t v = 0; v < variables_.size(); ++v) {
      for (std::size_t k = 0; k < variables_[v].size(); ++k) {
        const double drawn = probability([&](std::size_t f) { return sample_.choice(f, v) == k; });
        EXPECT_NEAR(drawn, variables_[v][k], tolerance * variables_[v][k]) << v << " " << k;
      }
    }
  }

private:
  Probabilities variables_;
  Strata strata_;
  FutureSample sample_;
};

TEST(FutureSample, FewCombinationsAreStrataWithTheirProbabilities) {
  const Probabilities variables{{0.986, 0.014}, {0.2, 0.5, 0.3}};
  const Drawn drawn(variables, 64);
  drawn.expect_stated_probabilities(1e-12);
  EXPECT_EQ(drawn.sample().undrawn(), 0U);
  for (std::size_t first = 0; first < 2; ++first) {
    for (std::size_t second = 0; second < 3; ++second) {
      std::size_t count = 0;
      const double sum = drawn.probability([&](std::size_t f) {
        const bool is_it =
            drawn.sample().choice(f, 0) == first && drawn.sample().choice(f, 1) == second;
        count += is_it ? 1 : 0;
        return is_it;
      });
      EXPECT_NEAR(sum, variables[0][first] * variables[1][second], 1e-15);
      EXPECT_GE(count, 5U);  // half of 64 over 6
    }
  }
  const std::vector<DrawnFuture>& futures = drawn.sample().drawn();
  EXPECT_TRUE(std::is_sorted(
      futures.begin(), futures.end(),
      [](const DrawnFuture& p, const DrawnFuture& q) { return p.stratum < q.stratum; }));
}

TEST(FutureSample, ImprobableChoicesOfManyVariablesAreDrawnWithTheirProbabilities) {
  Probabilities variables(10, {0.5, 0.5});
  variables.push_back({0.01, 0.99});
  variables.push_back({0.4, 1e-9, 0.6 - 1e-9});
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const Drawn drawn(variables, 64, seed);
    EXPECT_EQ(drawn.sample().undrawn(), 0U) << seed;
    drawn.expect_stated_probabilities(1e-6);
  }
}

TEST(FutureSample, SumsOverTheMixtureAreUnbiased) {
  // Of variables too many to be fitted: what happens if two improbable choices meet a probable one.
  Probabilities variables(30, {0.45, 0.55});
  variables[3] = {0.97, 0.03};
  variables[7] = {0.02, 0.98};
  constexpr int repeats = 4000;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < repeats; ++i) {
    const Drawn drawn(variables, 64, 77 + static_cast<std::uint64_t>(i));
    const double estimate = drawn.probability([&](std::size_t f) {
      const FutureSample& sample = drawn.sample();
      return (sample.choice(f, 3) == 1 || sample.choice(f, 7) == 0) && sample.choice(f, 12) == 0;
    });
    sum += estimate;
    squares += estimate * estimate;
  }
  const double mean = sum / repeats;
  const double error = std::sqrt((squares / repeats - mean * mean) / repeats);
  const double stated = (1.0 - 0.97 * 0.98) * 0.45;
  // The division by the sum of the weights leaves a bias of less than a hundredth.
  EXPECT_NEAR(mean, stated, 4.0 * error + 0.01 * stated);
  EXPECT_LT(error, 0.02 * stated);
}

TEST(FutureSample, TheMostProbableOfTooManyImprobableChoicesAreDrawn) {
  Probabilities variables;
  for (int i = 0; i < 100; ++i) {
    const double rare = 1e-5 * (i + 1);
    variables.push_back({1.0 - rare, rare});
  }
  const Drawn drawn(variables, 64);
  // 32 futures have one each; a few others occur where futures are drawn freely.
  EXPECT_LE(drawn.sample().undrawn(), 68U);
  EXPECT_GE(drawn.sample().undrawn(), 60U);
  for (std::size_t v = 68; v < 100; ++v) {
    EXPECT_GT(drawn.probability([&](std::size_t f) { return drawn.sample().choice(f, v) == 1; }),
              0.0)
        << v;
  }
  EXPECT_NEAR(drawn.probability([](std::size_t) { return true; }), 1.0, 1e-12);
}

TEST(FutureSample, WhatDoesNotMatterTakesNoFutures) {
  Strata strata;
  strata.prepare(64);
  FutureSample sample;
  sample.prepare(64, 101, 202);
  for (std::uint64_t v = 0; v < 100; ++v) {
    sample.add_variable(v, false);
    sample.add_choice(0.99);
    sample.add_choice(0.01);
  }
  sample.add_variable(100);
  sample.add_choice(0.996);
  sample.add_choice(0.004);
  sample.draw(strata);
  EXPECT_EQ(sample.undrawn(), 0U);
  double sum = 0.0;
  std::size_t others = 0;
  for (std::size_t f = 0; f < 64; ++f) {
    if (sample.choice(f, 100) == 1) sum += sample.drawn()[f].probability;
    for (std::size_t v = 0; v < 100; ++v) others += sample.choice(f, v);
  }
  EXPECT_NEAR(sum, 0.004, 1e-15);
  EXPECT_NEAR(static_cast<double>(others), 64.0, 40.0);  // drawn as stated: 100 times 0.64 of 64
}

TEST(FutureSample, JointFuturesThatCannotAllBeDrawnWeighAlike) {
  const Drawn drawn({std::vector<double>(500, 0.002)}, 64);
  EXPECT_EQ(drawn.sample().undrawn(), 436U);
  for (const DrawnFuture& each : drawn.sample().drawn()) {
    EXPECT_NEAR(each.probability, 1.0 / 64.0, 1e-15);
  }
}

/// The ego drives towards a standing car that exists with a probability; errors and further actors
/// make the futures a sample.
RankResult towards_a_doubtful_car(double exists, double position_error_m, int walkers,
                                  const std::string& name, int far_cars = 0) {
  Scene scene;
  scene.scenario.ego.model =
      scene.add_model("car", scenes::box_mesh({2, 1, 0.75}), BodyKind::car, 1500.0);
  scene.scenario.ego.speed_mps = 20.0;
  scene.add_candidate("on", 0.0);
  scene.add_candidate("brake", -4.0);
  ScenarioActor& car = scene.add_actor(name, 0, 20.0, 0.0);
  car.existence_probability = exists;
  car.perception.position_m = position_error_m;
  for (int k = 0; k < walkers; ++k) {
    scene.add_actor("walker " + std::to_string(k), 0, 30.0 + 6.0 * k, 2.8).existence_probability =
        0.5;
  }
  for (int k = 0; k < far_cars; ++k) {
    scene.add_actor("far " + std::to_string(k), 0, 400.0 + 10.0 * k, 300.0).existence_probability =
        0.99;
  }
  RankOptions options = futures::options_with(false);
  options.infeasible = Infeasible::keep;
  return scene.ranked(options);
}

TEST(FutureSample, ImprobableCarsFarAwayHideNoCrash) {
  const RankResult alone = towards_a_doubtful_car(0.004, 0.01, 0, "car");
  const RankResult among = towards_a_doubtful_car(0.004, 0.01, 40, "car", 40);
  for (const RankResult* each : {&alone, &among}) {
    ASSERT_EQ(each->futures.method, FutureMethod::sampled);
    EXPECT_EQ(each->futures.undrawn, 0U);
    EXPECT_NEAR(each->ranking[0].collision_probability, 0.004, 1e-3);
    EXPECT_GT(*each->ranking[0].score, 0.0);
    EXPECT_EQ(each->ranking[0].candidate, alone.ranking[0].candidate);
  }
}

TEST(FutureSample, ScoresTendToThoseWithoutErrors) {
  for (const double exists : {0.001, 0.014, 0.3, 0.997}) {
    const RankResult certain = towards_a_doubtful_car(exists, 0.0, 0, "car");
    ASSERT_EQ(certain.futures.method, FutureMethod::all);
    for (const char* const name : {"car", "boy", "girl", "p1", "p2"}) {
      const RankResult drawn = towards_a_doubtful_car(exists, 1e-7, 0, name);
      ASSERT_EQ(drawn.futures.method, FutureMethod::sampled);
      for (std::size_t i = 0; i < certain.ranking.size(); ++i) {
        EXPECT_EQ(drawn.ranking[i].candidate, certain.ranking[i].candidate) << exists << name;
        EXPECT_NEAR(*drawn.ranking[i].score, *certain.ranking[i].score,
                    1e-3 * *certain.ranking[i].score);
        EXPECT_NEAR(drawn.ranking[i].collision_probability, exists, 1e-12);
      }
    }
  }
}

TEST(FutureSample, WhatNoCandidateMeetsLeavesAnImprobableCrashInTheScore) {
  const RankResult certain = towards_a_doubtful_car(0.01, 0.0, 0, "car");
  const RankResult drawn = towards_a_doubtful_car(0.01, 0.0, 11, "car");
  ASSERT_EQ(drawn.futures.method, FutureMethod::sampled);
  for (std::size_t i = 0; i < certain.ranking.size(); ++i) {
    EXPECT_EQ(drawn.ranking[i].candidate, certain.ranking[i].candidate);
    EXPECT_NEAR(*drawn.ranking[i].score, *certain.ranking[i].score,
                1e-9 * *certain.ranking[i].score);
  }
}

}  // namespace
}  // namespace crashrank

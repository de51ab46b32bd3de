// Standard errors of scores over a sample of futures, and of their differences.
#include "rank/sampling_error.hpp"

#include "rank/future_sample.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

FutureSummary sample_of(const char* risk, std::vector<DrawnFuture> drawn) {
  FutureSummary sample;
  sample.risk = *risk_from_name(risk);
  sample.drawn = std::move(drawn);
  return sample;
}

FutureSummary equal_draws(const char* risk) {
  return sample_of(risk, std::vector<DrawnFuture>(64, {1.0 / 64.0, 0}));
}

TEST(SamplingError, TheErrorOfADifferenceIsThatOfItsMean) {
  const FutureSummary mean = equal_draws("expected");
  std::vector<double> a;
  std::vector<double> b;
  for (int f = 0; f < 64; ++f) {
    a.push_back(f);
    b.push_back(f + (f % 2 == 0 ? 1.0 : -1.0));
  }
  // The differences are 1 and -1, half each: their variance is 1.
  EXPECT_NEAR(*detail::difference_error(mean, a, b), 1.0 / std::sqrt(63.0), 1e-12);
  for (std::size_t f = 0; f < b.size(); ++f) b[f] = a[f] + 3.0;
  EXPECT_EQ(*detail::difference_error(mean, a, b), 0.0);
  for (const char* const risk : {"worst", "quantile:0.9", "cvar:0.9"}) {
    EXPECT_EQ(*detail::difference_error(equal_draws(risk), a, b), 0.0) << risk;
    b.front() += 1.0;
    EXPECT_FALSE(detail::difference_error(equal_draws(risk), a, b).has_value()) << risk;
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
  EXPECT_NEAR(*detail::difference_error(equal_draws("cvar:0.5"), a, b), std::sqrt(variance / 63.0),
              1e-12);
}

TEST(SamplingError, OnlyWhatVariesWithinAStratumIsASamplingError) {
  // A stratum of 48 futures with probability 0.9 and one of 16 with 0.1.
  std::vector<DrawnFuture> drawn(48, {0.9 / 48.0, 0});
  drawn.resize(64, {0.1 / 16.0, 1});
  const FutureSummary mean = sample_of("expected", drawn);
  std::vector<double> a(48, 0.0);
  a.resize(64, 0.5);
  const std::vector<double> b(64, 0.25);
  EXPECT_FALSE(detail::sampling_error(mean, a).has_value());
  EXPECT_EQ(*detail::difference_error(mean, a, b), 0.0);
  // In the second: 0.25 and 0.75, half each.
  for (std::size_t f = 48; f < 64; ++f) a[f] += f % 2 == 0 ? 0.25 : -0.25;
  const double expected = 0.1 * 0.25 / std::sqrt(15.0);
  EXPECT_NEAR(*detail::sampling_error(mean, a), expected, 1e-15);
  EXPECT_NEAR(*detail::difference_error(mean, a, b), expected, 1e-15);
}

TEST(SamplingError, RoundingIsNoSamplingError) {
  const FutureSummary mean = equal_draws("expected");
  const std::vector<double> a(64, 0.3);
  std::vector<double> b = a;
  b.back() = std::nextafter(0.3, 1.0);
  const auto error = [&mean](const std::vector<double>& scores) {
    return detail::sampling_error(mean, scores);
  };
  EXPECT_FALSE(error(a).has_value());
  EXPECT_FALSE(error(b).has_value());
  EXPECT_EQ(detail::difference_error(mean, a, b), 0.0);
  b.back() = 0.3 + 1e-6;
  EXPECT_GT(error(b), 0.0);
  EXPECT_GT(detail::difference_error(mean, a, b), 0.0);
}

/// Stated and actual errors of the mean of a function of what is drawn for independent variables.
struct Errors {
  double actual = 0.0;  ///< standard deviation over the samples
  double stated = 0.0;  ///< root mean square
  int far = 0;          ///< samples further than three stated errors from the mean of all
};

template <class Value>
Errors errors_over_samples(const std::vector<std::vector<double>>& variables, const Value& value) {
  constexpr int repeats = 1000;
  std::vector<double> means;
  std::vector<double> stated;
  for (std::uint64_t repeat = 0; repeat < repeats; ++repeat) {
    detail::Strata strata;
    strata.prepare(64);
    detail::FutureSample drawn;
    drawn.prepare(64, variables.size(), 100);
    for (std::size_t v = 0; v < variables.size(); ++v) {
      drawn.add_variable(100 * repeat + v);
      for (const double probability : variables[v]) drawn.add_choice(probability);
    }
    drawn.draw(strata);
    FutureSummary sample = sample_of("expected", drawn.drawn());
    sample.fitted = drawn.fitted();
    std::vector<double> scores;
    double mean = 0.0;
    for (std::size_t f = 0; f < 64; ++f) {
      scores.push_back(value([&](std::size_t v) { return drawn.choice(f, v); }));
      mean += drawn.drawn()[f].probability * scores.back();
    }
    means.push_back(mean);
    stated.push_back(detail::sampling_error(sample, scores).value());
  }
  const double mean = std::accumulate(means.begin(), means.end(), 0.0) / repeats;
  Errors errors;
  for (std::size_t k = 0; k < means.size(); ++k) {
    errors.actual += std::pow(means[k] - mean, 2) / (repeats - 1);
    errors.stated += std::pow(stated[k], 2) / repeats;
    if (std::abs(means[k] - mean) > 3.0 * stated[k]) ++errors.far;
  }
  errors.actual = std::sqrt(errors.actual);
  errors.stated = std::sqrt(errors.stated);
  return errors;
}

TEST(SamplingError, AFittedSampleStatesTheErrorThatItHas) {
  std::vector<std::vector<double>> variables(7, {0.4, 0.6});
  variables.push_back({0.03, 0.97});
  variables.push_back({0.2, 0.5, 0.3});
  using Choice = std::function<std::size_t(std::size_t)>;
  const auto alone = [](const Choice& choice, std::size_t v) { return choice(v) == 0 ? 1.0 : 0.0; };
  // A sum over the actors, and what happens if two or three of them meet.
  const auto sum = [&](const Choice& choice) {
    return 0.3 * alone(choice, 0) + 0.5 * alone(choice, 7) + 0.2 * alone(choice, 8);
  };
  const auto pairs = [&](const Choice& choice) {
    return sum(choice) + 0.4 * alone(choice, 1) * alone(choice, 2) +
           0.5 * alone(choice, 3) * alone(choice, 7);
  };
  const auto three = [&](const Choice& choice) {
    return alone(choice, 4) * alone(choice, 5) * alone(choice, 6) + 0.2 * alone(choice, 0);
  };
  const Errors of_sum = errors_over_samples(variables, sum);
  EXPECT_LT(of_sum.actual, 1e-9);
  EXPECT_LT(of_sum.stated, 0.03);
  for (const Errors& each :
       {errors_over_samples(variables, pairs), errors_over_samples(variables, three)}) {
    std::printf("actual error %.4f, stated %.4f, %d of 1000 beyond three\n", each.actual,
                each.stated, each.far);
    EXPECT_GT(each.stated, 0.85 * each.actual);
    EXPECT_LT(each.stated, 2.5 * each.actual);
    EXPECT_LT(each.far, 50);
  }
}

/// Two choices that seldom meet in a sample, each of which matters by itself as well.
TEST(SamplingError, CoversWhatAFittedSampleMayMiss) {
  std::vector<std::vector<double>> variables(9, {0.5, 0.5});
  variables[2] = {0.1, 0.9};
  variables[5] = {0.3, 0.7};
  using Choice = std::function<std::size_t(std::size_t)>;
  const Errors missed = errors_over_samples(variables, [](const Choice& choice) {
    const bool first = choice(2) == 0;
    const bool second = choice(5) == 0;
    return first && second ? 1.0 : (first ? 0.3 : 0.0) + (second ? 0.1 : 0.0);
  });
  std::printf("actual error %.4f, stated %.4f, %d of 1000 beyond three\n", missed.actual,
              missed.stated, missed.far);
  EXPECT_LT(missed.far, 50);
}

TEST(SamplingError, AFutureThatAloneHasAChoiceCountsAsWithoutAFit) {
  FutureSummary sample = equal_draws("expected");
  sample.fitted.actors = 1;
  sample.fitted.choices.assign(64, 0);
  sample.fitted.choices.back() = 1;
  std::vector<double> scores(64, 0.25);
  scores.back() = 0.75;
  const double away = 0.5 - 0.5 / 64.0;
  EXPECT_NEAR(*detail::sampling_error(sample, scores), std::sqrt(5.0) * away / 64.0, 1e-15);
}

}  // namespace
}  // namespace crashrank

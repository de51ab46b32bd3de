#pragma once

#include "crash_test_pairs.hpp"
#include "json.hpp"
#include "validate_plot.hpp"

#include <string>
#include <vector>

namespace crashrank::cli {

/// Relative errors of simulated values against those that were measured.
struct TestErrors {
  double delta_v = 0.0;        ///< mean of |simulated − measured| / measured
  double yaw_rate = 0.0;       ///< likewise
  double worst_delta_v = 0.0;  ///< greatest
  std::size_t delta_v_values = 0;
  std::size_t yaw_rate_values = 0;

  void add_delta_v(double simulated, const std::optional<double>& measured);
  void add_yaw_rate(double simulated, const std::optional<double>& measured);
  /// Divides the sums of `add_delta_v` and `add_yaw_rate`.
  void finish();
  /// Members of the answer in JSON; null without measured values.
  Json json() const;
  /// A line of text, such as "meshes: delta-v off by 4 % in the mean"; empty without values.
  std::string text(const std::string& what) const;
};

/// simulated / measured − 1, and 0 where the measured value is 0.
double relative_error(double simulated, double measured);
/// Such as "+7 %"; empty without a measured value.
std::string relative_error_text(double simulated, const std::optional<double>& measured);

/// The measured values of both cars.
ComparedShape compare_pairs(const std::vector<PairTest>& tests,
                            const std::vector<PairOutcome>& outcomes, const std::string& shape);

/// The answer for crashes between two cars in JSON.
Json pairs_json(const std::vector<PairTest>& tests, const std::vector<PairOutcome>& outcomes);
/// The same as a table, one line a car, and a summary.
std::string pairs_text(const std::vector<PairTest>& tests,
                       const std::vector<PairOutcome>& outcomes);

}  // namespace crashrank::cli

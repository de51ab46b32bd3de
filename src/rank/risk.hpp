#pragma once

#include "crashrank/scenario/harm_options.hpp"

#include <vector>

namespace crashrank::detail {

/// Score of a set of futures and their probability.
struct WeightedScore {
  double score = 0.0;
  double probability = 0.0;
};

/// Risk measure of scores whose probabilities sum to 1. Non-decreasing in every score. Scores with
/// probability 0 have no effect. Sorts the scores, except for the mean.
double risk_of(const RiskMeasure& risk, std::vector<WeightedScore>& scores);

/// Smallest score that is not exceeded with probability `level`. Sorts the scores.
double quantile_of(double level, std::vector<WeightedScore>& scores);

}  // namespace crashrank::detail

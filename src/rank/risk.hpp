#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/harm_options.hpp"

#include <optional>
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

/// Standard error of `risk_of` over the scores in the futures of a sample. Mean: from the variance
/// of the scores within each stratum, as if the futures of a stratum were drawn independently.
/// CVaR: from that of their excess over the quantile. Absent for worst and quantile, for cvar with
/// fewer than 10 drawn futures in the tail, and if the scores of every stratum are equal up to
/// rounding, since futures that were not drawn may differ. `scores` may have more elements than
/// `drawn`.
std::optional<double> sampling_error(const RiskMeasure& risk, View<const double> scores,
                                     const std::vector<DrawnFuture>& drawn);

/// Standard error of the difference of two values of `risk_of`, each over the scores in the same
/// drawn futures: 0 if within every stratum all scores differ by the same number up to rounding.
/// Absent where the error of one of them is, for reasons other than equal scores.
std::optional<double> difference_error(const RiskMeasure& risk, View<const double> a,
                                       View<const double> b, const std::vector<DrawnFuture>& drawn);

}  // namespace crashrank::detail

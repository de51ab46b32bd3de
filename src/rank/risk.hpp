#pragma once

#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/harm_options.hpp"

#include <optional>
#include <vector>

namespace crashrank::detail {

/// The score of some futures and their probability.
struct WeightedScore {
  double score = 0.0;
  double probability = 0.0;
};

/// The risk measure of scores whose probabilities sum to 1; sorts them but for the mean. Monotone
/// in every score. Those with probability 0 count nowhere.
double risk_of(const RiskMeasure& risk, std::vector<WeightedScore>& scores);

/// Standard error of `risk_of` where the scores are those of so many futures drawn alike. Of the
/// mean: from the scores' variance; of cvar: from that of their excess over the quantile. Absent
/// for worst and quantile, for cvar with fewer than 10 drawn futures in its tail, and where the
/// scores do not differ: what was not drawn may.
std::optional<double> sampling_error(const RiskMeasure& risk, std::vector<WeightedScore>& scores,
                                     std::size_t sampled);

}  // namespace crashrank::detail

#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/rank/future_summary.hpp"

#include <optional>

namespace crashrank::detail {

/// Standard error of `risk_of` over the scores in the drawn futures of a sample. Mean: from the
/// variance of what the strata, or the choices to which the probabilities are fitted, do not
/// explain of the scores, as if the futures were drawn independently. CVaR: from that of their
/// excess over the quantile. Absent for worst and quantile, for cvar with fewer than 10 drawn
/// futures in the tail, and if the scores of every stratum, or of all fitted futures, are equal up
/// to rounding, since futures that were not drawn may differ. `scores` may have more elements than
/// futures were drawn.
std::optional<double> sampling_error(const FutureSummary& sample, View<const double> scores);

/// Standard error of the difference of two values of `risk_of`, each over the scores in the same
/// drawn futures: 0 if within every stratum, or over all fitted futures, all scores differ by the
/// same number up to rounding. Absent where the error of one of the values is, for reasons other
/// than equal scores.
std::optional<double> difference_error(const FutureSummary& sample, View<const double> a,
                                       View<const double> b);

}  // namespace crashrank::detail

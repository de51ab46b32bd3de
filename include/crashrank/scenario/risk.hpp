#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/internal/base/export.hpp"

#include <string>

namespace crashrank {

/// How the scores of several futures become one.
enum class RiskKind {
  expected,  ///< the mean, each future weighted by its probability
  cvar,      ///< the mean of the worst share 1 - level; a future at the border counts in part
  worst,     ///< the greatest score of any future with a probability above 0
  quantile,  ///< the least score that is not exceeded with probability `level`
};

/// A risk measure: monotone in every future's score, and the score itself for a single future.
struct RiskMeasure {
  RiskKind kind = RiskKind::expected;  ///< which
  double level = 0.0;                  ///< of cvar and quantile, above 0 and below 1
};

/// Reads "expected", "worst", "cvar:X" or "quantile:X" with X above 0 and below 1. Errors: usage.
CRASHRANK_API Result<RiskMeasure> risk_from_name(const std::string& name);
/// The name that `risk_from_name` reads.
CRASHRANK_API std::string risk_name(const RiskMeasure& risk);

}  // namespace crashrank

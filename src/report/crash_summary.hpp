#pragma once

#include "crashrank/rank/rank.hpp"

namespace crashrank::detail {

/// What reports print of all contacts of a candidate, for one body or for several.
struct CrashSummary {
  double exposure_mps = 0.0;  ///< the largest
  double crush_m = 0.0;       ///< the deepest
  double harm = 0.0;          ///< the sum, persons as weighted
};

CrashSummary crash_of_ego(const CandidateResult& ranked);

/// Of all bodies but the ego, those included that were hit by others.
CrashSummary crash_of_others(const CandidateResult& ranked);

}  // namespace crashrank::detail

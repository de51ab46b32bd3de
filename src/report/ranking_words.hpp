#pragma once

#include "crashrank/rank/rank.hpp"
#include "crashrank/rank/scenario.hpp"

#include <cstddef>
#include <string>

namespace crashrank::detail {

/// What a candidate leads to, one sentence of plain text: "hits the lorry after 1.48 s at 23.1
/// m/s".
std::string outcome_words(const Scenario& scenario, const CandidateResult& ranked);

/// Why the candidate at `place` stands before the next one, plain text. `place` is not the last.
std::string reason_words(const Scenario& scenario, const RankResult& result, std::size_t place);

/// A score with its unit, or its interval where it is not known.
std::string score_words(const CandidateResult& ranked, Measure measure);

}  // namespace crashrank::detail

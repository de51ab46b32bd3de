#pragma once

#include "crashrank/rank/rank.hpp"

#include <string>
#include <vector>

namespace crashrank::detail {

/// A score as text, with no digit past the first that its interval leaves open; five digits where
/// nothing is open. An interval alone where the score is not known.
std::string score_text(const CandidateResult& ranked);

/// The interval, ends rounded outwards to that digit: "0.1 to 0.4"; empty where it is a point.
std::string interval_text(const CandidateResult& ranked);

/// The places it may have: "2", "1-3".
std::string places_text(const CandidateResult& ranked);

/// Neighbours among the first `shown` places that cannot be told apart, one sentence each:
/// "rank 2 and 3 are not separable (their order turns round in 38 % of 129 samples)".
std::vector<std::string> not_separable_words(const RankResult& result, std::size_t shown);

/// What harm was counted with: model, every weight, who is where, ranges. Lines without a break.
std::vector<std::string> harm_words(const HarmOptions& harm);

}  // namespace crashrank::detail

#pragma once

#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <string>
#include <vector>

namespace crashrank::detail {

/// What a reader has to know of the futures that a ranking is of, one sentence each, names as they
/// are; empty where there is one future: how many there are and where they come from, of which of
/// them contacts are reported, by how much a sample's scores are open, how the candidates compare
/// against the likeliest future alone where another one would be first, and whom candidates hit
/// that touch nothing in the likeliest future.
std::vector<std::string> future_words(const Scenario& scenario, const RankResult& result);

/// The score of a candidate in the likeliest future; its score where there is one future.
double likeliest_score(const CandidateResult& ranked);

/// Name of a method in files: "certain", "joint", "all", "sampled".
const char* future_method_name(FutureMethod method);

}  // namespace crashrank::detail

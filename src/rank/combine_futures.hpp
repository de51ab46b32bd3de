#pragma once

#include "rank/evaluate.hpp"

#include <vector>

namespace crashrank::detail {

/// The result of a candidate from those of its outcomes: contacts and damage of the first, which is
/// the likeliest future's, scores and samples of all by the scene's risk measure. `outcomes` tell
/// which futures each result is of.
CandidateResult combine_futures(const Scene& scene, std::vector<CandidateResult>&& results,
                                const std::vector<SimulatedOutcome>& outcomes, Scratch& scratch);

/// The scene's risk measure of scores by future. Sums run in the order of the futures, whichever
/// share an outcome.
double risk_of_futures(const Scene& scene, View<const double> scores,
                       std::vector<WeightedScore>& weighted);

/// Probability of the futures of a group in which the ego touches somebody, from the hits that were
/// found, added to that of the groups before.
double collision_probability(const Scene& scene, const FutureGroup& group, const Scratch& scratch,
                             double before);

}  // namespace crashrank::detail

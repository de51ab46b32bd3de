#pragma once

#include "rank/evaluate.hpp"

#include <vector>

namespace crashrank::detail {

/// Combines the results of all simulated outcomes of a candidate. Contacts and damage are those of
/// the first outcome, which contains the likeliest future; score and samples are the risk measure
/// of the scene over all futures. `outcomes[k].futures` lists the futures of `results[k]`. Where
/// futures have contacts without force, `upper_bound` on the score in any future ends the interval.
CandidateResult combine_futures(const Scene& scene, std::vector<CandidateResult>&& results,
                                const std::vector<SimulatedOutcome>& outcomes, double upper_bound,
                                Scratch& scratch);

/// Risk measure of the scene, applied to one score for each future. Sums run in the order of the
/// futures, so the result does not depend on which futures share a simulation.
double risk_of_futures(const Scene& scene, View<const double> scores,
                       std::vector<WeightedScore>& weighted);

/// Adds to `before` the probability of the futures of a group in which the ego has a contact,
/// according to the hits in `scratch`.
double collision_probability(const Scene& scene, const FutureGroup& group, const Scratch& scratch,
                             double before);

}  // namespace crashrank::detail

#pragma once

#include "crashrank/rank/rank.hpp"
#include "crashrank/rank/scenario.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace crashrank::detail {

/// Whether the bodies overlap at time 0: the contact is not simulated from its first touch.
inline bool begins_in_contact(const Contact& contact) {
  return contact.state == ImpactState::overlapping || contact.state == ImpactState::contained;
}

/// The name of the body that is hit, marked where the contact `begins_in_contact`: "sedan (overlaps
/// at start)".
std::string contact_name(const Scenario& scenario, const Contact& contact);

/// What the mark of `contact_name` means, one sentence without a full stop.
extern const char* const overlap_meaning;

/// What a candidate leads to, one sentence of plain text: "hits the lorry after 1.48 s at 23.1
/// m/s".
std::string outcome_words(const Scenario& scenario, const CandidateResult& ranked);

/// Why the candidate at `place` stands before the next one, or that they are tied, plain text.
/// `place` is the row in the ranking, not the last; `scores` those of `score_texts`.
std::string reason_words(const Scenario& scenario, const RankResult& result,
                         const std::vector<std::string>& scores, std::size_t place);

/// A score, printed as `score`, with its unit and its interval.
std::string score_words(const CandidateResult& ranked, const std::string& score, Measure measure);

}  // namespace crashrank::detail

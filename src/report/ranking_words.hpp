#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace crashrank::detail {

/// Whether the bodies overlap at time 0: the contact is not simulated from its first touch.
inline bool begins_in_contact(ImpactState state) {
  return state == ImpactState::overlapping || state == ImpactState::contained;
}
inline bool begins_in_contact(const Contact& contact) { return begins_in_contact(contact.state); }

/// The actors that the ego hits, each once, in the order of its contacts.
std::vector<std::size_t> hit_actors(const CandidateResult& ranked);

/// The name of the body that is hit, marked where the contact `begins_in_contact` and where it is a
/// `contact_without_force`: "sedan (overlaps at start) (no force)".
std::string contact_name(const Scenario& scenario, const Contact& contact);

/// What the first contact changes where that is little against its closing speed, ", changes its
/// velocity by 5 km/h"; empty where it is more than a brush: a full hit changes the velocity of one
/// of the two by half the closing speed or more. There is a contact.
std::string brush_words(const CandidateResult& ranked);

/// Whether the first contact changes little of what moves: it glances off.
bool is_brush(const CandidateResult& ranked);

/// What the first mark of `contact_name` means, one sentence without a full stop.
extern const char* const overlap_meaning;

/// The names of both bodies: "saloon / pedestrian".
std::string pair_name(const Scenario& scenario, const FurtherContact& contact);

/// Two bodies, neither of which is the ego, that collide.
struct FurtherPair {
  const FurtherContact* first = nullptr;  ///< their first contact
  double harm = 0.0;                      ///< of all their contacts, persons as weighted
};

/// The pairs of others that collide, by their first contacts. They point into `ranked`.
std::vector<FurtherPair> further_pairs(const CandidateResult& ranked);

/// A contact of `ranked` between two others: "saloon is pushed into pedestrian" where the one was
/// hit before and most of the closing speed is its own, else "saloon and lorry collide".
std::string further_words(const Scenario& scenario, const CandidateResult& ranked,
                          const FurtherContact& contact);

/// Where contacts between others injure people, one sentence a pair for the first `shown` rows,
/// names as they are: "brake in lane: saloon is pushed into pedestrian at 1.24 s (harm 0.31)", with
/// the time of the pair's first contact and the harm of all. At most 12, and how many more there
/// are. Empty unless the measure is harm.
std::vector<std::string> pushed_words(const Scenario& scenario, const RankResult& result,
                                      std::size_t shown);

/// That the other order of candidates (RankOrder) has another first one, one sentence; empty where
/// both agree.
std::string other_order_words(const RankResult& result);

/// That another candidate would be first without errors of states, one sentence; empty where none
/// is or where that is not known.
std::string without_errors_words(const RankResult& result);

/// What a candidate leads to, one sentence of plain text: "hits the lorry after 1.48 s at 23.1
/// m/s".
std::string outcome_words(const Scenario& scenario, const CandidateResult& ranked);

/// Why the candidate at `place` stands before the next one, or that they are tied, plain text.
/// `place` is the row in the ranking, not the last; `scores` those of `score_texts`.
std::string reason_words(const Scenario& scenario, View<const Model> models,
                         const RankResult& result, const std::vector<std::string>& scores,
                         std::size_t place);

/// A score, printed as `score`, with its unit and its interval.
std::string score_words(const CandidateResult& ranked, const std::string& score, Measure measure);

}  // namespace crashrank::detail

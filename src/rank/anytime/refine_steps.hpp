#pragma once

#include "rank/anytime/refine.hpp"

#include <limits>
#include <optional>

namespace crashrank::detail {

/// Time of a first contact that does not occur, s.
inline constexpr double no_contact_s = std::numeric_limits<double>::infinity();

/// Narrows the interval of a score by two bounds; it never widens.
void narrow(CandidateState& state, double lowest, double highest);
/// Sets the exact score.
void settle(CandidateState& state, double score);
/// Narrows the interval by what is known of the futures; sets the exact score if all futures with a
/// probability above 0 are known.
void combine(const RefineQuery& q, CandidateState& state, Scratch& scratch);

/// Copies what Scratch::needed marks.
void copy_needed(const Scratch& scratch, CandidateState& state);

/// First moment off the road of the ego on its motion in a future.
std::optional<RoadLeaving> leaving_of(const RefineQuery& q, const CandidateState& state,
                                      const Motion& ego, const Scratch& scratch);
/// The contact of the ego on its motion in a future that a hit of the search begins.
Contact first_contact_of(const RefineQuery& q, const Motion& ego, const Scratch::Hit& hit);

/// First step: finds whether an actor is near the swept boxes of the candidate. Returns false if
/// time was up.
bool find_nearby(const RefineQuery& q, CandidateState& state, Scratch& scratch, RankWork& work);
/// Second step: finds the first contacts of the ego in all futures. Returns false if time was up.
bool search_contacts(const RefineQuery& q, CandidateState& state, Scratch& scratch, RankWork& work);
/// Third step: simulates the scene after the first contact in one future. Returns false if time was
/// up.
///
/// It ends once the candidate is beaten. Of several futures each is left once its own score exceeds
/// what is sought, since all have to be worse on average; if that does not suffice, it starts anew
/// and goes twice as far, because there is no memory for one simulation per future.
bool simulate_crash(const RefineQuery& q, CandidateState& state, Scratch& scratch, RankWork& work);

}  // namespace crashrank::detail

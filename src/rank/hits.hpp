#pragma once

#include "rank/evaluate.hpp"

namespace crashrank::detail {

/// Finds the contacts and grazes of the ego with the actors on all plans that occur in a group of
/// futures, and stores them in `scratch.hits` in order of time. A plan is searched only until the
/// latest of the first contacts of its futures. Returns false if a search stayed undecided.
bool find_hits(const Scene& scene, const Motion& ego, const FutureGroup& group, Scratch& scratch,
               RankWork& work);

/// First contact of the ego with an actor on a plan. The pair is searched in the order of
/// `goes_second`, so that exchanging the two bodies does not change a bit of time and points.
Impact find_impact(const Scene& scene, const Motion& ego, const Plan& plan, double from_s,
                   double until_s, ImpactWorkspace& workspace, const ImpactOptions& options);

/// First contact in a future of the searched group; null if there is none.
const Scratch::Hit* first_hit(const Scene& scene, const Scratch& scratch, std::size_t future);

/// Marks in `relevant` the plans whose contact precedes the first contact of a future, and the plan
/// of that contact. Futures that differ in one of these plans have a different crash.
void mark_relevant_hits(const Scratch& scratch, const Scratch::Hit* first,
                        std::vector<char>& relevant);

/// Returns true if the ego grazes an actor before a time in a future: it passes within the
/// tolerance.
bool grazes_before(const Scene& scene, const Scratch& scratch, std::size_t future, double until_s);

}  // namespace crashrank::detail

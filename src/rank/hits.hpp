#pragma once

#include "rank/evaluate.hpp"

namespace crashrank::detail {

/// Fills `scratch.hits` with the impacts between the ego on its motion in a group of futures
/// and the actors on each of their plans in those, in time order, everything but clean misses; no
/// plan is searched beyond the first contacts of all of its futures. Returns false when some
/// question stayed undecided.
bool find_hits(const Scene& scene, const Motion& ego, const FutureGroup& group, Scratch& scratch,
               RankWork& work);

/// The first contact of those in a future of the group that was searched; null without one.
const Scratch::Hit* first_hit(const Scene& scene, const Scratch& scratch, std::size_t future);

/// Marks the plans whose contact comes before the first contact of a future, and that contact's:
/// another future with another choice of these begins its crash otherwise.
void mark_relevant_hits(const Scratch& scratch, const Scratch::Hit* first,
                        std::vector<char>& relevant);

/// Whether the ego passes an actor within the tolerance before a time in a future.
bool grazes_before(const Scene& scene, const Scratch& scratch, std::size_t future, double until_s);

}  // namespace crashrank::detail

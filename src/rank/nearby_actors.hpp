#pragma once

#include "rank/deadline.hpp"
#include "rank/evaluate.hpp"

#include <cstdint>

namespace crashrank::detail {

/// Finds the plans on which an actor may come near the ego in [from, until] in a future of the
/// group, by swept boxes in time slices. Stores them in `scratch.near`, ordered by first slice.
void find_nearby_actors(const Scene& scene, const Motion& ego, const FutureGroup& group,
                        double from_s, double until_s, Scratch& scratch, RankWork& work);

/// Returns true if the swept boxes of all candidates overlap those of no plan in any time slice.
/// Returns false if the deadline has passed.
bool all_are_clear(const Scene& scene, View<const Candidate> candidates, const Deadline& deadline,
                   std::uint64_t& box_tests);

}  // namespace crashrank::detail

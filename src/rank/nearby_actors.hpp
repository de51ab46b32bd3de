#pragma once

#include "rank/deadline.hpp"
#include "rank/evaluate.hpp"

#include <cstdint>

namespace crashrank::detail {

/// Fills `scratch.near` with the plans on which an actor may come near the ego in [from, until] in
/// a future of the group, by slices of time, the soonest first.
void find_nearby_actors(const Scene& scene, const Motion& ego, const FutureGroup& group,
                        double from_s, double until_s, Scratch& scratch, RankWork& work);

/// Whether the swept boxes of all candidates overlap no plan's in any time slice. False when time
/// is up.
bool all_are_clear(const Scene& scene, View<const Candidate> candidates, const Deadline& deadline,
                   std::uint64_t& box_tests);

}  // namespace crashrank::detail

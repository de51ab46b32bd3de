#pragma once

#include "rank/anytime/watch.hpp"
#include "rank/evaluate.hpp"

#include <cstdint>

namespace crashrank::detail {

/// Fills `scratch.near` with the actors that may come near the ego in [from, until], by slices of
/// time, the soonest first.
void find_near(const Scene& scene, const Motion& ego, double from_s, double until_s,
               Scratch& scratch, RankWork& work);

/// Whether the swept boxes of all candidates together meet nobody's in any slice: so does no
/// candidate's. Left with false when time is up.
bool all_are_clear(const Scene& scene, View<const Candidate> candidates, const Watch& watch,
                   std::uint64_t& box_tests);

}  // namespace crashrank::detail

#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/scenario/candidate.hpp"
#include "rank/scene.hpp"

#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// Leaves actors that are far from all candidates out of the combinations of predictions: those
/// that on none of their plans come within 50 m of the area that candidates cover until the
/// horizon, or within 20, 8 or 2 m if only then all combinations of the others can be listed. How
/// far a crash throws bodies has no useful bound (a light body can take over the energy of heavy
/// ones, and a simulation can last 30 s). So this is a heuristic that the evaluation verifies: a
/// simulation marks every plan that would have influenced it, see `Futures::mark_needed`. `rings`
/// gets, by actor, how near it comes. Does not allocate. Returns
/// false if the futures did not change.
bool leave_out_distant_actors(Scene& scene, View<const Candidate> candidates,
                              std::vector<char>& rings, std::uint64_t& box_tests);

/// Includes the actors marked in `needed`, which it clears, after `repeats` evaluations with other
/// actors; after some of these all actors, so that an evaluation ends. Returns false if none is
/// marked.
bool include_needed_actors(Scene& scene, std::vector<char>& needed, int repeats,
                           std::vector<char>& rings);

}  // namespace crashrank::detail

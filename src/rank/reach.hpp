#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/scenario/candidate.hpp"
#include "rank/scene.hpp"

#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// Leaves actors that are far from all candidates out of the combinations of predictions: those
/// that on none of their plans come near the area that candidates cover until the horizon. How far
/// a crash throws bodies has no useful bound (a light body can take over the energy of heavy ones,
/// and a simulation can last 30 s). So this is a heuristic that the evaluation verifies: a
/// simulation marks every plan that would have influenced it, see `Futures::needs_left_out`.
/// `reached` is working memory, by actor. Does not allocate. Returns false if the futures did not
/// change.
bool leave_out_distant_actors(Scene& scene, View<const Candidate> candidates,
                              std::vector<char>& reached, std::uint64_t& box_tests);

/// Includes all actors. `reached` is working memory, by actor.
void include_all_actors(Scene& scene, std::vector<char>& reached);

}  // namespace crashrank::detail

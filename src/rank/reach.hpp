#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/scenario/candidate.hpp"
#include "rank/scene.hpp"

#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// Leaves actors far from all candidates out of the combinations of predictions: those that on no
/// plan come near the place that candidates take up until the horizon. How far a crash throws
/// bodies has no useful bound (a light body may take over the energy of heavy ones, and a scene may
/// last for 30 s), so this is a guess that evaluating proves: a simulation notes every plan that
/// it would have come near, see `Futures::needs_left_out`. `reached` is room by actor. Allocates
/// nothing. False where the futures stay as they were.
bool leave_out_distant_actors(Scene& scene, View<const Candidate> candidates,
                              std::vector<char>& reached, std::uint64_t& box_tests);

/// No actor is left out. `reached` as above.
void include_all_actors(Scene& scene, std::vector<char>& reached);

}  // namespace crashrank::detail

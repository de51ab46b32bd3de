#pragma once

#include "crashrank/motion/motion.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"
#include "rank/scene.hpp"
#include "rank/stop_check.hpp"

#include <optional>

namespace crashrank::detail {

/// When a plan takes the first wheel of a body off the road, up to a time; absent where it does
/// not. A body without wheels has patches on the ground in place of them (Footing). A wheel that is
/// off for less than 5 cm of its way may be missed. O(way / distance to the border · corners), no
/// allocation. Asks `stop` at every step.
std::optional<RoadLeaving> find_leaving(const Road& road, const Body& body, const Motion& plan,
                                        double until_s, const StopCheck& stop = {});

}  // namespace crashrank::detail

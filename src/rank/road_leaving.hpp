#pragma once

#include "crashrank/motion/motion.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"
#include "rank/scene.hpp"
#include "rank/stop_check.hpp"

#include <optional>

namespace crashrank::detail {

/// First moment until `until_s` at which a wheel of a body on its plan is off the road; absent if
/// there is none. A body without wheels has contact patches in their place (Footing). A wheel that
/// is off the road for less than 5 cm of its path can be missed. O(path length / distance to the
/// border · corners); does not allocate. Checks `stop` at every step.
std::optional<RoadLeaving> find_leaving(const Road& road, const Body& body, const Motion& plan,
                                        double until_s, const StopCheck& stop = {});

}  // namespace crashrank::detail

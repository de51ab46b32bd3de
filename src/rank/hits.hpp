#pragma once

#include "rank/contact_severity.hpp"
#include "rank/evaluate.hpp"

namespace crashrank::detail {

/// Fills `scratch.hits` with what happens between the ego on its planned motion and the actors, in
/// time order, everything but clean misses. Returns false when some question stayed undecided.
bool find_hits(const Scene& scene, const Motion& ego, Scratch& scratch, RankWork& work);

/// Whether one of those is a pass within the tolerance before a time.
bool grazes_before(const Scratch& scratch, double until_s);

/// How long after first contact further ones along the planned motion belong to the same crash.
double window_s(const Scene& scene, double closing_speed_mps);

/// The ego at a time of its planned motion.
EgoAtContact planned(const Motion& motion, double time_s);

}  // namespace crashrank::detail

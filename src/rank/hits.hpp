#pragma once

#include "rank/contact_severity.hpp"
#include "rank/evaluate.hpp"

namespace crashrank::detail {

/// Fills `scratch.hits` with what happens between the ego on its planned motion and the actors, in
/// time order, everything but clean misses. Returns false when some question stayed undecided.
bool find_hits(const Scene& scene, const Motion& ego, Scratch& scratch, RankWork& work);

/// Whether one of those is a pass within the tolerance before a time.
bool grazes_before(const Scratch& scratch, double until_s);

/// Contacts along the planned motion that begin no later than this after the first one belong to
/// the same crash, s. Until then the plan still tells about where the ego is: a body that is
/// stopped within a crash pulse of 0.1 s goes three quarters of the way that it would have gone
/// freely.
inline constexpr double same_crash_s = 0.05;

/// The ego at a time of its planned motion.
EgoAtContact planned(const Motion& motion, double time_s);

}  // namespace crashrank::detail

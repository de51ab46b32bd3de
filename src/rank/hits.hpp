#pragma once

#include "rank/evaluate.hpp"

namespace crashrank::detail {

/// Fills `scratch.hits` with what happens between the ego on its planned motion and the actors
/// until its first contact, in time order, everything but clean misses. Returns false when some
/// question stayed undecided.
bool find_hits(const Scene& scene, const Motion& ego, Scratch& scratch, RankWork& work);

/// Whether one of those is a pass within the tolerance before a time.
bool grazes_before(const Scratch& scratch, double until_s);

}  // namespace crashrank::detail

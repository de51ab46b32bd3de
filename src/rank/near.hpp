#pragma once

#include "rank/evaluate.hpp"

namespace crashrank::detail {

/// Fills `scratch.near` with the actors that may come near the ego in [from, until], by slices of
/// time, the soonest first.
void find_near(const Scene& scene, const Motion& ego, double from_s, double until_s,
               Scratch& scratch, RankWork& work);

}  // namespace crashrank::detail

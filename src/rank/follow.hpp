#pragma once

#include "rank/contact_severity.hpp"
#include "rank/evaluate.hpp"

namespace crashrank::detail {

/// Adds what the ego meets after the first contact of `found`, as each crash leaves it: contacts,
/// motions and where their damage is to be read. Bodies are deformed by then, so contacts are not
/// looked for as strictly as the first: poses every 20 ms tell whether surfaces intersect, and
/// halving tells when they began to. A corner clipped for a shorter time may be missed.
void follow(const Scene& scene, const Candidate& candidate, const EgoAtContact& first,
            const EgoAfterContact& left, Approach& found, Scratch& scratch, RankWork& work);

}  // namespace crashrank::detail

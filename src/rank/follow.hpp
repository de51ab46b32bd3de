#pragma once

#include "rank/aftermath.hpp"
#include "rank/contact_severity.hpp"
#include "rank/evaluate.hpp"
#include "rank/watch.hpp"

#include <cstddef>
#include <optional>

namespace crashrank::detail {

/// Adds what the ego meets after the first contact of `found`, as each crash leaves it: contacts,
/// motions and where their damage is to be read. Bodies are deformed by then, so contacts are not
/// looked for as strictly as the first: poses every 20 ms tell whether surfaces intersect, and
/// halving tells when they began to. A corner clipped for a shorter time may be missed.
void follow(const Scene& scene, const Candidate& candidate, const EgoAtContact& first,
            const EgoAfterContact& left, Approach& found, Scratch& scratch, RankWork& work);

/// The next body that the ego meets from a time on, the first by time, then by actor; none of
/// `met`. `stopped`: time was up before it was known.
std::optional<Scratch::Hit> find_next(const Scene& scene, const Aftermath& aftermath,
                                      View<const std::size_t> met, double from_s,
                                      const Watch& watch, bool& stopped, Scratch& scratch,
                                      RankWork& work);

/// The contact that such a hit is.
Contact make_following_contact(const Scene& scene, const EgoAtContact& ego,
                               const Scratch::Hit& hit);

}  // namespace crashrank::detail

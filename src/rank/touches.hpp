#pragma once

#include "rank/evaluate.hpp"

#include <cstddef>
#include <vector>

namespace crashrank::detail {

/// Starts the list of touches of a crash in `scratch.touches` with the first contact.
void begin_touches(const Scene& scene, const Motion& ego, const Scratch::Hit& first,
                   Scratch& scratch);

/// Completes the list after the simulation in `scratch.chain` has finished. If the first contact
/// has no force, all bodies follow their plans until the first force: the ego then also touches
/// every actor that it reaches on its plan in this future until then. In order of time; of joined
/// bodies only the first, and none whose touch goes over into that first force. Returns false if
/// the search stayed undecided or was stopped. Sets Contact::contact_without_force of each touch.
bool find_touches(const Scene& scene, const Motion& ego, std::size_t future, Scratch& scratch,
                  RankWork& work);

/// Marks in `relevant` the plans on which an actor is touched in this way in any future of the
/// group, after `find_touches`.
void mark_relevant_touches(const Scratch& scratch, std::vector<char>& relevant);

}  // namespace crashrank::detail

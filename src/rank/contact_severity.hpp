#pragma once

#include "rank/scene.hpp"

namespace crashrank::detail {

/// Fills in `contact.severity` from the two motions at first contact. With `scene.pulses` the crash
/// phase is simulated, otherwise one rigid impulse at the point of contact stands for it.
void tell_severity(const Scene& scene, const Motion& ego_motion, Contact& contact);

/// What the search and the scores need of a body beside its shape.
void prepare_body(const ScenarioModel& model, Body& body);

}  // namespace crashrank::detail

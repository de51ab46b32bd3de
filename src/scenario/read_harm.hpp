#pragma once

#include "crashrank/scenario/harm_options.hpp"
#include "scenario/json_object.hpp"

namespace crashrank::detail {

/// Reads risk_model, weights, people, friction, ranges, after_impact and least_struck_share, as far
/// as they are there, over what `harm` holds. That the object has no other keys is the caller's.
void read_harm(const JsonObject& object, HarmOptions& harm);

}  // namespace crashrank::detail

#pragma once

#include "crashrank/scenario/scenario.hpp"
#include "scenario/json_object.hpp"

namespace crashrank::detail {

/// Reads the key "road"; a road without end where it is absent.
Road read_road(const JsonObject& root);

}  // namespace crashrank::detail

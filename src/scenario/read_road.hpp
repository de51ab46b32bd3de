#pragma once

#include "crashrank/scenario/road.hpp"
#include "scenario/json_object.hpp"

namespace crashrank::detail {

/// Reads the key "road"; a road without end where it is absent.
Road read_road(const JsonObject& root);

}  // namespace crashrank::detail

#pragma once

#include "mesh.hpp"

namespace generate {

/// A two-axle rigid lorry with box body and cab over the engine, origin on the ground under the
/// rear axle. Its tail ends high above the road over an under-run bar.
Model build_truck(double edge);

}  // namespace generate

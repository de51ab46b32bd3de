#pragma once

#include "mesh.hpp"

namespace generate {

/// A city bicycle with an adult rider, about `edge` m a triangle side; the rear axle above the
/// origin, which is on the ground.
Model build_bicycle(double edge);

}  // namespace generate

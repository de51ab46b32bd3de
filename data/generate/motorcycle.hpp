#pragma once

#include "mesh.hpp"

namespace generate {

/// A motorcycle of the middle class with its rider, origin on the ground under the rear axle.
Model build_motorcycle(double edge);

}  // namespace generate

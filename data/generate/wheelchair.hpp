#pragma once

#include "mesh.hpp"

namespace generate {

/// A hand-driven wheelchair with an adult in it, origin on the ground under the middle of the axle
/// of the large wheels.
Model build_wheelchair(double edge);

}  // namespace generate

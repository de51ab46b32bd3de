#pragma once

#include "mesh.hpp"

namespace generate {

/// A two-axle tractor with a three-axle semi-trailer in line behind it, 16.5 m, origin on the
/// ground under the middle axle of the trailer. Open between cab and trailer, and below the trailer
/// from the drive axle to the trailer's wheels.
Model build_semitrailer(double edge);

}  // namespace generate

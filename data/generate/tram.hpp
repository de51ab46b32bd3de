#pragma once

#include "mesh.hpp"

namespace generate {

/// A low-floor tram of three sections on four bogies, 30 m, the same at both ends, origin on the
/// rails under the middle of the rear bogie.
Model build_tram(double edge);

}  // namespace generate

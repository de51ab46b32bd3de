#pragma once

#include "crashrank/tree/aabb_tree.hpp"

namespace crashrank::cli {

/// Seconds of one box test and of one triangle test on this machine, between these bodies; NaN
/// where the bodies never got as far as one. The Cb and Cp of T_total = Nb·Cb + Np·Cp.
struct Cost {
  double cb_s = 0.0;
  double cp_s = 0.0;
};

/// Measured apart from the queries asked for: B is pushed into A from several sides; each time the
/// trees are traversed once without looking at triangles, which gives Cb, and once in full, which
/// gives Cp as what is left. Takes a tenth of a second or so.
Cost measure_cost(const AabbTree& a, const AabbTree& b);

}  // namespace crashrank::cli

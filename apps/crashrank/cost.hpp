#pragma once

#include "engine.hpp"

#include "crashrank/model/model.hpp"

namespace crashrank::cli {

/// Seconds of one box test and of one triangle test on this machine with this engine, between
/// these bodies; NaN where they cannot be told apart. The Cb and Cp of T_total = Nb·Cb + Np·Cp.
struct Cost {
  double cb_s = 0.0;
  double cp_s = 0.0;
};

/// Measured apart from the queries asked for: B is pushed into A from six sides, to several depths,
/// and the two times are fitted to what that took (least squares of the relative error, none below
/// zero). Takes up to 0.3 s.
Cost measure_cost(const Engine& engine, const Model& a, const Model& b);

}  // namespace crashrank::cli

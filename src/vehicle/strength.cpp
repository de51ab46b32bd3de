#include "crashrank/internal/vehicle/strength.hpp"

#include <algorithm>

namespace crashrank {

double CrushStrength::share_of_band(double low, double high) const {
  const double inside = std::max(0.0, std::min(high, high_m) - std::max(low, low_m));
  return (inside + rest * (high - low - inside)) / (high_m - low_m);
}

CrushStrength honeycomb_strength(const Honeycomb& honeycomb) {
  const double force_npm = honeycomb.pressure_pa * (honeycomb.high_m - honeycomb.low_m);
  CrushStrength strength;
  // The slope only has to be positive; behind the honeycomb stands a rigid block.
  strength.front = {force_npm, 0.01 * force_npm, honeycomb.depth_m};
  strength.side = strength.front;
  strength.rear = strength.front;
  strength.low_m = honeycomb.low_m;
  strength.high_m = honeycomb.high_m;
  strength.hardening_npm2 = 1e8;
  strength.rigid_npm2 = 1e9;
  return strength;
}

CrushStrength car_strength(const CarShape& shape) {
  constexpr double no_crush_mps = 2.2;
  constexpr double test_mps = 15.6;
  constexpr double test_crush_m = 0.5;
  constexpr double b1 = (test_mps - no_crush_mps) / test_crush_m;
  // Outer faces of the rails at 0.6 of the half width, since front wheels need the rest for
  // steering and tests of 25 % overlap are made to miss them; hinge pillars inside the doors.
  constexpr double rails = 0.6;
  constexpr double cage = 0.8;
  // The compartment begins behind the wheel housing and ends as far before the rear axle.
  constexpr double behind_axle = 0.21;
  constexpr double outside = 0.2;
  // What does not fold between bumper and compartment: folded metal everywhere, and between the
  // rails a transverse engine with its gearbox.
  constexpr double folded_m = 0.07;
  constexpr double engine_m = 0.5;
  constexpr double least_length_m = 0.3;
  // Campbell's line is measured with all that acts in the tests: the inertia of what is pushed
  // aside, which the law adds, has about 0.08 of it.
  constexpr double without_inertia = 0.92;
  constexpr double side_length_m = 0.6;
  CrushStrength strength;
  strength.front.yield_npm = without_inertia * shape.mass_kg * no_crush_mps * b1 / shape.width_m;
  strength.front.slope_npm2 = without_inertia * shape.mass_kg * b1 * b1 / shape.width_m;
  strength.side = {0.5 * strength.front.yield_npm, strength.front.slope_npm2, side_length_m};
  strength.rear = {strength.front.yield_npm, 0.8 * strength.front.slope_npm2, 0.0};
  CrushCore& core = strength.core;
  core.rails_half_width_m = rails * 0.5 * shape.width_m;
  core.cage_half_width_m = cage * 0.5 * shape.width_m;
  core.cage_front_m = shape.rear_axle_x_m + (1.0 - behind_axle) * shape.wheelbase_m;
  core.cage_rear_m = shape.rear_axle_x_m + behind_axle * shape.wheelbase_m;
  core.outside = outside;
  core.inside = (1.0 - outside * (1.0 - rails)) / rails;
  const double before_cage_m = shape.front_x_m - core.cage_front_m - folded_m;
  strength.front.length_m = std::max(least_length_m, before_cage_m);
  core.engine_m = std::clamp(strength.front.length_m - least_length_m, 0.0, engine_m);
  strength.rear.length_m = std::max(least_length_m, core.cage_rear_m - shape.rear_x_m);
  return strength;
}

}  // namespace crashrank

#pragma once

#include "crashrank/base/export.hpp"

#include <Eigen/Core>

#include <cmath>
#include <limits>

namespace crashrank {

/// What a body sets against being crushed by a depth C: a force per unit width F = yield + slope·C
/// (Campbell, SAE 740565; CRASH3), spread over the heights that carry it. Past `depth_m` there is
/// nothing left to fold: it is then next to rigid.
struct CrushLaw {
  double yield_npm = 0.0;   ///< N per metre of width at no depth, >= 0
  double slope_npm2 = 1.0;  ///< N per metre of width and metre of depth, > 0
  double depth_m = std::numeric_limits<double>::infinity();  ///< m
};

/// Where in a body its strength sits, seen from above in body coordinates, m. Crash energy is taken
/// by a core: the rails and what lies between them before and behind the passengers, and the cage
/// around those; wings, door skins and bumper corners beside it fold at a fraction of that force.
struct CrushCore {
  double rails_half_width_m = std::numeric_limits<double>::infinity();  ///< of the longitudinals, m
  /// Of the passengers' cage, m.
  double cage_half_width_m = std::numeric_limits<double>::infinity();
  double cage_front_m = 0.0;  ///< where the cage begins, body coordinates, m
  double cage_rear_m = 0.0;   ///< where it ends, m
  double inside = 1.0;        ///< share of the mean law in the core
  double outside = 1.0;       ///< and beside it

  /// Share of the mean law at a place seen from above, body coordinates, m.
  double share_at(double x_m, double y_m) const {
    const bool caged = x_m <= cage_front_m && x_m >= cage_rear_m;
    return std::abs(y_m) <= (caged ? cage_half_width_m : rails_half_width_m) ? inside : outside;
  }
};

/// How a body resists from its sides, and at which heights.
struct CrushStrength {
  CrushLaw front;  ///< of the front
  CrushLaw side;   ///< of both sides
  CrushLaw rear;   ///< of the rear
  /// Heights over the ground that carry the load, m: sills, rails, bumpers, up to the bonnet. What
  /// is above them (pillars and glass) or below carries `rest` of their pressure.
  double low_m = 0.2;
  double high_m = 0.8;  ///< their upper end, m
  double rest = 0.25;   ///< share of the pressure outside them
  CrushCore core;       ///< what is stiffer inside
  bool rigid = false;   ///< nothing gives way at all: walls, poles

  /// Of a body that does not give way.
  static CrushStrength unyielding() {
    CrushStrength strength;
    strength.rigid = true;
    return strength;
  }
};

/// Pressure of a law at one height: Pa = yield + slope·C, up to a depth.
struct CrushPressure {
  double yield_pa = 0.0;                                     ///< Pa
  double slope_papm = 1.0;                                   ///< > 0
  double depth_m = std::numeric_limits<double>::infinity();  ///< m
  bool rigid = false;                                        ///< does not give way at all
};

/// The law of a body where a force enters at a point (body coordinates, m, on the ground plane of
/// the body at z = 0) along `inward` (body axes): front, side and rear blend with the squares of
/// the direction's parts, so that nothing jumps where an oblique force turns.
CRASHRANK_API CrushPressure pressure_at(const CrushStrength& strength,
                                        const Eigen::Vector3d& point_m,
                                        const Eigen::Vector2d& inward);

/// What two bodies pressed into each other by `depth_m` share: equal pressures.
struct SharedCrush {
  double pressure_pa = 0.0;    ///< between the bodies, Pa
  double depth_a_m = 0.0;      ///< A's crush, m
  double depth_b_m = 0.0;      ///< B's crush, m
  double energy_a_jpm2 = 0.0;  ///< J per m² of the view, from nothing to this depth
  double energy_b_jpm2 = 0.0;  ///< taken up by B, J/m²
};

/// Splits a depth between two bodies of which one at least yields (two rigid ones: pressure is
/// infinite, depths are 0).
CRASHRANK_API SharedCrush share_crush(const CrushPressure& a, const CrushPressure& b,
                                      double depth_m);

/// What the strength of a car is made from.
struct CarShape {
  double mass_kg = 1500.0;     ///< kg
  double width_m = 1.8;        ///< without mirrors
  double rear_axle_x_m = 0.0;  ///< in body coordinates, m
  double wheelbase_m = 2.7;    ///< m
};

/// Strength of a car. Its mean is Campbell's straight line between impact speed and residual crush
/// in full-width barrier tests: no crush at 2.2 m/s (5 mph, the bumper standard), 0.5 m at 15.6 m/s
/// (56 km/h, about what mid-size cars show in the NCAP barrier test), so yield = m·b0·b1/w and
/// slope = m·b1²/w with b1 = 26.8 1/s. The side yields at half of that force with the same slope,
/// the rear at the same force with 0.8 of the slope: about the ratios between the classes that
/// CRASH3 tabulates.
/// The core is 0.6 of the half width between the rails' outer faces (front wheels need the rest for
/// steering; tests of 25 % overlap are made to miss them) and 0.82 in the cage, whose hinge pillars
/// stand inside the doors; the cage begins 0.14 wheelbases behind the front axle, where the wheel
/// housing ends, and ends as far before the rear one. Beside the core the force is a tenth of the
/// mean; the core takes what that leaves, so that the full width keeps Campbell's sum.
CRASHRANK_API CrushStrength car_strength(const CarShape& shape);

}  // namespace crashrank

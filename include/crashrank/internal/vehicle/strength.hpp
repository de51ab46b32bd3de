#pragma once

#include "crashrank/internal/base/export.hpp"

#include <cmath>
#include <limits>

namespace crashrank {

/// Resistance of a body against being crushed from one side: force per unit width
/// F = yield + slope·C at a crush depth C (Campbell, SAE 740565; CRASH3), spread over the heights
/// that bear it. Behind `length_m` lies structure that hardens, see CrushStrength.
struct CrushLaw {
  double yield_npm = 0.0;   ///< N per metre of width at no depth, >= 0
  double slope_npm2 = 1.0;  ///< N per metre of width and metre of depth, > 0
  double length_m = std::numeric_limits<double>::infinity();  ///< free crush length, m, > 0
};

/// Where the strength of a body lies, seen from above in body coordinates, m: the rails and what
/// lies between them before and behind the passengers, and the compartment around those. Wings,
/// door skins and bumper corners beside the core fold at a fraction of its force.
struct CrushCore {
  double rails_half_width_m = std::numeric_limits<double>::infinity();  ///< of the longitudinals, m
  double cage_half_width_m = std::numeric_limits<double>::infinity();   ///< of the compartment, m
  double cage_front_m = 0.0;  ///< where the compartment begins, x, m
  double cage_rear_m = 0.0;   ///< where it ends, x, m
  /// Height of its floor over the ground, m: what is crushed below intrudes nowhere.
  double floor_m = 0.0;
  /// Rigid parts between the rails before the compartment, along x, m: what they are pushed by
  /// comes off the free crush length of the front and reaches the compartment.
  double engine_m = 0.0;
  double inside = 1.0;   ///< share of the mean law in the core
  double outside = 1.0;  ///< and beside it
};

/// Resistance of a body from all sides and at all heights.
struct CrushStrength {
  CrushLaw front;  ///< of the front
  CrushLaw side;   ///< of both sides
  CrushLaw rear;   ///< of the rear
  /// Heights over the ground that bear the load, m: sills, rails, bumpers, up to the bonnet. What
  /// is above them (pillars and glass) or below bears `rest` of their pressure.
  double low_m = 0.2;
  double high_m = 0.8;  ///< their upper end, m
  double rest = 0.25;   ///< share of the pressure outside them, 0 to 1
  CrushCore core;       ///< what is stiffer inside
  /// Structure of the core behind the free crush length adds `hardening_npm2` to the slope, and
  /// after `hardening_length_m` more `rigid_npm2`, N per metre of width and metre of depth: engine,
  /// then chassis, compartment or bones, which no crash of this model leaves behind.
  double hardening_npm2 = 0.0;
  double hardening_length_m = 0.4;  ///< m, > 0
  double rigid_npm2 = 0.0;          ///< N/m²
  bool rigid = false;               ///< nothing gives way: walls, poles

  /// Of a body that does not give way.
  static CrushStrength unyielding() {
    CrushStrength strength;
    strength.rigid = true;
    return strength;
  }

  /// The mean law's share that a band of heights bears, N/m² of a wall over N/m of width: 1/m times
  /// the height of the band.
  CRASHRANK_API double share_of_band(double low, double high) const;
};

/// Crushable layer around a rigid core: the honeycomb of a deformable barrier, a crash cushion. It
/// folds at a constant pressure, equal from all sides.
struct Honeycomb {
  double pressure_pa = 0.0;  ///< at which it folds, Pa, > 0
  double depth_m = 0.0;      ///< free crush length, m, > 0
  double low_m = 0.0;        ///< lower end over the ground, m
  double high_m = 0.0;       ///< upper end, m, > low_m

  /// Equal in all numbers.
  friend bool operator==(const Honeycomb& a, const Honeycomb& b) noexcept {
    return a.pressure_pa == b.pressure_pa && a.depth_m == b.depth_m && a.low_m == b.low_m &&
           a.high_m == b.high_m;
  }
};

/// Strength of a body behind such a layer.
CRASHRANK_API CrushStrength honeycomb_strength(const Honeycomb& honeycomb);

/// Measures from which a car's strength is derived.
struct CarShape {
  double mass_kg = 1500.0;     ///< kg
  double width_m = 1.8;        ///< without mirrors
  double front_x_m = 3.6;      ///< x of the foremost point, body coordinates, m
  double rear_x_m = -0.9;      ///< x of the rearmost point, m
  double rear_axle_x_m = 0.0;  ///< x of the rear axle, m
  double wheelbase_m = 2.7;    ///< m
};

/// Strength of a car. Its mean is Campbell's straight line between impact speed and residual crush
/// in full-width barrier tests: no crush at 2.2 m/s (5 mph, the bumper standard), 0.5 m at 15.6 m/s
/// (56 km/h, about what mid-size cars show in the NCAP barrier test), so yield = m·b0·b1/w and
/// slope = m·b1²/w with b1 = 26.8 1/s. The side yields at a part of that force with the same slope,
/// the rear at the same force with 0.8 of the slope: about the ratios between the classes that
/// CRASH3 tabulates. docs/crash-parameters.md lists every parameter with its reason.
CRASHRANK_API CrushStrength car_strength(const CarShape& shape);

}  // namespace crashrank

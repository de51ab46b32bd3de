#pragma once

#include "crashrank/base/box.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/internal/base/export.hpp"

#include <Eigen/Core>

#include <optional>

namespace crashrank {

/// What a model file states of a body's mass. What is absent is derived, see `describe_vehicle`.
struct StatedMass {
  std::optional<double> mass_kg;                    ///< with all aboard, > 0
  std::optional<Eigen::Vector3d> center_of_mass_m;  ///< body coordinates, m
  /// About the vertical axis through the centre of mass, kg·m².
  std::optional<double> yaw_inertia_kgm2;
};

/// Checks that a yaw inertia is at least 1 % of that of an even block over the body's bounds and at
/// most that of a ring: all mass at the ends of their diagonal. `extent_m` is length, width,
/// height. Errors: bad_input; the place is "yaw inertia".
CRASHRANK_API Status check_yaw_inertia(double yaw_inertia_kgm2, double mass_kg,
                                       const Eigen::Vector3d& extent_m);

/// Checks what is stated of a body with these bounds: a finite mass above 0; a centre of mass
/// within the bounds, to 1 µm, and at most 2 km from the origin each way; a finite yaw inertia
/// above 0, and as `check_yaw_inertia` where a mass is stated. Errors: bad_input; the place is
/// "mass", "centre of mass" or "yaw inertia".
CRASHRANK_API Status check_stated_mass(const StatedMass& stated, const Box& bounds);

}  // namespace crashrank

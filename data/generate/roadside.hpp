#pragma once

#include "mesh.hpp"

namespace generate {

/// A New Jersey concrete barrier, 4 m along x, 0.81 m high, origin on the ground in its middle.
Model build_jersey_barrier(double edge);

/// A rigid pole of 254 mm diameter and 6 m height, origin on the ground on its axis.
Model build_pole(double edge);

/// A wall 10 m along y, 2.5 m high and 0.25 m thick; its face towards -x stands in x = 0.
Model build_wall(double edge);

/// A young avenue tree of 7 m, trunk and crown, origin on the ground on its axis.
Model build_tree(double edge);

/// A steel guard rail of 8.2 m along x on three posts, its face towards -y; origin on the ground in
/// the middle.
Model build_guard_rail(double edge);

}  // namespace generate

#pragma once

#include "crash/surface_pass.hpp"

#include "crashrank/base/view.hpp"

namespace crashrank::detail {

/// Exposure of a person on foot by the part of the body that lies in the way of others, m/s.
///
/// A person is no rigid body: what is struck takes the striker's speed at once, and the rest
/// follows at its joints, later and by less. With the closing velocity v at the person's centre of
/// mass and the share s of the body, of its height where both have an outline, that the strikers
/// pass over as they move on along v, the root of the mean square of the change of velocity over
/// the whole mass m is
///
///   v·sqrt(s) / (1 + s·m/M)        M: mass of the striker
///
/// which is what a rigid body is exposed to where all of it is struck. `strikers`: bodies that
/// press on it as one, with the velocity and the mass of the first.
double struck_part_mps(const PressedBody& person, View<const PressedBody* const> strikers);

}  // namespace crashrank::detail

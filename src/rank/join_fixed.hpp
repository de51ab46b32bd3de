#pragma once

#include "crashrank/base/result.hpp"
#include "rank/scene.hpp"

namespace crashrank::detail {

/// Finds bodies of a scene that nothing moves and that adjoin each other (`adjoin`), and gives each
/// set one common outline, so that a wall acts the same however it is cut. What may not exist is
/// joined to none, but listed as adjoining. Uses the poses at time 0: bodies that nothing moves
/// keep their places. Errors: as `describe_vehicle`.
Status join_fixed(Scene& scene);

}  // namespace crashrank::detail

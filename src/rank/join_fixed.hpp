#pragma once

#include "crashrank/base/result.hpp"
#include "rank/scene.hpp"

namespace crashrank::detail {

/// Finds fixed bodies that adjoin each other (`adjoin`) and gives each set one common outline, so
/// that a wall behaves the same however it is divided into bodies. Bodies that may be absent are
/// not joined but listed in Scene::adjoining. Errors: as `describe_vehicle`.
Status join_fixed(Scene& scene);

}  // namespace crashrank::detail

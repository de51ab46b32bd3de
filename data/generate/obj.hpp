#pragma once

#include "mesh.hpp"

#include <string>

namespace generate {

/// The model as Wavefront OBJ: an object a part, coordinates in m with four decimals, `about` as
/// the comment at its head.
std::string to_obj(const Model& model, const std::string& about);

}  // namespace generate

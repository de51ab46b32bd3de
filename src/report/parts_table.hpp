#pragma once

#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/rank/contact.hpp"

#include <string>

namespace crashrank::detail {

/// An HTML table of a body's damaged parts, the largest area first, at most 12. Title and names
/// are escaped.
std::string parts_table(const std::string& title, const TriangleMesh& mesh,
                        const BodyDamage& damage);

}  // namespace crashrank::detail

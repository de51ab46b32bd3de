#pragma once

#include "crashrank/mesh/profile.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <string>

namespace crashrank::cli {

/// A picture of the outlines of a profile as SVG: a panel for every height band that has one, seen
/// from above with x to the right, at one scale.
std::string profile_picture(const Profile& profile, const std::string& title);

/// A sentence about a body that a crash does not see as one; empty for others.
std::string profile_warning(const Profile& profile, const TriangleMesh& mesh);

}  // namespace crashrank::cli

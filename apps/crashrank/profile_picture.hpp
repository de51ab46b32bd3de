#pragma once

#include "crashrank/mesh/profile.hpp"

#include <string>

namespace crashrank::cli {

/// A picture of the outlines of a profile as SVG: a panel for every height band that has one, seen
/// from above with x to the right, at one scale.
std::string profile_picture(const Profile& profile, const std::string& title);

}  // namespace crashrank::cli

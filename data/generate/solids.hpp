#pragma once

#include "mesh.hpp"

#include <vector>

namespace generate {

/// A closed box of half sizes `half` with edges rounded by `radius` (0: sharp), squares of about
/// `edge` m.
Mesh box(const Vec3& center, const Vec3& half, double radius, double edge);

/// The surface swept by turning the profile (radius, height along the axis) about the line through
/// `center` along +y; profile points run so that the solid is on their left hand. A radius of zero
/// closes the surface.
Mesh turned(const std::vector<Vec2>& profile, const Vec3& center, double edge, int least_sides = 8);

/// A bar with round section from a to b, radii ra and rb, with flat closed ends.
Mesh bar(const Vec3& a, const Vec3& b, double ra, double rb, double edge, int least_sides = 6);

/// The prism of a closed polygon in (y, z) from x0 to x1, ends closed by a fan about the middle of
/// the polygon (which must see every corner). Corners run counter-clockwise seen from +x.
Mesh prism(const std::vector<Vec2>& corners, double x0, double x1, double edge);

/// A bent grid: `rows` x `columns` places, joined by quads.
Mesh sheet(const std::vector<std::vector<Vec3>>& places);

}  // namespace generate

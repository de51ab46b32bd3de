#pragma once

#include <array>

/// Exact referees for the collider. They answer one question, "do two closed triangles with double
/// coordinates share a point", each in its own way and without a line of the library's code.
namespace oracle {

using Point = std::array<double, 3>;

/// Convex hull of three points: a triangle, or a segment or a point when they are degenerate.
using Triangle = std::array<Point, 3>;

/// Boost.Multiprecision integers. Both triangles are written in barycentric coordinates, the three
/// equations "point of A = point of B" are solved by fraction-free elimination, and Fourier-Motzkin
/// elimination decides whether the six inequalities leave a solution. No orientation test, no case
/// for coplanar or degenerate input: those only lower the rank of the system. Coordinates must be
/// finite.
bool rational_intersects(const Triangle& a, const Triangle& b);

/// CGAL's do_intersect in its kernel of exact predicates and exact constructions. Degenerate
/// triangles are handed over as the Segment_3 or Point_3 that they are, since CGAL asks for that.
bool cgal_intersects(const Triangle& a, const Triangle& b);

}  // namespace oracle

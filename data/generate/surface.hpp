#pragma once

#include "field.hpp"
#include "mesh.hpp"

namespace generate {

/// The zero surface of `field` inside the box low..high as a closed mesh with triangles of about
/// `edge` m a side: nodes on a grid, one vertex for every cell the surface crosses, joined across
/// crossed edges, evened out along the surface and carried onto it. Half a cell lies on each side
/// of y = 0, so that a symmetric solid has vertices on its symmetry plane.
Mesh extract_surface(const Field& field, const Vec3& low, const Vec3& high, double edge);

/// Slope of the field by central differences.
Vec3 slope(const Field& field, const Vec3& p);

/// The point carried onto the surface along the slope.
Vec3 onto_surface(const Field& field, Vec3 p, int rounds = 2);

}  // namespace generate

#pragma once

#include "mesh.hpp"

#include <vector>

namespace generate {

/// Takes edges shorter than `shortest` out of the mesh and turns edges between needle triangles,
/// where the surface, its border and the borders between labels keep their places. `label` has one
/// entry a triangle.
void tidy(Mesh* mesh, std::vector<int>* label, double shortest);

/// How far a triangle is from a needle: twice its area over the square of its longest edge, 0.87
/// for an even-sided one.
double fatness(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace generate

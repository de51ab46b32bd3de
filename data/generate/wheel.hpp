#pragma once

#include "field.hpp"
#include "mesh.hpp"

namespace generate {

/// A wheel's tyre and rim, separate meshes, about the +y axis with the outer face towards +y.
struct Wheel {
  Mesh tyre;
  Mesh rim;
};

/// `radius` of the tyre, `rim` of the rim, `width` of the tyre, all m.
Wheel wheel(const Vec3& center, double radius, double rim, double width, int spokes, double edge);

/// A motorcycle's wheel: the tyre round in section.
Wheel round_wheel(const Vec3& center, double radius, double rim, double width, int spokes,
                  double edge);

/// Adds a motorcycle's wheel as `wheel_PLACE` and `rim_PLACE`.
void add_round_wheel(const std::string& place, const Vec3& center, double radius, double rim,
                     double width, double edge, Model* model);

/// The housing of a left wheel: a half barrel of `radius` about the axle from the body's skin in to
/// `hub.y()`, closed there by a wall, down to `floor_z`. `hub` is the axle's place on that wall.
Mesh wheel_housing(const Field& body, const Vec3& hub, double radius, double floor_z, double edge);

}  // namespace generate

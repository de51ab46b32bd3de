#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <string>
#include <vector>

namespace generate {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

/// An indexed triangle surface while it is being shaped, m. Triangles wind counter-clockwise seen
/// from outside.
struct Mesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;

  void append(const Mesh& other);
};

/// The mesh with y negated and its winding kept outward.
Mesh mirrored(const Mesh& mesh);

/// Moves every vertex by `offset`.
Mesh moved(Mesh mesh, const Vec3& offset);

/// A part of a model: what a scenario's damage report names.
struct NamedMesh {
  std::string name;
  Mesh mesh;
};

/// A model: parts in the order they are written. Body coordinates: x forward, y left, z up.
struct Model {
  std::vector<NamedMesh> parts;

  /// Adds to the part of that name, or begins it.
  void add(const std::string& name, const Mesh& mesh);
  /// Adds `NAME_left` as given and `NAME_right` mirrored.
  void add_both_sides(const std::string& name, const Mesh& left);
  /// Adds all parts of another model, moved by `offset`.
  void append(const Model& other, const Vec3& offset = Vec3::Zero());
  std::size_t triangle_count() const;
};

/// cos and sin of `turns` full turns, by sums and products alone, so that the bits are the same on
/// every machine (the C library's differ from one to the next).
Vec2 unit_circle(double turns);

/// How many steps of about `edge` cover `length`, at least `least`.
int steps(double length, double edge, int least = 1);

}  // namespace generate

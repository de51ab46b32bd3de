#include "mesh.hpp"

#include <algorithm>
#include <cmath>

namespace generate {

void Mesh::append(const Mesh& other) {
  const int base = static_cast<int>(vertices.size());
  vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const std::array<int, 3>& t : other.triangles) {
    triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  }
}

Mesh mirrored(const Mesh& mesh) {
  Mesh result = mesh;
  for (Vec3& vertex : result.vertices) vertex.y() = -vertex.y();
  for (std::array<int, 3>& t : result.triangles) std::swap(t[1], t[2]);
  return result;
}

Mesh moved(Mesh mesh, const Vec3& offset) {
  for (Vec3& vertex : mesh.vertices) vertex += offset;
  return mesh;
}

void Model::add(const std::string& name, const Mesh& mesh) {
  if (mesh.triangles.empty()) return;
  const auto known = std::find_if(parts.begin(), parts.end(),
                                  [&](const NamedMesh& part) { return part.name == name; });
  if (known != parts.end()) {
    known->mesh.append(mesh);
  } else {
    parts.push_back({name, mesh});
  }
}

void Model::add_both_sides(const std::string& name, const Mesh& left) {
  add(name + "_left", left);
  add(name + "_right", mirrored(left));
}

void Model::append(const Model& other, const Vec3& offset) {
  for (const NamedMesh& part : other.parts) add(part.name, moved(part.mesh, offset));
}

std::size_t Model::triangle_count() const {
  std::size_t count = 0;
  for (const NamedMesh& part : parts) count += part.mesh.triangles.size();
  return count;
}

Vec2 unit_circle(double turns) {
  const double fraction = turns - std::floor(turns);
  const double eighths = std::floor(fraction * 8.0 + 0.5);
  // At most a sixteenth of a turn is left: the series below end under 1e-15.
  const double a = (fraction - eighths / 8.0) * 6.283185307179586;
  const double a2 = a * a;
  double c = 1.0;
  double s = a;
  double c_term = 1.0;
  double s_term = a;
  for (int n = 1; n <= 7; ++n) {
    c_term *= -a2 / ((2.0 * n - 1.0) * (2.0 * n));
    s_term *= -a2 / ((2.0 * n) * (2.0 * n + 1.0));
    c += c_term;
    s += s_term;
  }
  constexpr double h = 0.7071067811865476;
  static constexpr std::array<std::array<double, 2>, 8> corner = {
      {{1, 0}, {h, h}, {0, 1}, {-h, h}, {-1, 0}, {-h, -h}, {0, -1}, {h, -h}}};
  const std::array<double, 2>& k = corner[static_cast<std::size_t>(eighths) % 8];
  return {k[0] * c - k[1] * s, k[1] * c + k[0] * s};
}

int steps(double length, double edge, int least) {
  return std::max(least, static_cast<int>(std::floor(length / edge + 0.5)));
}

}  // namespace generate

#include "crashrank/mesh/properties.hpp"

#include <Eigen/Geometry>

#include <cmath>

namespace crashrank {
namespace {

using Vector = Eigen::Vector3d;

double dot(const Vector& a, const Vector& b) {
  return (a.x() * b.x() + a.y() * b.y()) + a.z() * b.z();
}

// Written out, so that no library chooses the order of the sums.
Vector cross(const Vector& a, const Vector& b) {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(),
          a.x() * b.y() - a.y() * b.x()};
}

struct Corners {
  Vector a, b, c;
};

Corners corners(const Triangle& triangle, const Vector& from) {
  return {triangle.corner[0].cast<double>() - from, triangle.corner[1].cast<double>() - from,
          triangle.corner[2].cast<double>() - from};
}

double area(const Corners& t) {
  const Vector normal = cross(t.b - t.a, t.c - t.a);
  return 0.5 * std::sqrt(dot(normal, normal));
}

}  // namespace

ShellProperties shell_properties(const TriangleMesh& mesh) {
  ShellProperties properties;
  Vector moment = Vector::Zero();
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const Corners t = corners(mesh.triangle(i), Vector::Zero());
    const double share = area(t);
    properties.area_m2 += share;
    moment += ((t.a + t.b) + t.c) * (share / 3.0);
    properties.volume_m3 += dot(t.a, cross(t.b, t.c)) / 6.0;
  }
  if (properties.area_m2 == 0.0) return properties;
  properties.center_m = moment / properties.area_m2;

  // Over a triangle, the mean of p_i·p_j is (sum over corners of a_i·a_j + s_i·s_j) / 12, s being
  // the sum of the corners.
  std::array<double, 6> second{};  // means of xx, yy, zz, xy, xz, yz
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const Corners t = corners(mesh.triangle(i), properties.center_m);
    const Vector s = (t.a + t.b) + t.c;
    const double share = area(t) / properties.area_m2 / 12.0;
    const auto mean = [&](int p, int q) {
      return share * (((t.a[p] * t.a[q] + t.b[p] * t.b[q]) + t.c[p] * t.c[q]) + s[p] * s[q]);
    };
    second[0] += mean(0, 0);
    second[1] += mean(1, 1);
    second[2] += mean(2, 2);
    second[3] += mean(0, 1);
    second[4] += mean(0, 2);
    second[5] += mean(1, 2);
  }
  properties.inertia_per_kg_m2 = {second[1] + second[2],
                                  second[0] + second[2],
                                  second[0] + second[1],
                                  -second[3],
                                  -second[4],
                                  -second[5]};
  return properties;
}

}  // namespace crashrank

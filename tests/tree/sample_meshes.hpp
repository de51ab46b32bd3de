#pragma once

#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <cstdint>
#include <random>

namespace crashrank::test {

inline constexpr SplitRule all_rules[] = {SplitRule::min_relative_segment, SplitRule::paper,
                                          SplitRule::sah, SplitRule::median};

/// Uniform in [0, 1), the same with every standard library.
inline float unit_real(std::mt19937_64& random) {
  return static_cast<float>(random() >> 40U) * 0x1p-24F;
}

inline Eigen::Vector3f unit_point(std::mt19937_64& random) {
  const float x = unit_real(random);
  const float y = unit_real(random);
  const float z = unit_real(random);
  return {x, y, z};
}

inline void add_triangle(TriangleMesh& mesh, const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                         const Eigen::Vector3f& c) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
  mesh.triangles.push_back({first, first + 1, first + 2});
}

/// Triangles of about `size` anywhere in the unit cube.
inline TriangleMesh triangle_soup(std::size_t triangles, float size, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  TriangleMesh mesh;
  for (std::size_t i = 0; i < triangles; ++i) {
    const Eigen::Vector3f at = unit_point(random);
    const Eigen::Vector3f c = at + size * unit_point(random);
    const Eigen::Vector3f b = at + size * unit_point(random);
    add_triangle(mesh, at, b, c);
  }
  return mesh;
}

/// A band of equal triangles along x, each touching the next: the literal rule finds every split
/// index as good as the first and peels one triangle a level.
inline TriangleMesh strip(std::size_t triangles) {
  TriangleMesh mesh;
  for (std::size_t i = 0; i < triangles; ++i) {
    const auto x = static_cast<float>(i);
    add_triangle(mesh, {x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0});
  }
  return mesh;
}

}  // namespace crashrank::test

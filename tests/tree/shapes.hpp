#pragma once

#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/tree/build.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace crashrank::test {

/// A box with outward triangles, `cuts` squares along every edge.
inline TriangleMesh box_mesh(const Eigen::Vector3d& half, const Eigen::Vector3d& center = {0, 0, 0},
                             std::uint32_t cuts = 1) {
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
      for (std::uint32_t i = 0; i <= cuts; ++i) {
        for (std::uint32_t j = 0; j <= cuts; ++j) {
          Eigen::Vector3d p = center;
          p[axis] += side * half[axis];
          p[u] += half[u] * (2.0 * i / cuts - 1.0);
          p[v] += half[v] * (2.0 * j / cuts - 1.0);
          mesh.vertices.push_back(p.cast<float>());
        }
      }
      for (std::uint32_t i = 0; i < cuts; ++i) {
        for (std::uint32_t j = 0; j < cuts; ++j) {
          const std::uint32_t a = base + i * (cuts + 1) + j;
          const std::uint32_t b = a + cuts + 1;
          std::array<std::uint32_t, 3> first{a, b, b + 1};
          std::array<std::uint32_t, 3> second{a, b + 1, a + 1};
          if (side < 0) {
            std::swap(first[1], first[2]);
            std::swap(second[1], second[2]);
          }
          mesh.triangles.push_back(first);
          mesh.triangles.push_back(second);
        }
      }
    }
  }
  return mesh;
}

/// A sphere of rings and sectors with outward triangles, two of its corners on the poles.
inline TriangleMesh sphere_mesh(double radius, std::uint32_t rings,
                                const Eigen::Vector3d& center = {0, 0, 0}) {
  constexpr double pi = std::numbers::pi;
  TriangleMesh mesh;
  const std::uint32_t sectors = 2 * rings;
  const auto vertex = [&](double polar, double round) {
    const Eigen::Vector3d n(std::sin(polar) * std::cos(round), std::sin(polar) * std::sin(round),
                            std::cos(polar));
    mesh.vertices.push_back((center + radius * n).cast<float>());
  };
  vertex(0, 0);
  for (std::uint32_t i = 1; i < rings; ++i) {
    for (std::uint32_t j = 0; j < sectors; ++j) vertex(pi * i / rings, 2 * pi * j / sectors);
  }
  vertex(pi, 0);
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  for (std::uint32_t j = 0; j < sectors; ++j) {
    const std::uint32_t k = (j + 1) % sectors;
    mesh.triangles.push_back({0, 1 + j, 1 + k});
    for (std::uint32_t i = 0; i + 2 < rings; ++i) {
      const std::uint32_t upper = 1 + i * sectors;
      const std::uint32_t lower = upper + sectors;
      mesh.triangles.push_back({upper + j, lower + j, lower + k});
      mesh.triangles.push_back({upper + j, lower + k, upper + k});
    }
    const std::uint32_t ring = last - sectors;
    mesh.triangles.push_back({last, ring + k, ring + j});
  }
  return mesh;
}

/// A rectangle in the plane x = 0: a sheet without thickness.
inline TriangleMesh sheet_mesh(double half_y, double half_z) {
  TriangleMesh mesh;
  for (const double y : {-half_y, half_y}) {
    for (const double z : {-half_z, half_z}) {
      mesh.vertices.push_back(Eigen::Vector3d(0, y, z).cast<float>());
    }
  }
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}};
  return mesh;
}

/// `mesh` seen in a mirror at the plane y = 0, triangles turned so that they face outward again.
inline TriangleMesh mirrored(TriangleMesh mesh) {
  for (Eigen::Vector3f& v : mesh.vertices) v.y() = -v.y();
  for (std::array<std::uint32_t, 3>& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

inline AabbTree tree_of(const TriangleMesh& mesh, const BuildOptions& options = {}) {
  return *build_tree(mesh, options);
}

}  // namespace crashrank::test

#pragma once

#include "crashrank/mesh/triangle_mesh.hpp"

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace crashrank {

namespace detail {

/// Eigenvectors of a symmetric 3x3 matrix by cyclic Jacobi rotations, as columns; `matrix` ends
/// diagonal. Written out in scalars with nothing but + − · / and square roots: the same bits on
/// every machine, which a library that vectorises by the caller's flags does not promise.
inline Eigen::Matrix3d jacobi_eigenvectors(Eigen::Matrix3d& matrix) {
  constexpr int max_sweeps = 64;  // quadratic convergence: about six are needed
  constexpr std::array<std::pair<int, int>, 3> planes{{{0, 1}, {0, 2}, {1, 2}}};
  Eigen::Matrix3d vectors = Eigen::Matrix3d::Identity();
  for (int sweep = 0; sweep < max_sweeps; ++sweep) {
    bool rotated = false;
    for (const auto& [p, q] : planes) {
      const double off = matrix(p, q);
      const double scale = std::abs(matrix(p, p)) + std::abs(matrix(q, q));
      // Once adding it to the diagonal changes nothing, it is zero.
      if (scale + std::abs(off) == scale) {
        matrix(p, q) = 0.0;
        matrix(q, p) = 0.0;
        continue;
      }
      rotated = true;
      const double theta = (matrix(q, q) - matrix(p, p)) / (2.0 * off);
      const double sign = theta < 0.0 ? -1.0 : 1.0;
      const double t = sign / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
      const double c = 1.0 / std::sqrt(t * t + 1.0);
      const double s = t * c;
      for (int k = 0; k < 3; ++k) {
        const double kp = matrix(k, p);
        const double kq = matrix(k, q);
        matrix(k, p) = c * kp - s * kq;
        matrix(k, q) = s * kp + c * kq;
      }
      for (int k = 0; k < 3; ++k) {
        const double pk = matrix(p, k);
        const double qk = matrix(q, k);
        matrix(p, k) = c * pk - s * qk;
        matrix(q, k) = s * pk + c * qk;
        const double vp = vectors(k, p);
        const double vq = vectors(k, q);
        vectors(k, p) = c * vp - s * vq;
        vectors(k, q) = s * vp + c * vq;
      }
    }
    if (!rotated) break;
  }
  return vectors;
}

}  // namespace detail

/// The frame of the normal distribution fitted to a mesh ("Fitting points with Gaussian
/// distribution", Wiseman & Grinberg 2016, section 2): eigenvectors of the covariance as columns,
/// largest eigenvalue first, each with its largest component positive. That fixes the signs, so
/// the three may be a left-handed set: boxes do not care, and nothing else reads them as a
/// rotation.
///
/// The points fitted are the corners of all triangles, each triangle giving three: what a vertex
/// list holds twice along a seam, or holds without using, then changes nothing, and regions weigh
/// as many triangles as they have, as they do in the tree's cost. O(n); indices and vertices have
/// to be valid.
inline Eigen::Matrix3d gaussian_axes(const TriangleMesh& mesh) {
  const auto for_each_corner = [&mesh](const auto& visit) {
    for (const std::array<std::uint32_t, 3>& triangle : mesh.triangles) {
      for (const std::uint32_t v : triangle) {
        const Eigen::Vector3f& x = mesh.vertices[v];
        visit(static_cast<double>(x.x()), static_cast<double>(x.y()), static_cast<double>(x.z()));
      }
    }
  };
  const double count = 3.0 * static_cast<double>(mesh.triangles.size());
  double mx = 0.0;
  double my = 0.0;
  double mz = 0.0;
  for_each_corner([&](double x, double y, double z) {
    mx += x;
    my += y;
    mz += z;
  });
  mx /= count;
  my /= count;
  mz /= count;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for_each_corner([&](double x, double y, double z) {
    const double dx = x - mx;
    const double dy = y - my;
    const double dz = z - mz;
    covariance(0, 0) += dx * dx;
    covariance(1, 1) += dy * dy;
    covariance(2, 2) += dz * dz;
    covariance(0, 1) += dx * dy;
    covariance(0, 2) += dx * dz;
    covariance(1, 2) += dy * dz;
  });
  covariance(1, 0) = covariance(0, 1);
  covariance(2, 0) = covariance(0, 2);
  covariance(2, 1) = covariance(1, 2);
  const Eigen::Matrix3d vectors = detail::jacobi_eigenvectors(covariance);

  std::array<int, 3> by_value{0, 1, 2};  // descending, equal ones in the order they came
  const auto swap_if_less = [&](std::size_t i, std::size_t j) {
    if (covariance(by_value[i], by_value[i]) < covariance(by_value[j], by_value[j])) {
      std::swap(by_value[i], by_value[j]);
    }
  };
  swap_if_less(0, 1);
  swap_if_less(1, 2);
  swap_if_less(0, 1);

  Eigen::Matrix3d axes;
  for (int i = 0; i < 3; ++i) {
    const int from = by_value[static_cast<std::size_t>(i)];
    int largest = 0;
    for (int k = 1; k < 3; ++k) {
      if (std::abs(vectors(k, from)) > std::abs(vectors(largest, from))) largest = k;
    }
    const double sign = vectors(largest, from) < 0.0 ? -1.0 : 1.0;
    for (int k = 0; k < 3; ++k) axes(k, i) = sign * vectors(k, from);
  }
  return axes;
}

}  // namespace crashrank

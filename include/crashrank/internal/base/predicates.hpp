#pragma once

#include "crashrank/base/version.hpp"
#include "crashrank/internal/base/exact_integer.hpp"

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace crashrank {

/// Sign of det[b−a, c−a, d−a]: +1 when d lies on the side of the plane abc to which (b−a)×(c−a)
/// points, 0 when the four points are coplanar. Exact for all finite doubles. `exact_calls` counts
/// the calls that needed integers.
int orient3d(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
             const Eigen::Vector3d& d, std::uint64_t& exact_calls);

/// Sign of det[b−a, c−a] after dropping coordinate `dropped` (0, 1, 2; the remaining two in cyclic
/// order): +1 when c lies left of the line ab. Exact for all finite doubles.
int orient2d(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
             int dropped, std::uint64_t& exact_calls);

namespace detail {

inline int orient3d_exact(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                          const Eigen::Vector3d& c, const Eigen::Vector3d& d) {
  const auto p = common_integers<12>({a.x(), a.y(), a.z(), b.x(), b.y(), b.z(),  //
                                      c.x(), c.y(), c.z(), d.x(), d.y(), d.z()});
  // Differences fit a coordinate's limbs (one carry bit is counted there); a 2x2 minor is two
  // products of 66 limbs and a carry, the determinant three products of 33 + 67 limbs and a carry.
  std::array<std::array<ExactCoordinate, 3>, 3> m;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      m[row][axis] = add<coordinate_limbs>(p[3 * (row + 1) + axis], p[axis], true);
    }
  }
  constexpr std::size_t minor_limbs = 2 * coordinate_limbs + 1;
  const auto minor = [&](std::size_t i, std::size_t j) {
    return add<minor_limbs>(multiply(m[1][i], m[2][j]), multiply(m[1][j], m[2][i]), true);
  };
  constexpr std::size_t det_limbs = coordinate_limbs + minor_limbs + 1;
  const auto first = multiply(m[0][0], minor(1, 2));
  const auto second = multiply(m[0][1], minor(2, 0));
  const auto third = multiply(m[0][2], minor(0, 1));
  return add<det_limbs>(add<det_limbs>(first, second), third).sign;
}

inline int orient2d_exact(double ax, double ay, double bx, double by, double cx, double cy) {
  const auto p = common_integers<6>({ax, ay, bx, by, cx, cy});
  const ExactCoordinate bax = add<coordinate_limbs>(p[2], p[0], true);
  const ExactCoordinate bay = add<coordinate_limbs>(p[3], p[1], true);
  const ExactCoordinate cax = add<coordinate_limbs>(p[4], p[0], true);
  const ExactCoordinate cay = add<coordinate_limbs>(p[5], p[1], true);
  constexpr std::size_t limbs = 2 * coordinate_limbs + 1;
  return add<limbs>(multiply(bax, cay), multiply(bay, cax), true).sign;
}

// Twice the bound that follows below, in units of the last place of 1, and a floor for products
// that underflow.
inline constexpr double predicate_error = 16.0 * 0x1p-53;
inline constexpr double underflow_floor = 0x1p-1020;

}  // namespace detail

// Bound of the filter. With u = 2^-53 every operation returns the true result times (1 + δ),
// |δ| ≤ u, apart from products that underflow. A monomial of the determinant, x·(y·z), passes
// through three differences, two products, the minor's subtraction and two final sums: at most
// eight factors (1 + δ). Hence |computed − true| ≤ ((1+u)^8 − 1)·P with P the sum of the absolute
// monomials, and the computed P is at least (1−u)^8 of the true one: |error| ≤ 8.1·u·P_computed.
// A product that underflows is off by at most 2^-1075 more; inner ones are then multiplied by
// |x|. Six of them, with room: (|x0| + |x1| + |x2| + 1) · 2^-1020. Overflow gives infinities or
// NaN, for which both comparisons below are false.
// Inlined always: how much else a translation unit holds should not decide what a triangle test
// takes.
/// Sign of (b − a)·((c − a) × (d − a)), exact: 1, 0 or -1. Counts what the filter left open.
[[gnu::always_inline]] inline int orient3d(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                           const Eigen::Vector3d& c, const Eigen::Vector3d& d,
                                           std::uint64_t& exact_calls) {
  const double bx = b.x() - a.x();
  const double by = b.y() - a.y();
  const double bz = b.z() - a.z();
  const double cx = c.x() - a.x();
  const double cy = c.y() - a.y();
  const double cz = c.z() - a.z();
  const double dx = d.x() - a.x();
  const double dy = d.y() - a.y();
  const double dz = d.z() - a.z();
  const double cydz = cy * dz;
  const double czdy = cz * dy;
  const double czdx = cz * dx;
  const double cxdz = cx * dz;
  const double cxdy = cx * dy;
  const double cydx = cy * dx;
  const double determinant = bx * (cydz - czdy) + by * (czdx - cxdz) + bz * (cxdy - cydx);
  const double abs_bx = std::abs(bx);
  const double abs_by = std::abs(by);
  const double abs_bz = std::abs(bz);
  const double permanent = abs_bx * (std::abs(cydz) + std::abs(czdy)) +
                           abs_by * (std::abs(czdx) + std::abs(cxdz)) +
                           abs_bz * (std::abs(cxdy) + std::abs(cydx));
  const double bound = detail::predicate_error * permanent +
                       detail::underflow_floor * (abs_bx + abs_by + abs_bz + 1.0);
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
  // Equal coordinates make an exact 0 without integers: bodies on level ground share heights.
  if ((bx == 0.0 && cx == 0.0 && dx == 0.0) || (by == 0.0 && cy == 0.0 && dy == 0.0) ||
      (bz == 0.0 && cz == 0.0 && dz == 0.0)) {
    return 0;
  }
  ++exact_calls;
  return detail::orient3d_exact(a, b, c, d);
}

// As above with two differences, one product and one sum on every monomial: 4.1·u·P.
/// Sign of the turn a, b, c seen along an axis, exact: 1, 0 or -1. Counts as `orient3d`.
inline int orient2d(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                    int dropped, std::uint64_t& exact_calls) {
  const int i = (dropped + 1) % 3;
  const int j = (dropped + 2) % 3;
  const double bi = b[i] - a[i];
  const double bj = b[j] - a[j];
  const double ci = c[i] - a[i];
  const double cj = c[j] - a[j];
  const double left = bi * cj;
  const double right = bj * ci;
  const double determinant = left - right;
  const double bound =
      detail::predicate_error * (std::abs(left) + std::abs(right)) + detail::underflow_floor;
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
  // Equal coordinates make an exact 0 without integers: edges of boxes share lines.
  if ((bi == 0.0 || cj == 0.0) && (bj == 0.0 || ci == 0.0)) return 0;
  ++exact_calls;
  return detail::orient2d_exact(a[i], a[j], b[i], b[j], c[i], c[j]);
}

}  // namespace crashrank

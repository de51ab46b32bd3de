#pragma once

#include "crashrank/base/version.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <array>
#include <cmath>

namespace crashrank {

namespace detail {

/// Whether a0·b1 − a1·b0 + b0·c1 − b1·c0 + c0·a1 − c1·a0 is exactly zero: three points of the
/// plane on one line.
///
/// A product of two float32 has at most 48 significant bits and an exponent between −298 and 256,
/// so each of the six products is exact in double. Their sum is not. It is built as an expansion:
/// two_sum replaces (e, t) by their rounded sum and the exact rounding error, which is again a
/// double (Knuth, The Art of Computer Programming 4.2.2; additions never lose anything to
/// underflow, and nothing here comes near overflow). So after every term the components add up to
/// the exact sum so far, and they do not overlap (Shewchuk 1997, Grow-Expansion), which makes the
/// whole zero only when each of them is.
inline bool exactly_collinear(float a0, float a1, float b0, float b1, float c0, float c1) {
  const auto product = [](float x, float y) {
    return static_cast<double>(x) * static_cast<double>(y);
  };
  const std::array<double, 6> term{product(a0, b1),  -product(a1, b0), product(b0, c1),
                                   -product(b1, c0), product(c0, a1),  -product(c1, a0)};
  double sum = 0.0;
  double magnitude = 0.0;
  for (const double t : term) {
    sum += t;
    magnitude += std::abs(t);
  }
  // Five roundings of partial sums, none larger than magnitude: the error is below 6·2^-53 of it.
  if (std::abs(sum) > 1e-15 * magnitude) return false;

  std::array<double, 6> expansion{};
  for (std::size_t n = 0; n < term.size(); ++n) {
    double carry = term[n];
    for (std::size_t i = 0; i < n; ++i) {
      const double total = carry + expansion[i];
      const double part = total - carry;
      expansion[i] = (carry - (total - part)) + (expansion[i] - part);
      carry = total;
    }
    expansion[n] = carry;
  }
  for (const double component : expansion) {
    if (component != 0.0) return false;
  }
  return true;
}

}  // namespace detail

/// Whether a triangle's corners are exactly on one line, or coincide: no area and no plane. The
/// cross product of two of its sides has the three planar sums below as components, so the answer
/// is exact. Corners have to be finite.
inline bool degenerate(const Triangle& triangle) {
  const Eigen::Vector3f& a = triangle.corner[0];
  const Eigen::Vector3f& b = triangle.corner[1];
  const Eigen::Vector3f& c = triangle.corner[2];
  return detail::exactly_collinear(a.x(), a.y(), b.x(), b.y(), c.x(), c.y()) &&
         detail::exactly_collinear(a.y(), a.z(), b.y(), b.z(), c.y(), c.z()) &&
         detail::exactly_collinear(a.z(), a.x(), b.z(), b.x(), c.z(), c.x());
}

}  // namespace crashrank

#pragma once

#include <Eigen/Core>

#include <cmath>
#include <limits>

namespace crashrank::detail {

/// Largest float at or below a double; −infinity below the range.
inline float float_below(double value) {
  constexpr double largest = std::numeric_limits<float>::max();
  if (value > largest) return std::numeric_limits<float>::max();
  if (value < -largest) return -std::numeric_limits<float>::infinity();
  const float f = static_cast<float>(value);
  return static_cast<double>(f) <= value
             ? f
             : std::nextafter(f, -std::numeric_limits<float>::infinity());
}

/// Smallest float at or above a double.
inline float float_above(double value) { return -float_below(-value); }

/// A projection known to lie between two floats.
struct FloatInterval {
  float low;
  float high;
};

/// Encloses the exact real value of axis·x, axis in double (|components| ≤ 2), x in float32.
///
/// Proof. Let u = 2^-53, and s = |a₀x|+|a₁y|+|a₂z| in exact arithmetic. With every operation
/// rounded on its own, the computed sum p̂ of three products meets at most three roundings per term,
/// so |p̂ − a·x| ≤ ((1+u)³ − 1)·s ≤ 3.01u·s, underflow aside: x is a float, at least 2^-149 unless
/// zero, so a product underflows only where |a| < 2^-873, and then loses less than 2^-1074 a term.
/// The computed ŝ is at least (1−u)³·s less as much. e = 8u·ŝ + 2^-1000 therefore exceeds 7.9u·s +
/// 2^-1001 and leaves 4.8u·s for the one rounding of p̂ ∓ e, which is at most u·(|p̂| + e) ≤ 1.1u·s +
/// 2^-1050. What remains is rounded outward to float exactly. 8u·s is 2^-50 of the size of the
/// coordinates: the box grows by at most one float step.
inline FloatInterval project(const Eigen::Matrix3d& axes, int axis, const Eigen::Vector3f& point) {
  constexpr double unit = 0x1p-53;
  const double px = axes(0, axis) * static_cast<double>(point.x());
  const double py = axes(1, axis) * static_cast<double>(point.y());
  const double pz = axes(2, axis) * static_cast<double>(point.z());
  const double sum = (px + py) + pz;
  const double slack = 8.0 * unit * ((std::abs(px) + std::abs(py)) + std::abs(pz)) + 0x1p-1000;
  return {float_below(sum - slack), float_above(sum + slack)};
}

}  // namespace crashrank::detail

#pragma once

#include <algorithm>

namespace crashrank::detail {

/// No contact gives back more than this share of the impulse before its rebound.
inline constexpr double most_restitution = 0.5;

/// Factor on the impulses and delta-v of a simulated contact of that restitution in [0, 0.5] when
/// the restitution is multiplied by `factor` >= 0. The rebound repeats the share e of the impulse
/// until then, so the whole is 1 + e times the compression's. Exactly 1 for a factor of 1.
inline double rebound_gain(double restitution, double factor) {
  return (1.0 + std::min(most_restitution, factor * restitution)) / (1.0 + restitution);
}

/// The same factor on the dissipated energy: of what compression takes, e² comes back.
inline double rebound_loss(double restitution, double factor) {
  const double e = std::min(most_restitution, factor * restitution);
  return (1.0 - e * e) / (1.0 - restitution * restitution);
}

}  // namespace crashrank::detail

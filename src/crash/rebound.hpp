#pragma once

#include <algorithm>

namespace crashrank::detail {

/// Maximum restitution: share of the impulse before the rebound that the rebound adds.
inline constexpr double most_restitution = 0.5;

/// Factor on the impulses and delta-v of a simulated contact with the given restitution in [0, 0.5]
/// when that restitution is multiplied by `factor` >= 0. The rebound adds the share e of the
/// compression impulse, so the total is 1 + e times that impulse. Exactly 1 for a factor of 1.
inline double rebound_gain(double restitution, double factor) {
  return (1.0 + std::min(most_restitution, factor * restitution)) / (1.0 + restitution);
}

/// The corresponding factor on the dissipated energy: the rebound restores e² of what the
/// compression dissipates.
inline double rebound_loss(double restitution, double factor) {
  const double e = std::min(most_restitution, factor * restitution);
  return (1.0 - e * e) / (1.0 - restitution * restitution);
}

}  // namespace crashrank::detail

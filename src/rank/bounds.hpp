#pragma once

#include "rank/measure_table.hpp"
#include "rank/scene.hpp"

#include <cstddef>
#include <vector>

namespace crashrank::detail {

/// What scores of a scene cannot exceed, prepared once for all its candidates. Rests on what the
/// simulation promises: energy is never gained, momentum conserved.
class ScoreBounds {
public:
  /// Makes displaced for a scene's actors and reads what does not change with their motions.
  void prepare(const Scene& scene);
  /// Reads the actors' motions. Allocates nothing.
  void update(const Scene& scene);

  /// No crash of a candidate that moves so can score more, whatever it meets.
  double upper_bound(const Scene& scene, const Motion& ego) const;
  /// The same in all futures, whatever the ego is displaced by. `displaced` is for a motion;
  /// allocates only for timed motions.
  double upper_bound_displaced(const Scene& scene, const Motion& ego, Motion& displaced) const;

private:
  void add(const Scene& scene, std::size_t index);

  CrashLimits limits_;             ///< but for energies, which change with motions
  double max_energy_ratio_ = 1.0;  ///< of a body's energy about any of its points to that it has
  double energy_sum_j_ = 0.0;      ///< of all actors' motions
  std::vector<double> actor_energy_j_;  ///< by actor, the most on any of its plans
};

}  // namespace crashrank::detail

#pragma once

#include "rank/scene.hpp"

#include <cstddef>
#include <vector>

namespace crashrank::detail {

/// What scores of a scene cannot exceed, prepared once for all its candidates. Rests on what the
/// simulation promises: energy is never gained, momentum conserved.
class ScoreBounds {
public:
  /// Makes room for a scene's actors and reads what does not change with their motions.
  void prepare(const Scene& scene);
  /// Reads the actors' motions. Allocates nothing.
  void update(const Scene& scene);

  /// No crash of a candidate that moves so can score more, whatever it meets.
  double most(const Scene& scene, const Motion& ego) const;

private:
  double people_ = 0.0;        ///< all, as weighted
  double triangles_ = 0.0;     ///< of the ego and all actors
  double area_m2_ = 0.0;       ///< of both; that measure only
  double intrusion_m_ = 0.0;   ///< of the body with the deepest compartment
  double energy_sum_j_ = 0.0;  ///< of all actors' motions
};

}  // namespace crashrank::detail

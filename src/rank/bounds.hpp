#pragma once

#include "rank/measure_table.hpp"
#include "rank/scene.hpp"

#include <cstddef>
#include <vector>

namespace crashrank::detail {

/// Upper bounds on the scores of all candidates of a scene, prepared once. They follow from two
/// properties of the simulation: it conserves momentum and never gains energy.
class ScoreBounds {
public:
  /// Allocates for the scene and computes everything that does not depend on the motions of the
  /// actors.
  void prepare(const Scene& scene);
  /// Does what follows from the bodies after some have entered or left. O(their triangles) for the
  /// measure `area`, O(bodies) for the others. Does not allocate.
  void limit(const Scene& scene);
  /// Updates the kinetic energies after the motions of the actors changed. Does not allocate.
  void update(const Scene& scene);

  /// Upper bound on the score of any crash of a candidate with this motion.
  double upper_bound(const Scene& scene, const Motion& ego) const;
  /// Upper bound over all futures, with every error of the state of the ego that was drawn.
  /// `displaced` is working memory for a motion; allocates only if the motion is timed poses.
  double upper_bound_displaced(const Scene& scene, const Motion& ego, Motion& displaced) const;

private:
  void add(const Scene& scene, std::size_t index);

  /// maxima that do not depend on motions; the energies are added for each candidate
  CrashLimits limits_;
  /// largest ratio of the kinetic energy of a body about one of its points to that about its centre
  /// of mass
  double max_energy_ratio_ = 1.0;
  double energy_sum_j_ = 0.0;           ///< sum over all actors, J
  std::vector<double> actor_energy_j_;  ///< by actor: maximum over its plans, J
};

}  // namespace crashrank::detail

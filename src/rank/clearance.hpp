#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/motion/motion.hpp"
#include "rank/outline_distance.hpp"
#include "rank/stop_check.hpp"
#include "rank/time_to_collision.hpp"

#include <cstddef>
#include <limits>
#include <vector>

namespace crashrank::detail {

struct Scene;

/// Smallest distance, time gap and time to collision between the ego and the actors, for a
/// candidate without contact.
struct Clearance {
  /// Between the outlines, m; infinity if no actor comes nearer than `farthest_clearance_m`.
  double distance_m = std::numeric_limits<double>::infinity();
  std::size_t nearest = 0;  ///< index of that actor; valid only if the value above is finite
  /// Post-encroachment time, see CandidateResult::least_time_gap_s, s. Infinity if no two
  /// trajectories cross.
  double time_gap_s = std::numeric_limits<double>::infinity();
  std::size_t soonest = 0;  ///< index of that actor; valid only if the value above is finite
  /// See CandidateResult::time_to_collision_s, s. Infinity if it is longer than
  /// `longest_time_to_collision_s`.
  double time_to_collision_s = std::numeric_limits<double>::infinity();
  std::size_t imminent = 0;  ///< index of that actor; valid only if the value above is finite
};

/// Trajectories of the plans of the scenario in plan view, sampled at equal time steps from 0 to
/// the horizon.
struct PlanTrajectories {
  double step_s = 0.0;
  std::size_t steps = 0;          ///< number of steps; each plan has one more pose
  std::vector<PlanarPose> poses;  ///< ordered by plan, then by time
  /// by plan: upper bound on the speed of any point of the body
  std::vector<double> fastest_mps;
  std::vector<Drift> drift;  ///< by plan: how the body goes on after the horizon
  View<const PlanarPose> of(std::size_t plan) const {
    return {poses.data() + plan * (steps + 1), steps + 1};
  }
};

/// Samples the trajectories of all plans of a scene. Allocates only when the memory has to grow.
void sample_trajectories(const Scene& scene, PlanTrajectories& trajectories);

/// Clearance of the motion of the ego to all plans that an actor follows in some future, up to the
/// horizon. Displaced plans count as the plans that they are derived from. The result does not
/// depend on the order of the actors. `ego_poses` is working memory; nothing else allocates.
/// Accuracy: distances about 1 cm, time gaps `PlanTrajectories::step_s` / 16, times to collision
/// that of 1 cm. Takes about 0.1 ms for each actor nearby; checks `stop` every few µs.
Clearance clearance_of(const Scene& scene, const Motion& ego, std::vector<PlanarPose>& ego_poses,
                       const StopCheck& stop);

}  // namespace crashrank::detail

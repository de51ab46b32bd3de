#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/motion/motion.hpp"
#include "rank/outline_distance.hpp"
#include "rank/stop_check.hpp"

#include <cstddef>
#include <limits>
#include <vector>

namespace crashrank::detail {

struct Scene;

/// How far a candidate that touches nobody stays from all others.
struct Clearance {
  /// Of the outlines, m; infinity where nobody comes nearer than `farthest_clearance_m`.
  double distance_m = std::numeric_limits<double>::infinity();
  std::size_t nearest = 0;  ///< the actor whose that is, where it is finite
  /// Least time between the ego and another at one place: see CandidateResult::least_time_gap_s.
  /// Infinity where no two trajectories cross.
  double time_gap_s = std::numeric_limits<double>::infinity();
  std::size_t soonest = 0;  ///< the actor whose that is, where it is finite
};

/// Ways of the scenario's own plans seen from above, at even times from 0 to the horizon.
struct PlanTrajectories {
  double step_s = 0.0;
  std::size_t steps = 0;            ///< one more pose each
  std::vector<PlanarPose> poses;    ///< by plan, then by time
  std::vector<double> fastest_mps;  ///< by plan: no point of the body is faster
  View<const PlanarPose> of(std::size_t plan) const {
    return {poses.data() + plan * (steps + 1), steps + 1};
  }
};

/// Reads the trajectories of a scene's plans. Allocates only to grow.
void sample_trajectories(const Scene& scene, PlanTrajectories& trajectories);

/// Of the ego's motion to all plans that are followed in a future, up to the horizon; displaced
/// plans are taken as those that they are derived from. The answer
/// does not depend on the order of the actors. `way` is room for the ego's poses; nothing else is
/// allocated. Distances to about a centimetre, time gaps to `PlanTrajectories::step_s` / 16. Some
/// 0.1 ms for each actor that comes near; asks `stop` every few µs.
Clearance clearance_of(const Scene& scene, const Motion& ego, std::vector<PlanarPose>& ego_poses,
                       const StopCheck& stop);

}  // namespace crashrank::detail

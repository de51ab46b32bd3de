#pragma once

#include "crashrank/scenario/candidate.hpp"
#include "rank/scene.hpp"

namespace crashrank::detail {

/// Motion of the ego in a future: that of the candidate or, if the state of the ego has errors,
/// `displaced`, which is set to the displaced motion. Allocates only for timed motions.
inline const Motion& ego_motion(const Scene& scene, const Candidate& candidate, std::size_t future,
                                Motion& displaced) {
  const Futures& futures = scene.futures;
  if (!futures.displaces_ego() || future == futures.likeliest()) return candidate.motion;
  displaced = candidate.motion;
  displaced.displace(futures.ego_error(future));
  return displaced;
}

}  // namespace crashrank::detail

#pragma once

#include "crashrank/scenario/candidate.hpp"
#include "rank/scene.hpp"

namespace crashrank::detail {

/// The candidate's motion as the ego follows it in a future: its own, or `room`, which gets it
/// displaced. Allocates only for timed motions.
inline const Motion& ego_motion(const Scene& scene, const Candidate& candidate, std::size_t future,
                                Motion& room) {
  const Futures& futures = scene.futures;
  if (!futures.displaces_ego() || future == futures.likeliest()) return candidate.motion;
  room = candidate.motion;
  room.displace(futures.ego_error(future));
  return room;
}

}  // namespace crashrank::detail

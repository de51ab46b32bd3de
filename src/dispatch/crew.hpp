#pragma once

#include "crashrank/dispatch/policy.hpp"

#include <algorithm>
#include <cstdint>

namespace crashrank::detail {

/// How long threads of a dispatch spin before they sleep while each has a processor to itself, s.
/// Waking one takes a few microseconds when its processor was busy a moment ago, and tens when it
/// was not.
inline constexpr double crew_spin_s = 100e-6;

/// Who works in a dispatch.
struct Crew {
  std::uint32_t workers = 0;  ///< the first so many; the others sleep on
  bool caller = false;        ///< the calling thread works off jobs, too
  bool awake = false;         ///< each thread has a processor, so that idle ones spin
};

/// Where the caller works it needs a processor like the rest: a worker more would be in its way.
inline Crew crew_for(const PlacementPolicy& policy, std::uint32_t workers, std::uint32_t processors,
                     bool caller_may_work) noexcept {
  Crew crew;
  crew.caller = caller_may_work && policy.caller_works();
  crew.workers = crew.caller ? std::min(workers, std::max(2U, processors) - 1U) : workers;
  crew.awake = crew.workers < processors;
  return crew;
}

}  // namespace crashrank::detail

#pragma once

#include "rank/crash_chain.hpp"

#include <cstddef>
#include <limits>

namespace crashrank::detail {

/// No body.
inline constexpr std::size_t no_actor = std::numeric_limits<std::size_t>::max();

/// The body of Contact::contact_without_force in a future, after its simulation has finished; or
/// `no_actor`. Contacts that the plans have after the first are looked at while the ego keeps to
/// its plan within `on_plan_m`, as after a clip of a mirror.
std::size_t actor_without_force(const Scene& scene, const Motion& ego, std::size_t future,
                                const CrashChain& chain, const Contact& first,
                                ImpactWorkspace& workspace);

}  // namespace crashrank::detail

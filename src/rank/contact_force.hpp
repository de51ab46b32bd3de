#pragma once

#include "rank/crash_chain.hpp"

namespace crashrank::detail {

/// Contact::contact_without_force of the ego's first contact, after its simulation has finished.
bool lacks_force(const Scene& scene, const CrashChain& chain, const Contact& first);

}  // namespace crashrank::detail

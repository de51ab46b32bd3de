#pragma once

#include "crashrank/crash/contact_law.hpp"
#include "rank/crash_setup.hpp"

namespace crashrank::detail {

/// Memory of simulating contacts, one for each thread.
struct CrashScratch {
  ContactWorkspace workspace;
  FixedGroup group;
  ContactMotion motion;  ///< plain variant of what `simulate_variants` simulated last
};

}  // namespace crashrank::detail

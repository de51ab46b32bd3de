#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/rank/scenario.hpp"

namespace crashrank::detail {

/// Whether a scenario, read or made by a program, holds numbers that can be computed with: the
/// ranges of `scenario_limits`, rigid poses, models that are there. The error names the key path.
Status check_scenario(const Scenario& scenario);

}  // namespace crashrank::detail

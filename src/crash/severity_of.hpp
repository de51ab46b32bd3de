#pragma once

#include "crashrank/crash/severity.hpp"

#include <Eigen/Core>

namespace crashrank::detail {

/// `crash_severity` where the pulse is known already.
Severity severity_of(const PulseBody& a, const PulseBody& b, const Eigen::Vector3d& point_m,
                     const Eigen::Vector3d& along, const PulseResult& pulse,
                     const CrushOptions& options);

}  // namespace crashrank::detail

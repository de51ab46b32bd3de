#pragma once

#include "crashrank/internal/base/export.hpp"

#include <Eigen/Core>

namespace crashrank {

/// Principal direction of force: where a horizontal impulse on a body comes from, seen from above,
/// degrees clockwise from the body's forward axis, [0, 360). 0 without a horizontal impulse.
CRASHRANK_API double pdof_deg(const Eigen::Vector3d& impulse_on_body,
                              const Eigen::Vector3d& forward);

/// Clock direction of a PDOF: 1 to 12 in steps of 30 degrees, each reaching 15 to either side, the
/// lower edge included.
CRASHRANK_API int clock_of(double pdof_deg);

}  // namespace crashrank

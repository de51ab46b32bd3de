#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/vehicle/vehicle.hpp"

#include <Eigen/Core>

namespace crashrank {

/// Greatest side of a body that is known by its box alone, m.
inline constexpr double max_box_side_m = 100.0;

/// Axles of a body that is known by its box alone, as shares of its length.
struct BoxAxles {
  double rear_overhang = 0.5;  ///< from the rear end to the origin
  double wheelbase = 0.0;      ///< 0: it has no axles
};

/// Rear overhang and wheelbase by kind. Cars, trucks and motorcycles: near those of data/models
/// (the mean of both cars). Buses: a city bus of 12 m, rear overhang 3.3 m, wheelbase 5.9 m.
/// Bicycles: 1.8 m with wheels of 0.68 m. The origin of all others is the middle of the box.
CRASHRANK_API BoxAxles box_axles(BodyKind kind) noexcept;

/// Makes the surface of a body of which only kind and box are known: `size_m` is length, width,
/// height. Its bounds are the box, which stands on z = 0, x forward; its origin lies on the ground
/// below the rear axle, see `box_axles`. Its shape is that of the shipped model of its kind
/// (data/models), drawn with 4 to 12 horizontal sections per part and stretched to the box; of a
/// bus a plain box on wheels, of a building a plain box, of a bicycle a rider on two wheels.
/// Mirrors are left out: the width of the box is that of the body.
///
/// Closed parts, cut into triangles of at most 0.15 m or a 64th of a side, at most 100,000.
/// Errors: bad_input for a side that is not above 0 and at most `max_box_side_m`; the place is
/// "box".
CRASHRANK_API Result<TriangleMesh> make_box_body(BodyKind kind, const Eigen::Vector3d& size_m);

}  // namespace crashrank

#pragma once

#include "crashrank/mesh/triangle_mesh.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <optional>
#include <string>

namespace crashrank::detail {

/// How a mesh that seems to be turned would have to be read.
struct Orientation {
  std::string lies;  ///< where its length is: "sideways (along y)", "upright (along z)"
  std::string forward;
  std::string up;
};

/// The name of one of the file's axes, "+y", as a body axis after `transform`.
inline std::string file_axis(const Eigen::Vector3d& unit) {
  int axis = 0;
  unit.cwiseAbs().maxCoeff(&axis);
  return std::string(unit[axis] < 0.0 ? "-" : "+") + "xyz"[axis];
}

/// Guesses the axes of a mesh with a vehicle's proportions whose length does not lie along x. The
/// extents are those that `transform` led to. They do not show which end is the front: the
/// opposite of `forward` may be meant.
inline std::optional<Orientation> guess_orientation(const Eigen::Vector3d& extent_m,
                                                    const ImportTransform& transform) {
  constexpr double least_ratio = 1.2;
  const Eigen::Vector3d forward = direction(transform.forward);
  const Eigen::Vector3d up = direction(transform.up);
  const Eigen::Vector3d left(up.y() * forward.z() - up.z() * forward.y(),
                             up.z() * forward.x() - up.x() * forward.z(),
                             up.x() * forward.y() - up.y() * forward.x());
  const double x = extent_m.x();
  const double y = extent_m.y();
  const double z = extent_m.z();
  if (z > least_ratio * x && z > least_ratio * y) {
    // Cars are wider than high; vans with a high roof, lorries, buses and trams, beyond the width
    // of any car, are higher than wide.
    constexpr double widest_car_m = 2.5;
    const bool x_is_height = (x < y) == (std::max(x, y) < widest_car_m);
    return Orientation{"upright (along z)", file_axis(up), file_axis(x_is_height ? forward : left)};
  }
  if (y > least_ratio * x) return Orientation{"sideways (along y)", file_axis(left), file_axis(up)};
  return std::nullopt;
}

/// Whether a car has its width where the height should be: cars that are not vans are wider than
/// high.
inline bool lies_on_its_side(const Eigen::Vector3d& extent_m) {
  constexpr double longest_m = 4.8;
  return extent_m.x() < longest_m && extent_m.z() > 1.1 * extent_m.y();
}

/// Whether some vehicle is of that size, whichever way it is turned; the longest are trams.
inline bool has_vehicle_size(const Eigen::Vector3d& extent_m) {
  const double length = extent_m.maxCoeff();
  const double least = extent_m.minCoeff();
  const double between = extent_m.sum() - length - least;
  return length >= 1.5 && length <= 60.0 && least >= 0.5 && between >= 1.0 && between <= 4.5;
}

}  // namespace crashrank::detail

#pragma once

#include "crashrank/internal/base/export.hpp"

#include <Eigen/Core>

namespace crashrank {

/// What a body is. Decides its mass where none is given.
enum class BodyKind {
  car,
  truck,
  bus,
  motorcycle,
  bicycle,
  pedestrian,
  barrier,
  pole,
  building,
};

/// "car", "truck", ... as in scenario files.
CRASHRANK_API const char* body_kind_name(BodyKind kind) noexcept;

/// Mass of a body from its kind and size, kg: a car −1333.5 + 526.9·(length·width)^0.8 and at least
/// 300, a truck 25000, a bus 13000, a motorcycle 250, a bicycle 90, a pedestrian 75, rider included
/// (TUM's planner for harm-aware trajectories). Barriers, poles and buildings do not move:
/// infinity. `extent_m` is length, width, height.
CRASHRANK_API double guess_mass_kg(BodyKind kind, const Eigen::Vector3d& extent_m);

}  // namespace crashrank

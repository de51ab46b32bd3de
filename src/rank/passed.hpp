#pragma once

#include "rank/scene.hpp"
#include "rank/triangle_set.hpp"

#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// Memory that following paths reuses.
struct PassedScratch {
  enum class Path : std::uint8_t { unknown, clear, crossing };
  std::vector<Path> path;  ///< by vertex
  std::vector<std::uint32_t> moving_stack;
  std::vector<std::uint32_t> fixed_stack;
};

/// Adds the triangles of `moving` that the surface of `fixed` has passed through: those of which a
/// corner's path, the chord from `first` to `last` (poses of moving in fixed's frame), crosses a
/// triangle of fixed. Needs no closed surfaces. Returns the number of paths followed.
std::uint64_t add_passed(const Body& moving, const Pose& first, const Pose& last, const Body& fixed,
                         TriangleSet& set, PassedScratch& scratch);

}  // namespace crashrank::detail

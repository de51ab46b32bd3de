#pragma once

#include "rank/scene.hpp"
#include "rank/triangle_set.hpp"

#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// Memory that following paths reuses.
struct SweptScratch {
  enum class Path : std::uint8_t { unknown, clear, crossing };
  /// A node of the moving body's tree, and what its parent comes near, as a range of `near`.
  struct Visit {
    std::uint32_t node = 0;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    bool is_done = false;  ///< all below it has been visited
  };
  std::vector<Path> path;  ///< by vertex
  std::vector<Visit> visits;
  std::vector<std::uint32_t> near;  ///< nodes of the fixed body's tree
};

/// Adds the triangles of `moving` that the surface of `fixed` has passed through: those of which a
/// corner's path, the chord from `first` to `last` (poses of moving in fixed's frame), crosses a
/// triangle of fixed. Needs no closed surfaces. Returns the number of paths followed.
std::uint64_t add_swept_triangles(const Body& moving, const Pose& first, const Pose& last,
                                  const Body& fixed, TriangleSet& set, SweptScratch& scratch);

}  // namespace crashrank::detail

#pragma once

#include "rank/scene.hpp"
#include "rank/triangle_set.hpp"

#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// Working memory of `add_swept_triangles`.
struct SweptScratch {
  enum class Path : std::uint8_t { unknown, clear, crossing };
  /// A node of the tree of the moving body, and the nodes of the other tree that its parent
  /// overlaps, as a range of `near`.
  struct Visit {
    std::uint32_t node = 0;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    bool is_done = false;  ///< all nodes below it have been visited
  };
  std::vector<Path> path;  ///< by vertex
  std::vector<Visit> visits;
  std::vector<std::uint32_t> near;  ///< nodes of the tree of the fixed body
};

/// Adds the triangles of `moving` that passed through the surface of `fixed` to `set`: those with a
/// corner whose straight path from pose `first` to pose `last` crosses a triangle of `fixed`. The
/// poses are those of `moving` in the frame of `fixed`. Surfaces need not be closed. Returns the
/// number of paths that were tested.
std::uint64_t add_swept_triangles(const Body& moving, const Pose& first, const Pose& last,
                                  const Body& fixed, TriangleSet& set, SweptScratch& scratch);

}  // namespace crashrank::detail

#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/collide/pair.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/model/model.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank {

/// How two bodies stand to each other.
enum class BodyState {
  separate,      ///< surfaces share no point, and neither lies inside the other
  intersecting,  ///< surfaces share a point
  a_inside_b,    ///< surfaces share no point; all of A lies inside B, or else a part of it
  b_inside_a,    ///< surfaces share no point; all of B lies inside A, or else a part of it
  unknown_open,  ///< surfaces share no point; a part lies within the bounds of one that is not
                 ///< closed
};

/// "separate", "intersecting", "a_inside_b", "b_inside_a" or "unknown_open".
CRASHRANK_API const char* body_state_name(BodyState state);

/// Connected surfaces of a mesh and whether they are closed: what has an inside.
struct Solid {
  /// A connected surface: triangles that share corners, by position.
  struct Surface {
    std::uint32_t triangle = 0;  ///< the first one
    bool oriented = false;  ///< at each edge as many triangles run one way as the other: closed
    bool closed = false;    ///< an even number of triangles at each edge
  };
  std::vector<Surface> surfaces;          ///< in the order of their first triangles
  std::vector<std::uint32_t> surface_of;  ///< of each triangle of the mesh
  bool closed = false;                    ///< all surfaces are
};

/// Finds the surfaces of a mesh. O(n log n). Indices have to be in range.
CRASHRANK_API Solid make_solid(const TriangleMesh& mesh);

/// The state of two bodies of which `result` is the answer of a query, with `any` or without.
/// Exact on the coordinates that the query sees: no rounding decides. A point is inside where its
/// winding number over surfaces that are turned evenly is not 0 (a surface turned inwards is a
/// cavity), or where it is enclosed an odd number of times by a closed surface that is not.
/// Where the root boxes are apart this is one comparison; otherwise O(log n) for most meshes and
/// each of their surfaces. Allocates little. Safe from any thread.
CRASHRANK_API BodyState body_state(const Model& a, const Solid& solid_a, const Model& b,
                                   const Solid& solid_b, const Pose& b_in_a,
                                   const CollideResult& result);

}  // namespace crashrank

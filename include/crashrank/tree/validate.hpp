#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/internal/tree/validate_tree.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <memory>

namespace crashrank {

/// Checks every invariant of a tree over its mesh and says what is broken: sizes, axes, each
/// triangle in one slot with its own corners, nodes laid out as documented, slots handed out in
/// order without gap, each box finite and inside its parent's, each triangle inside its leaf's box.
/// Believes nothing: any content is safe to pass. O(n), memory O(n), no recursion. Errors:
/// bad_input. Throws std::bad_alloc.
inline Status validate(const AabbTree& tree, const TriangleMesh& mesh) {
  std::unique_ptr<detail::Below[]> below;
  return detail::validate_tree(tree, mesh, below);
}

}  // namespace crashrank

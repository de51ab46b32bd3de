#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/internal/tree/validate_tree.hpp"
#include "crashrank/internal/tree/validate_wide.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/tree/aabb_tree.hpp"
#include "crashrank/tree/model.hpp"

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

/// Checks both trees over a mesh: the binary one as `validate`, and everything that the vector
/// engine believes about the wide one: every node and cluster in one lane, lanes in the order of
/// the slots, clusters with the bits of their triangles, every lane's box around that of its binary
/// node and no larger than rounding makes it, unused lanes empty, the table of lanes, the depth. No
/// wide tree is sound, too. Any content is safe to pass. O(n), memory O(n), no recursion. Errors:
/// bad_input. Throws std::bad_alloc.
inline Status validate(const Model& model) {
  std::unique_ptr<detail::Below[]> below;
  if (Status status = detail::validate_tree(model.tree, model.mesh, below); !status) return status;
  return detail::validate_wide(model.wide, model.tree, below.get());
}

}  // namespace crashrank

#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/tree/aabb_tree.hpp"

namespace crashrank {

/// Builds the trees of a mesh. Errors as `build_tree`.
inline Result<Model> make_model(TriangleMesh mesh, const BuildOptions& options = {});

/// Checks both trees over a mesh: the binary one as `validate(AabbTree, TriangleMesh)`, and
/// everything that the vector engine relies on in the wide one: every node and cluster in one lane,
/// lanes in the order of the slots, clusters with the bits of their triangles, every lane's box
/// around that of its binary node and no larger than rounding makes it, unused lanes empty, the
/// table of lanes, the depth. An absent wide tree is valid. Any content is safe to pass. O(n),
/// memory O(n), no recursion. Errors: bad_input. Throws std::bad_alloc.
inline Status validate(const Model& model);

}  // namespace crashrank

#include "crashrank/internal/model/make_model-inl.hpp"

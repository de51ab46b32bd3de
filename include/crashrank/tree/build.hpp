#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/tree/aabb_tree.hpp"

namespace crashrank {

/// Builds the box tree of a mesh (Wiseman & Grinberg 2016, sections 2 and 3). The same mesh and
/// options give the same tree, bit for bit, on every machine. Cost: O(n log n) for all rules but
/// `paper`, whose work is O(n · depth) with a fixed upper limit. No recursion: depth costs heap.
/// Errors: usage for a leaf size outside 1 to 255 or a number of threads outside 1 to 256;
/// bad_input for a mesh without triangles, a vertex index out of range, a coordinate that is not
/// finite (of any vertex, used or not), or coordinates too large to be turned into the Gaussian
/// frame; limit_exceeded above `max_triangles`; out_of_memory. Safe from any thread.
inline Result<AabbTree> build_tree(const TriangleMesh& mesh, const BuildOptions& options = {});

/// Checks every invariant of a tree over its mesh and names the first one that is broken: sizes,
/// axes, each triangle in one slot with its own corners, nodes laid out as documented, slots handed
/// out in order without gap, each box finite and inside its parent's, each triangle inside its
/// leaf's box. Any content is safe to pass. O(n), memory O(n), no recursion. Errors: bad_input.
/// Throws std::bad_alloc.
inline Status validate(const AabbTree& tree, const TriangleMesh& mesh);

}  // namespace crashrank

#include "crashrank/internal/tree/build-inl.hpp"

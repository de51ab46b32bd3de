#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/collide/pair.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/internal/collide/box_test.hpp"
#include "crashrank/internal/collide/traverse.hpp"
#include "crashrank/internal/collide/triangle_test.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace crashrank {

/// Tests all triangle pairs of two leaves; calls `found(Pair)`, which returns false to stop.
/// Returns false when stopped. `Tree` is AabbTree or TreeView.
template <class Tree, class Found>
bool collide_leaves(const Tree& a, const Node& leaf_a, const Tree& b, const Node& leaf_b,
                    const Pose& b_in_a, CollideWork& work, Found&& found) {
  for (std::uint32_t j = leaf_b.first; j < leaf_b.first + leaf_b.count; ++j) {
    const TriangleD tb = carry(b_in_a, b.triangles[j]);
    for (std::uint32_t i = leaf_a.first; i < leaf_a.first + leaf_a.count; ++i) {
      ++work.primitive_tests;
      if (triangles_intersect(to_double(a.triangles[i]), tb, work.exact_tests) &&
          !found(
              Pair{static_cast<std::int32_t>(a.order[i]), static_cast<std::int32_t>(b.order[j])})) {
        return false;
      }
    }
  }
  return true;
}

/// Scratch memory of a query, reused so that later queries allocate nothing. One per
/// thread.
struct CollideWorkspace {
  std::vector<NodePair> stack;  ///< node pairs still to be tested

  /// Makes room for queries between trees of up to these depths.
  void prepare(std::uint32_t depth_a, std::uint32_t depth_b) {
    const std::size_t needed = traversal_stack_size(depth_a, depth_b);
    if (stack.size() < needed) stack.resize(needed);
  }
};

/// Pairs below one node of each tree, appended to `pairs`; work added to `work`. The workspace has
/// to be prepared. As `collide` otherwise.
inline void collide_below(const AabbTree& a, std::uint32_t a_node, const AabbTree& b,
                          std::uint32_t b_node, const Pose& b_in_a, const BoxTransform& to,
                          std::vector<Pair>& pairs, CollideWorkspace& workspace,
                          const CollideOptions& options, CollideWork& work) {
  traverse(a, b, to, {a_node, b_node}, workspace.stack, work,
           [&](const Node& leaf_a, const Node& leaf_b) {
             return collide_leaves(a, leaf_a, b, leaf_b, b_in_a, work, [&](Pair pair) {
               pairs.push_back(pair);
               return !options.any;
             });
           });
}

/// All pairs of triangles of A and B that share a point, or with `options.any` the first one found,
/// in no particular order. B's pose in A's frame is `b_in_a`; its vertices are transformed by
/// `carry`. On those coordinates the answer is exact: no pair is missed or invented. A body wholly
/// inside the other shares no point with its surface: no pair.
///
/// `pairs` is cleared and filled; it allocates only to grow beyond its capacity. The scalar engine:
/// header-only, on the calling thread. Both trees non-empty; the pose finite and rigid within
/// `max_rigidity_error`. Safe from any thread with its own workspace and buffer.
/// Source: Wiseman & Grinberg 2016, section 2 (recursive check of two trees from the roots).
inline CollideResult collide(const AabbTree& a, const AabbTree& b, const Pose& b_in_a,
                             std::vector<Pair>& pairs, CollideWorkspace& workspace,
                             const CollideOptions& options = {}) {
  workspace.prepare(a.depth, b.depth);
  pairs.clear();
  CollideResult result;
  collide_below(a, 0, b, 0, b_in_a, box_transform(a, b, b_in_a), pairs, workspace, options,
                result.work);
  result.pairs = pairs.size();
  result.intersecting = !pairs.empty();
  return result;
}

/// The same; allocates a workspace for the call.
inline CollideResult collide(const AabbTree& a, const AabbTree& b, const Pose& b_in_a,
                             std::vector<Pair>& pairs, const CollideOptions& options = {}) {
  CollideWorkspace workspace;
  return collide(a, b, b_in_a, pairs, workspace, options);
}

/// Options of a distance query.
struct DistanceOptions {
  /// Distances above this are not computed: the result is then `beyond_cutoff`. m.
  double cutoff_m = std::numeric_limits<double>::infinity();
};

/// Points in A's frame, m.
struct DistanceResult {
  /// Never above the true distance of the surfaces; 0 exactly when `collide` finds a pair. If
  /// `beyond_cutoff`, any number above the cutoff.
  double distance_m = 0.0;
  double upper_m = 0.0;          ///< distance of the two points, never below the true distance
  bool beyond_cutoff = false;    ///< nothing is nearer than the cutoff
  std::int32_t triangle_a = -1;  ///< in mesh order, -1 beyond the cutoff
  std::int32_t triangle_b = -1;  ///< its partner on B
  Eigen::Vector3d point_a_m = Eigen::Vector3d::Zero();  ///< nearest point of A, m, A's frame
  Eigen::Vector3d point_b_m = Eigen::Vector3d::Zero();  ///< nearest point of B, m, A's frame
  CollideWork work;                                     ///< tests done
};

/// Memory that distance queries reuse, one for each thread. A query needs one entry for each level
/// of either tree (`traversal_stack_size`); it allocates only to grow beyond an earlier one.
struct DistanceWorkspace {
  /// A node pair still to be visited.
  struct Entry {
    std::uint32_t a = 0;   ///< node of A
    std::uint32_t b = 0;   ///< node of B
    double lower_m = 0.0;  ///< bound on the distance below them
  };
  std::vector<Entry> stack;  ///< node pairs still to be visited
};

/// Smallest distance of the surfaces of A and of B, which stands at `b_in_a` in A's frame. A body
/// inside another is as far as its surface is. Descends into the nearer pair of boxes first and
/// leaves out boxes further apart than the best pair of points known. Both trees non-empty, the
/// pose finite and rigid within `max_rigidity_error`. Safe from any thread with its own workspace.
CRASHRANK_API DistanceResult distance(const AabbTree& a, const AabbTree& b, const Pose& b_in_a,
                                      DistanceWorkspace& workspace,
                                      const DistanceOptions& options = {});

/// How two triangles that share a point do so.
enum class PairKind {
  crossing,  ///< each goes through the other's plane, and they share a segment of some length
  touching,  ///< they only touch: in a point, or along an edge of one
  coplanar,  ///< both lie in one plane, or one is a segment or a point in the other's plane
};

/// The kind of a pair that intersects; exact, for any order of the two and of their corners.
/// Undefined for triangles that share no point. About 100 ns.
inline PairKind pair_kind(const TriangleD& a, const TriangleD& b);

/// Returns the kind of each pair that a query between these meshes at this pose found, in order.
inline std::vector<PairKind> pair_kinds(const TriangleMesh& a, const TriangleMesh& b,
                                        const Pose& b_in_a, View<const Pair> pairs);

}  // namespace crashrank

#include "crashrank/internal/collide/pair_kind-inl.hpp"

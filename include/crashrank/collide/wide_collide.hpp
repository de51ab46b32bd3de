#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/collide/collide.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/model/model.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank {

/// Lanes of a node of A's wide tree against lanes of a node of B's, still to be tested.
struct WideTask {
  std::uint32_t a_node = 0;   ///< node of A's wide tree
  std::uint32_t b_node = 0;   ///< node of B's wide tree
  std::uint32_t a_lanes = 0;  ///< bit i: child i of A's node
  std::uint32_t b_lanes = 0;  ///< bit i: child i of B's node
};

/// Scratch memory of queries between models; one per thread. It grows with the depth of the trees
/// and allocates nothing afterwards.
struct ModelWorkspace {
  CollideWorkspace scalar;     ///< the scalar engine's
  std::vector<WideTask> wide;  ///< tasks still to be done

  /// Room for all queries between these two models. A step of the vector engine takes one task off
  /// its stack and puts on at most 64: with i of 8 lanes inner nodes in A and j in B, i·j pairs of
  /// nodes, j nodes against clusters where i < 8, and i where j < 8. Waiting tasks of different
  /// steps differ in the level of one of the trees: at most 64 tasks a level.
  void prepare(const Model& a, const Model& b) {
    scalar.prepare(a.tree.depth, b.tree.depth);
    const std::size_t needed = 64 * (std::size_t{a.wide.depth} + b.wide.depth + 1);
    if (wide.size() < needed) wide.resize(needed);
  }
};

/// As the scalar `collide`, with the same pairs, on the best vector unit found at run time: eight
/// boxes or eight pairs of triangles at a time, `work` counting lanes. Falls back to the scalar
/// engine for models without a wide tree and for coordinates beyond 1e10 m. Safe from any thread
/// with its own workspace and buffer.
CRASHRANK_API CollideResult collide(const Model& a, const Model& b, const Pose& b_in_a,
                                    std::vector<Pair>& pairs, ModelWorkspace& workspace,
                                    const CollideOptions& options = {});

/// The same for what lies below one node of each binary tree.
CRASHRANK_API CollideResult collide(const Model& a, std::uint32_t a_node, const Model& b,
                                    std::uint32_t b_node, const Pose& b_in_a,
                                    std::vector<Pair>& pairs, ModelWorkspace& workspace,
                                    const CollideOptions& options = {});

/// Name of the vector unit in use, for reports: "AVX2", "SSE4".
CRASHRANK_API const char* vector_unit() noexcept;

}  // namespace crashrank

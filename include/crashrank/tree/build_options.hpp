#pragma once

#include "crashrank/tree/aabb_tree.hpp"

#include <cstdint>

namespace crashrank {

/// How a tree is built.
struct BuildOptions {
  SplitRule rule = SplitRule::min_relative_segment;  ///< where sets are split
  BoxFrame frame = BoxFrame::world;                  ///< axes of the boxes
  std::uint32_t leaf_size = 4;  ///< most triangles a leaf may hold, 1 to 255; `paper` means 1
  /// Split no set that fits into a leaf. Otherwise min_relative_segment and sah make smaller leaves
  /// where that is expected to save tests: fewer triangle pairs tested for more nodes.
  bool fill_leaves = false;
  /// After the build, whatever its rule, subtrees are moved to where the boxes above them come out
  /// smaller; at most this many passes over the tree, fewer when nothing moves any more. Worth its
  /// time (see bench/tree_bench) for a model that is built once and queried often.
  std::uint32_t reinsertion_passes = 0;
  /// Threads that min_relative_segment and sah build on, and that a model's wide tree is written
  /// on, 1 to 256, the calling one among them. The trees are the same, bit for bit.
  std::uint32_t threads = 1;
};

}  // namespace crashrank

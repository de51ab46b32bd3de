#pragma once

#include "crashrank/internal/tree/wide_tree.hpp"
#include "crashrank/mesh/profile.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <memory>

namespace crashrank {

/// A body ready for collision: its surface and the trees over it. Prepared once, read by any number
/// of threads.
struct Model {
  TriangleMesh mesh;   ///< its surface
  AabbTree tree;       ///< the binary tree over it
  WideTree wide = {};  ///< what the vector engine reads; empty where only the scalar one can serve
  /// Its outlines, which crash simulations read; null: `rank` makes them when it needs them. Model
  /// files hold them.
  std::shared_ptr<const Profile> profile = nullptr;
};

}  // namespace crashrank

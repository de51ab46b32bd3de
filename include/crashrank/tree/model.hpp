#pragma once

#include "crashrank/base/guarded.hpp"
#include "crashrank/mesh/profile.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/tree/build.hpp"
#include "crashrank/tree/wide_build.hpp"
#include "crashrank/tree/wide_tree.hpp"

#include <memory>
#include <utility>

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

/// Builds the trees of a mesh. Errors as `build_tree`.
inline Result<Model> make_model(TriangleMesh mesh, const BuildOptions& options = {}) {
  return detail::guarded([&]() -> Result<Model> {
    Result<AabbTree> tree = detail::build_tree_or_throw(mesh, options);
    if (!tree) return tree.error();
    WideTree wide = widen(*tree, options.threads);
    return Model{std::move(mesh), std::move(*tree), std::move(wide), nullptr};
  });
}

}  // namespace crashrank

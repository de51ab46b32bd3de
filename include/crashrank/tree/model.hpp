#pragma once

#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/tree/build.hpp"

#include <utility>

namespace crashrank {

/// A body ready for collision: its surface and the tree over it. Prepared once, read by any number
/// of threads.
struct Model {
  TriangleMesh mesh;
  AabbTree tree;
};

/// Builds the tree of a mesh. Errors as `build_tree`.
inline Result<Model> make_model(TriangleMesh mesh, const BuildOptions& options = {}) {
  Result<AabbTree> tree = build_tree(mesh, options);
  if (!tree) return tree.error();
  return Model{std::move(mesh), std::move(*tree)};
}

}  // namespace crashrank

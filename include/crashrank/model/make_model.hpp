#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/internal/base/guarded.hpp"
#include "crashrank/internal/tree/build_tree.hpp"
#include "crashrank/internal/tree/wide_build.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/tree/model.hpp"

#include <utility>

namespace crashrank {

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

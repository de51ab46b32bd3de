#pragma once

#include "crashrank/internal/base/guarded.hpp"
#include "crashrank/internal/tree/build_tree.hpp"
#include "crashrank/internal/tree/validate_tree.hpp"
#include "crashrank/tree/build.hpp"

#include <memory>

namespace crashrank {

inline Result<AabbTree> build_tree(const TriangleMesh& mesh, const BuildOptions& options) {
  return detail::guarded([&] { return detail::build_tree_or_throw(mesh, options); });
}

inline Status validate(const AabbTree& tree, const TriangleMesh& mesh) {
  std::unique_ptr<detail::Below[]> below;
  return detail::validate_tree(tree, mesh, below);
}

}  // namespace crashrank

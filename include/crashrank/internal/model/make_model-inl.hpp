#pragma once

#include "crashrank/internal/base/guarded.hpp"
#include "crashrank/internal/tree/build_tree.hpp"
#include "crashrank/internal/tree/validate_tree.hpp"
#include "crashrank/internal/tree/validate_wide.hpp"
#include "crashrank/internal/tree/wide_build.hpp"
#include "crashrank/model/make_model.hpp"

#include <memory>
#include <utility>

namespace crashrank {

inline Result<Model> make_model(TriangleMesh mesh, const BuildOptions& options) {
  return detail::guarded([&]() -> Result<Model> {
    Result<AabbTree> tree = detail::build_tree_or_throw(mesh, options);
    if (!tree) return tree.error();
    WideTree wide = widen(*tree, options.threads);
    return Model{std::move(mesh), std::move(*tree), std::move(wide), nullptr};
  });
}

inline Status validate(const Model& model) {
  std::unique_ptr<detail::Below[]> below;
  if (Status status = detail::validate_tree(model.tree, model.mesh, below); !status) return status;
  return detail::validate_wide(model.wide, model.tree, below.get());
}

}  // namespace crashrank

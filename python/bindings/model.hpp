#pragma once

#include "crashrank/model/model.hpp"

#include <nanobind/nanobind.h>

#include <memory>
#include <string>
#include <vector>

namespace crashrank::python {

/// A body as Python holds it: never changed after it was made, and so shared between threads,
/// scenarios and the arrays that look into it.
struct Body {
  StoredModel stored;
  std::vector<std::string> warnings;  ///< of the file that it came from

  const Model& model() const noexcept { return stored.model; }
};

using SharedBody = std::shared_ptr<const Body>;

/// A model whose copies share its memory: copying one costs no time that grows with its size.
Model shareable(Model model);

/// Path of the importer program that the package names; empty: found as `import_mesh` states.
std::string importer_path();

/// Corners of the convex hull of a mesh seen from above, x and y by turns, counter-clockwise, body
/// coordinates, m.
std::vector<double> outline_corners(const TriangleMesh& mesh);

void bind_models(nanobind::module_& module);
void bind_queries(nanobind::module_& module);
void bind_scenarios(nanobind::module_& module);
void bind_rankings(nanobind::module_& module);
void bind_rankers(nanobind::module_& module);

}  // namespace crashrank::python

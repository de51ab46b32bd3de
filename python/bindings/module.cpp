#include "error.hpp"
#include "model.hpp"

#include "crashrank/base/version.hpp"

#include <nanobind/nanobind.h>

NB_MODULE(_core, module) {
  using namespace crashrank::python;
  // At the interpreter's end something may still be referred to: no fault, and nothing prints.
  nanobind::set_leak_warnings(false);
  module.doc() = "The engine, as the package's Python code calls it. Not for other callers.";
  module.attr("version") = crashrank::library_version();
  register_errors();
  bind_models(module);
  bind_queries(module);
  bind_scenarios(module);
  bind_rankings(module);
  bind_rankers(module);
}

#include "crashrank/mesh/import.hpp"
#include "c/handles.hpp"
#include "crashrank/model/make_model.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/scenario/scenario_models.hpp"

#include <utility>

namespace {

using namespace crashrank;
using c::guarded;
using c::refuse;
using c::refuse_null;

/// The defaults, with the caller's header in place of the one that this library was built with.
ImportOptions options_with(const char* header) {
  ImportOptions options;
  options.header = header == nullptr ? "" : header;
  return options;
}

}  // namespace

crashrank_status crashrank_models_import_with_header(crashrank_models* models, const char* file,
                                                     const char* header, crashrank_error* error) {
  if (const char* null = c::first_null({{"models", models}, {"file", file}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&]() -> crashrank_status {
    if (is_model_file(file)) return crashrank_models_load(models, file, error);
    Result<ImportedMesh> imported = import_mesh(file, options_with(header));
    if (!imported) return refuse(imported.error(), error);
    Result<Model> model = make_model(std::move(imported->mesh));
    if (!model) return refuse(model.error(), error);
    models->add(std::move(*model));
    return CRASHRANK_OK;
  });
}

crashrank_status crashrank_models_import_scenario_with_header(crashrank_models* models,
                                                              const crashrank_scenario* scenario,
                                                              const char* header,
                                                              crashrank_error* error) {
  if (const char* null = c::first_null({{"models", models}, {"scenario", scenario}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&]() -> crashrank_status {
    ScenarioModelOptions options;
    options.import = options_with(header);
    std::vector<LoadedScenarioModel> made;
    for (const ScenarioModel& wanted : scenario->scenario.models) {
      Result<LoadedScenarioModel> read = load_scenario_model(wanted, options);
      if (!read) return refuse(read.error(), error);
      made.push_back(std::move(*read));
    }
    models->list.reserve(models->list.size() + made.size());
    models->stated.reserve(models->list.size() + made.size());
    for (LoadedScenarioModel& read : made) models->add(std::move(read.model), read.stated);
    return CRASHRANK_OK;
  });
}

#include "crashrank/mesh/import.hpp"
#include "c/handles.hpp"
#include "crashrank/model/make_model.hpp"
#include "crashrank/model/model_file.hpp"
#include "crashrank/scenario/scenario_models.hpp"

#include <utility>

namespace {

using namespace crashrank;
using c::guarded;
using c::refuse;
using c::refuse_null;

}  // namespace

crashrank_status crashrank_models_import(crashrank_models* models, const char* file,
                                         crashrank_error* error) {
  if (models == nullptr || file == nullptr) return refuse_null(error);
  return guarded(error, [&]() -> crashrank_status {
    if (is_model_file(file)) return crashrank_models_load(models, file, error);
    Result<ImportedMesh> imported = import_mesh(file);
    if (!imported) return refuse(imported.error(), error);
    Result<Model> model = make_model(std::move(imported->mesh));
    if (!model) return refuse(model.error(), error);
    models->add(std::move(*model));
    return CRASHRANK_OK;
  });
}

crashrank_status crashrank_models_import_scenario(crashrank_models* models,
                                                  const crashrank_scenario* scenario,
                                                  crashrank_error* error) {
  if (models == nullptr || scenario == nullptr) return refuse_null(error);
  return guarded(error, [&]() -> crashrank_status {
    std::vector<LoadedScenarioModel> made;
    for (const ScenarioModel& wanted : scenario->scenario.models) {
      Result<LoadedScenarioModel> read = load_scenario_model(wanted);
      if (!read) return refuse(read.error(), error);
      made.push_back(std::move(*read));
    }
    models->list.reserve(models->list.size() + made.size());
    models->stated.reserve(models->list.size() + made.size());
    for (LoadedScenarioModel& read : made) models->add(std::move(read.model), read.stated);
    return CRASHRANK_OK;
  });
}

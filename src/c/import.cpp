#include "crashrank/mesh/import.hpp"
#include "c/handles.hpp"
#include "crashrank/tree/model_file.hpp"

#include <iterator>
#include <utility>

namespace {

using namespace crashrank;
using c::guarded;
using c::refuse;
using c::refuse_null;

Result<Model> import_model(const std::string& path, const ImportTransform& transform) {
  if (is_model_file(path)) {
    const ImportTransform none;
    if (transform.scale != none.scale || transform.up != none.up ||
        transform.forward != none.forward || transform.origin_m != none.origin_m) {
      return Error{ErrorCode::bad_input,
                   path,
                   {},
                   "a model file has its frame already",
                   "leave out scale, up, forward and origin: they are for crashrank compile"};
    }
    Result<LoadedModel> loaded = load_model(path);
    if (!loaded) return loaded.error();
    return std::move(loaded->stored.model);
  }
  ImportOptions options;
  options.transform = transform;
  Result<ImportedMesh> imported = import_mesh(path, options);
  if (!imported) return imported.error();
  return make_model(std::move(imported->mesh));
}

}  // namespace

crashrank_status crashrank_models_import(crashrank_models* models, const char* file,
                                         crashrank_error* error) {
  if (models == nullptr || file == nullptr) return refuse_null(error);
  return guarded(error, [&]() -> crashrank_status {
    Result<Model> model = import_model(file, {});
    if (!model) return refuse(model.error(), error);
    models->list.push_back(std::move(*model));
    return CRASHRANK_OK;
  });
}

crashrank_status crashrank_models_import_scenario(crashrank_models* models,
                                                  const crashrank_scenario* scenario,
                                                  crashrank_error* error) {
  if (models == nullptr || scenario == nullptr) return refuse_null(error);
  return guarded(error, [&]() -> crashrank_status {
    std::vector<Model> made;
    for (const ScenarioModel& wanted : scenario->scenario.models) {
      if (wanted.path.empty()) {
        return refuse(CRASHRANK_USAGE, "a shape of the scenario names no mesh file", error);
      }
      Result<Model> model = import_model(wanted.path, wanted.transform);
      if (!model) return refuse(model.error(), error);
      made.push_back(std::move(*model));
    }
    models->list.insert(models->list.end(), std::make_move_iterator(made.begin()),
                        std::make_move_iterator(made.end()));
    return CRASHRANK_OK;
  });
}

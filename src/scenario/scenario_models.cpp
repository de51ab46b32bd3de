#include "crashrank/scenario/scenario_models.hpp"

#include "crashrank/internal/base/guarded.hpp"
#include "crashrank/model/make_model.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/vehicle/box_body.hpp"
#include "crashrank/vehicle/vehicle.hpp"
#include "scenario/key_ranges.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

namespace crashrank {
namespace {

bool changes_nothing(const ImportTransform& transform) {
  const ImportTransform none;
  return transform.scale == none.scale && transform.up == none.up &&
         transform.forward == none.forward && transform.origin_m == none.origin_m;
}

Error of_model(Error error, const ScenarioModel& wanted, const std::string& scenario) {
  if (error.file.empty()) error.file = wanted.path;
  error.reason += " (it is models." + wanted.name + ".mesh of " +
                  (scenario.empty() ? "the scenario" : scenario) + ")";
  return error;
}

/// What the scenario itself does not state has to be what it may state.
Status check_limits(const StatedMass& stated, const ScenarioModel& wanted) {
  constexpr detail::NumberRange masses = detail::ranges::mass;
  constexpr detail::NumberRange inertias = detail::ranges::yaw_inertia;
  if (!wanted.mass_kg && stated.mass_kg && !masses.holds(*stated.mass_kg)) {
    return make_error(ErrorCode::bad_input,
                      "its mass of " + detail::number_text(*stated.mass_kg) + " kg is not from " +
                          detail::number_text(masses.lowest) + " to " +
                          detail::number_text(masses.highest) + " kg",
                      "compile it again with --mass-kg, or give mass_kg in the scenario");
  }
  if (!wanted.yaw_inertia_kgm2 && stated.yaw_inertia_kgm2 &&
      !inertias.holds(*stated.yaw_inertia_kgm2)) {
    return make_error(ErrorCode::bad_input,
                      "its yaw inertia of " + detail::number_text(*stated.yaw_inertia_kgm2) +
                          " kg m2 is more than " + detail::number_text(inertias.highest) + " kg m2",
                      "compile it again with --yaw-inertia-kgm2, or give yaw_inertia_kgm2 in the "
                      "scenario");
  }
  return Success{};
}

/// A yaw inertia that only the model file states has to suit the mass that the body will have.
Status check_inertia(const StatedMass& stated, const ScenarioModel& wanted,
                     const TriangleMesh& mesh) {
  if (wanted.yaw_inertia_kgm2 || !stated.yaw_inertia_kgm2) return Success{};
  if (!wanted.mass_kg && stated.mass_kg) return Success{};  // was checked with the file
  const Eigen::Vector3d extent_m = mesh.bounds().extent().cast<double>();
  const double mass_kg = wanted.mass_kg.value_or(guess_mass_kg(wanted.kind, mesh));
  if (!std::isfinite(mass_kg)) return Success{};
  Status status = check_yaw_inertia(*stated.yaw_inertia_kgm2, mass_kg, extent_m);
  if (status) return status;
  status.error().reason += wanted.mass_kg ? "; the scenario gives that mass but no yaw inertia"
                                          : "; that mass is guessed from kind and size";
  status.error().remedy = "give mass_kg and yaw_inertia_kgm2 in the scenario";
  return status;
}

Status check_mass(const LoadedScenarioModel& loaded, const ScenarioModel& wanted) {
  if (Status status = check_limits(loaded.stated, wanted); !status) return status;
  return check_inertia(loaded.stated, wanted, loaded.model.mesh);
}

Result<LoadedScenarioModel> load_compiled(const ScenarioModel& wanted) {
  if (!changes_nothing(wanted.transform)) {
    return make_error(ErrorCode::bad_input, "a model file has its frame already",
                      "leave out scale, up, forward and origin: they are for crashrank compile");
  }
  Result<LoadedModel> loaded = load_model(wanted.path);
  if (!loaded) return loaded.error();
  LoadedScenarioModel read;
  read.stated = loaded->stored.stated;
  read.model = std::move(loaded->stored.model);
  if (Status status = check_mass(read, wanted); !status) return status.error();
  return read;
}

Result<LoadedScenarioModel> load_mesh(const ScenarioModel& wanted,
                                      const ScenarioModelOptions& options) {
  ImportOptions how = options.import;
  how.transform = wanted.transform;
  Result<ImportedMesh> imported = import_mesh(wanted.path, how);
  if (!imported) return imported.error();
  Result<Model> model = make_model(std::move(imported->mesh), options.build);
  if (!model) return model.error();
  LoadedScenarioModel read;
  read.model = std::move(*model);
  read.warnings = std::move(imported->warnings);
  return read;
}

Result<LoadedScenarioModel> make_box(const ScenarioModel& wanted,
                                     const ScenarioModelOptions& options) {
  if (!wanted.path.empty()) {
    return make_error(ErrorCode::bad_input, "has a box and a mesh", "keep one of them");
  }
  Result<TriangleMesh> mesh = make_box_body(wanted.kind, *wanted.box_m);
  if (!mesh) return mesh.error();
  if (Status moved = transform_mesh(*mesh, wanted.transform); !moved) return moved.error();
  Result<Model> model = make_model(std::move(*mesh), options.build);
  if (!model) return model.error();
  LoadedScenarioModel made;
  made.model = std::move(*model);
  return made;
}

}  // namespace

Result<LoadedScenarioModel> load_scenario_model(const ScenarioModel& wanted,
                                                const ScenarioModelOptions& options) {
  return detail::guarded([&]() -> Result<LoadedScenarioModel> {
    if (wanted.box_m) {
      Result<LoadedScenarioModel> made = make_box(wanted, options);
      if (!made) made.error().place = "models." + wanted.name + ".box";
      return made;
    }
    if (wanted.path.empty()) {
      return make_error(ErrorCode::usage, "model '" + wanted.name + "' names no mesh file",
                        "set its path or its box, or make its model from arrays");
    }
    Result<LoadedScenarioModel> read =
        is_model_file(wanted.path) ? load_compiled(wanted) : load_mesh(wanted, options);
    if (!read) return of_model(read.error(), wanted, options.scenario);
    return read;
  });
}

Status check_model_mass(const LoadedScenarioModel& loaded, const ScenarioModel& wanted) {
  return detail::guarded([&]() -> Status {
    Status status = check_mass(loaded, wanted);
    if (!status) return of_model(status.error(), wanted, {});
    return status;
  });
}

Result<std::vector<Model>> load_scenario_models(Scenario& scenario,
                                                const ScenarioModelOptions& options) {
  return detail::guarded([&]() -> Result<std::vector<Model>> {
    std::vector<Model> models;
    std::vector<StatedMass> stated;
    for (const ScenarioModel& wanted : scenario.models) {
      Result<LoadedScenarioModel> read = load_scenario_model(wanted, options);
      if (!read) return read.error();
      models.push_back(std::move(read->model));
      stated.push_back(read->stated);
    }
    for (std::size_t i = 0; i < stated.size(); ++i) {
      add_stated_mass(stated[i], scenario.models[i]);
    }
    return models;
  });
}

}  // namespace crashrank

#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/mesh/import.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/scenario/scenario.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <string>
#include <vector>

namespace crashrank {

/// How the models of a scenario are read.
struct ScenarioModelOptions {
  ImportOptions import;  ///< limits and importer; the transform is the scenario's, model by model
  BuildOptions build;    ///< of the trees of meshes; a model file has its own
  std::string scenario;  ///< the scenario's file, as errors name it; empty: they do not
};

/// Contents of the file of one model of a scenario.
struct LoadedScenarioModel {
  Model model;                        ///< ready for use
  StatedMass stated;                  ///< in a model file; empty for a mesh
  std::vector<std::string> warnings;  ///< of a mesh, one sentence each
};

/// Reads one model: a mesh as `import_mesh` does and builds its trees, a model file as
/// `load_model` does, or makes the body of a box. In crashrank::import. Blocks; safe from any
/// thread. Errors: those of the two, naming file and model; bad_input for a model file that the
/// scenario wants scaled, turned or moved, or whose mass or yaw inertia is outside
/// `scenario_limits` where the scenario gives none, or whose yaw inertia the mass that the scenario
/// gives cannot have; usage for a model without path and box.
CRASHRANK_API Result<LoadedScenarioModel> load_scenario_model(
    const ScenarioModel& wanted, const ScenarioModelOptions& options = {});

/// Checks that what a model file states of the mass suits the scenario, as `load_scenario_model`
/// does: for models that are kept between scenarios. Errors: its errors of mass and yaw inertia.
CRASHRANK_API Status check_model_mass(const LoadedScenarioModel& loaded,
                                      const ScenarioModel& wanted);

/// Reads all models of a scenario, in its order, as `rank` and `Ranker::prepare` take them, and
/// gives the scenario what their files state of the mass (`add_stated_mass`). From then on it is
/// the scenario's, also where another file is read later. Errors: as above, and then the scenario
/// is as it was.
CRASHRANK_API Result<std::vector<Model>> load_scenario_models(
    Scenario& scenario, const ScenarioModelOptions& options = {});

}  // namespace crashrank

#include "scenario_file.hpp"

#include "console.hpp"
#include "mesh_arguments.hpp"
#include "streams.hpp"

#include "crashrank/scenario/scenario_models.hpp"

#include <cstddef>
#include <filesystem>
#include <system_error>

namespace crashrank::cli {

std::string shown_name(const std::string& scenario) {
  return is_standard(scenario) ? "standard input" : scenario;
}

Error name_allow(Error error) {
  const std::string call = "allow its folder when calling";
  const std::size_t at = error.remedy.find(call);
  if (at != std::string::npos) {
    error.remedy.replace(at, call.size(), "allow its folder with --allow FOLDER");
  }
  return error;
}

std::size_t candidate_count(const Scenario& scenario) {
  return scenario.listed.size() +
         (scenario.grid ? scenario.grid->accelerations * scenario.grid->steerings : 0);
}

Result<std::vector<Model>> load_models(Scenario& scenario, const std::string& file,
                                       const TreeArguments& trees,
                                       std::vector<std::string>& warnings) {
  const Result<BuildOptions> build = trees.build_options();
  if (!build) return build.error();
  ScenarioModelOptions how;
  how.build = *build;
  how.scenario = file;
  std::vector<Model> models;
  Progress progress("reading meshes", scenario.models.size());
  for (ScenarioModel& wanted : scenario.models) {
    if (trees.given() && is_model_file(wanted.path)) {
      return Error{ErrorCode::bad_input, wanted.path, "models." + wanted.name,
                   "a model file has its trees already",
                   "leave out --split and --frame: they are for crashrank compile"};
    }
    Result<LoadedScenarioModel> read = load_scenario_model(wanted, how);
    if (!read) return read.error();
    for (const std::string& warning : read->warnings) {
      warn(wanted.path, warning);
      warnings.push_back(wanted.path + ": " + warning);
    }
    add_stated_mass(read->stated, wanted);
    models.push_back(std::move(read->model));
    progress.update(models.size());
  }
  return models;
}

void add_allowed_folders(CLI::App& command, std::vector<std::string>& folders) {
  const CLI::Validator folder(
      [](const std::string& text) {
        std::error_code ignored;
        return std::filesystem::is_directory(text, ignored)
                   ? std::string()
                   : "'" + text + "' is no folder: name one that is there";
      },
      "", "folder");
  command
      .add_option("--allow", folders,
                  "Another folder that meshes may be read from; may be repeated")
      ->check(folder)
      ->type_name("FOLDER")
      ->type_size(1)
      ->allow_extra_args(false);
}

}  // namespace crashrank::cli

#include "scenario.hpp"

#include "error.hpp"

#include "crashrank/scenario/candidate.hpp"
#include "crashrank/scenario/scenario_models.hpp"

#include <nanobind/stl/map.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <map>
#include <utility>

namespace crashrank::python {

namespace nb = nanobind;

void Situation::load() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (loaded_) return;
  ScenarioModelOptions how;
  how.import.importer = importer_path();
  how.scenario = file_;
  std::vector<Model> models;
  std::vector<StatedMass> stated;
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < scenario_.models.size(); ++i) {
    if (bodies_[i] != nullptr) {
      models.push_back(bodies_[i]->model());
      stated.push_back(bodies_[i]->stored.stated);
      continue;
    }
    LoadedScenarioModel read = cache_ != nullptr
                                   ? cache_->find(scenario_.models[i], how)
                                   : value_of(load_scenario_model(scenario_.models[i], how));
    for (const std::string& warning : read.warnings) {
      warnings.push_back(scenario_.models[i].path + ": " + warning);
    }
    models.push_back(std::move(read.model));
    stated.push_back(read.stated);
  }
  for (std::size_t i = 0; i < stated.size(); ++i) add_stated_mass(stated[i], scenario_.models[i]);
  models_ = std::move(models);
  warnings_ = std::move(warnings);
  loaded_ = true;
}

std::vector<std::tuple<std::string, std::string>> Situation::model_files() const {
  std::vector<std::tuple<std::string, std::string>> files;
  for (std::size_t i = 0; i < scenario_.models.size(); ++i) {
    const ScenarioModel& model = scenario_.models[i];
    if (bodies_[i] == nullptr && !model.path.empty()) files.emplace_back(model.name, model.path);
  }
  return files;
}

namespace {

using Bodies = std::map<std::string, SharedBody>;

using SharedCache = std::shared_ptr<ModelCache>;

SharedSituation with_bodies(Scenario scenario, const Bodies& bodies, const std::string& file,
                            SharedCache cache) {
  std::vector<SharedBody> by_model;
  for (const ScenarioModel& model : scenario.models) {
    const auto found = bodies.find(model.name);
    by_model.push_back(found == bodies.end() ? nullptr : found->second);
  }
  for (const auto& [name, body] : bodies) {
    bool known = false;
    for (const ScenarioModel& model : scenario.models) known = known || model.name == name;
    if (!known) {
      throw Failure({ErrorCode::usage, file, "models." + name, "is not a model of the scenario",
                     "give bodies for names that the scenario's models have"});
    }
  }
  return std::make_shared<Situation>(std::move(scenario), std::move(by_model), file,
                                     std::move(cache));
}

SharedSituation read_text(const std::string& text, const std::string& file,
                          const std::vector<std::string>& allowed, const Bodies& bodies,
                          SharedCache cache) {
  const nb::gil_scoped_release unlocked;
  Result<Scenario> scenario = load_scenario(text, file, ScenarioPaths{allowed});
  // `file` only says where meshes lie: there is none of that name.
  if (!scenario && scenario.error().file == file) scenario.error().file.clear();
  return with_bodies(value_of(std::move(scenario)), bodies, {}, std::move(cache));
}

SharedSituation read_file(const std::string& file, const std::vector<std::string>& allowed,
                          const Bodies& bodies) {
  const nb::gil_scoped_release unlocked;
  return with_bodies(value_of(load_scenario_file(file, ScenarioPaths{allowed})), bodies, file, {});
}

std::vector<std::string> actor_names(const Situation& situation) {
  std::vector<std::string> names;
  for (const ScenarioActor& actor : situation.scenario().actors) names.push_back(actor.name);
  return names;
}

std::vector<std::string> candidate_names(Situation& situation) {
  const nb::gil_scoped_release unlocked;
  situation.load();
  const Scenario& scenario = situation.scenario();
  const double ego_length_m =
      static_cast<double>(situation.models()[scenario.ego.model].mesh.bounds().extent().x());
  std::vector<std::string> names;
  for (Candidate& candidate : value_of(make_candidates(scenario, ego_length_m))) {
    names.push_back(std::move(candidate.name));
  }
  return names;
}

}  // namespace

void bind_scenarios(nb::module_& module) {
  nb::class_<ModelCache>(module, "ModelCache", "Models of files, kept between scenarios.")
      .def(nb::init<std::size_t>(), nb::arg("most_triangles"))
      .def_prop_ro("triangles", &ModelCache::triangles, "Of the models that are kept.")
      .def_prop_ro("loads", &ModelCache::loads, "How many files were read so far.");
  nb::class_<Situation>(module, "Situation", "A scenario, checked, with its models.")
      .def_prop_ro("name", [](const Situation& self) { return self.scenario().name; })
      .def_prop_ro("description", [](const Situation& self) { return self.scenario().description; })
      .def_prop_ro("horizon_s", [](const Situation& self) { return self.scenario().horizon_s; })
      .def_prop_ro("measure",
                   [](const Situation& self) { return measure_name(self.scenario().measure); })
      .def("actor_names", &actor_names, "In the scenario's order.")
      .def("model_files", &Situation::model_files, "Names and paths of models that are files.")
      .def("candidate_names", &candidate_names, "In their order; reads the models.")
      .def(
          "load",
          [](Situation& self) {
            const nb::gil_scoped_release unlocked;
            self.load();
          },
          "Reads the models that are not read yet.");
  module.def("read_scenario_text", &read_text, nb::arg("text"), nb::arg("file"), nb::arg("allowed"),
             nb::arg("bodies"), nb::arg("cache").none() = nb::none(),
             "Reads and checks a scenario in JSON.");
  module.def("read_scenario_file", &read_file, nb::arg("file"), nb::arg("allowed"),
             nb::arg("bodies"), "Reads and checks a scenario file.");
}

}  // namespace crashrank::python

#include <crashrank/crashrank.hpp>
#include <crashrank/mesh/import.hpp>

#include <cstdio>

using namespace crashrank;

static int fail(const Error& error) {
  std::fprintf(stderr, "%s\n", error.message().c_str());
  return 3;
}

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const Result<Scenario> scenario = load_scenario_file(argv[1]);
  if (!scenario) return fail(scenario.error());
  std::vector<Model> models;
  for (const ScenarioModel& wanted : scenario->models) {
    ImportOptions options;
    options.transform = wanted.transform;
    Result<ImportedMesh> imported = import_mesh(wanted.path, options);
    if (!imported) return fail(imported.error());
    Result<Model> model = make_model(std::move(imported->mesh));
    if (!model) return fail(model.error());
    models.push_back(std::move(*model));
  }
  const Result<RankResult> ranked = rank(*scenario, models);
  if (!ranked) return fail(ranked.error());
  const CandidateResult& best = ranked->ranking.front();
  std::printf("%s\n", ranked->candidates[best.candidate].name.c_str());
}

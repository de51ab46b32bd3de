#include <crashrank/crashrank.hpp>
#include <crashrank/scenario/scenario_models.hpp>

#include <cstdio>

using namespace crashrank;

static int fail(const Error& error) {
  std::fprintf(stderr, "%s\n", error.message().c_str());
  return 3;
}

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  Result<Scenario> scenario = load_scenario_file(argv[1]);
  if (!scenario) return fail(scenario.error());
  const Result<std::vector<Model>> models = load_scenario_models(*scenario);
  if (!models) return fail(models.error());
  const Result<RankResult> ranked = rank(*scenario, *models);
  if (!ranked) return fail(ranked.error());
  const CandidateResult& best = ranked->ranking.front();
  std::printf("%s\n", ranked->candidates[best.candidate].name.c_str());
}

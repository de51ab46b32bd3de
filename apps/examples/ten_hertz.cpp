#include <crashrank/crashrank.hpp>
#include <crashrank/mesh/import.hpp>

#include <cstdio>

using namespace crashrank;

static int fail(const Error& error) {
  std::fprintf(stderr, "%s\n", error.message().c_str());
  return 3;
}

static Result<std::vector<Model>> load(const Scenario& scenario) {
  std::vector<Model> models;
  for (const ScenarioModel& wanted : scenario.models) {
    ImportOptions options;
    options.transform = wanted.transform;
    Result<ImportedMesh> imported = import_mesh(wanted.path, options);
    if (!imported) return imported.error();
    Result<Model> model = make_model(std::move(imported->mesh));
    if (!model) return model.error();
    models.push_back(std::move(*model));
  }
  return models;
}

// What perception would tell: here everybody goes on as the scenario says, from `time_s` on.
static Result<std::vector<Motion>> perceive(const Scenario& scenario, double time_s) {
  std::vector<Motion> motions;
  for (ScenarioActor actor : scenario.actors) {
    const Result<Motion> motion = make_motion(actor);
    if (!motion) return motion.error();
    actor.pose = motion->pose_at(time_s);
    actor.speed_mps += actor.acceleration_mps2 * time_s;
    const Result<Motion> from_now = make_motion(actor);
    if (!from_now) return from_now.error();
    motions.push_back(*from_now);
  }
  return motions;
}

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  Result<Scenario> scenario = load_scenario_file(argv[1]);
  if (!scenario) return fail(scenario.error());
  const Result<std::vector<Model>> models = load(*scenario);
  if (!models) return fail(models.error());

  RankerOptions options;
  options.rank.workers = 2;
  Result<Ranker> ranker = Ranker::prepare(*scenario, *models, options);
  if (!ranker) return fail(ranker.error());

  const Motion planned = Motion(TurnMotion{scenario->ego.pose, scenario->ego.speed_mps});
  for (int cycle = 0; cycle < 5; ++cycle) {
    const double time_s = 0.1 * cycle;
    scenario->ego.pose = planned.pose_at(time_s);
    const Result<std::vector<Candidate>> candidates = make_candidates(*scenario, 4.5);
    const Result<std::vector<Motion>> motions = perceive(*scenario, time_s);
    if (!candidates || !motions) return 1;

    if (const Status moved = ranker->move_actors(scenario->ego.pose, *motions); !moved) return 1;
    RankBudget budget;
    budget.deadline_s = 0.05;
    const RankerAnswer answer = ranker->rank(*candidates, budget);
    const RankedCandidate& best = answer.ranking[0];
    std::printf("%.1f s: %s, harm %.3f to %.3f%s\n", time_s,
                (*candidates)[best.candidate].name.c_str(), best.interval.lowest,
                best.interval.highest, answer.proved ? "" : ", others are in the race");
  }
}

// Ten decisions a second, each within 50 ms: everything is prepared before the loop; in it the
// world moves on, the candidates are made anew, and the ranking ends at its deadline with what it
// knows.
#include <crashrank/crashrank.hpp>
#include <crashrank/scenario/scenario_models.hpp>

#include <chrono>
#include <cstdio>
#include <thread>
#include <vector>

using namespace crashrank;

static int fail(const Error& error) {
  std::fprintf(stderr, "%s\n", error.message().c_str());
  return 3;
}

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  Result<Scenario> scenario = load_scenario_file(argv[1]);
  if (!scenario) return fail(scenario.error());
  // Model files, made by `crashrank compile`, load at once: nothing is parsed, turned or built.
  const Result<std::vector<Model>> models = load_scenario_models(*scenario);
  if (!models) return fail(models.error());

  RankerOptions options;
  options.rank.workers = 2;
  Result<Ranker> ranker = Ranker::prepare(*scenario, *models, options);
  if (!ranker) return fail(ranker.error());

  // Perception's part is played by the scenario: whoever moves goes on as it says.
  const Motion ego(TurnMotion{scenario->ego.pose, scenario->ego.speed_mps});
  const double ego_length_m = (*models)[scenario->ego.model].mesh.bounds().extent().x();
  std::vector<Motion> others;
  for (const ScenarioActor& actor : scenario->actors) {
    const Result<Motion> motion = make_motion(actor);
    if (!motion) return fail(motion.error());
    others.push_back(*motion);
  }

  auto next = std::chrono::steady_clock::now();
  for (int cycle = 0; cycle < 5; ++cycle) {
    const double time_s = 0.1 * cycle;
    scenario->ego.pose = ego.pose_at(time_s);
    std::vector<Motion> motions;
    motions.reserve(others.size());
    for (const Motion& other : others) {
      motions.emplace_back(FreeMotion{other.pose_at(time_s), other.velocity_at(time_s)});
    }
    const Result<std::vector<Candidate>> candidates = make_candidates(*scenario, ego_length_m);
    if (!candidates) return fail(candidates.error());

    const Status moved = ranker->move_actors(scenario->ego.pose, motions);
    if (!moved) return fail(moved.error());
    RankBudget budget;
    budget.deadline_s = 0.05;
    const RankerAnswer answer = ranker->rank(*candidates, budget);
    if (!answer.status) return fail(answer.status.error());
    const RankedCandidate& best = answer.ranking[0];
    std::printf("%.1f s: %s, harm %.3f to %.3f%s\n", time_s,
                (*candidates)[best.candidate].name.c_str(), best.interval.lowest,
                best.interval.highest, answer.proved ? "" : ", others are in the race");

    next += std::chrono::milliseconds(100);
    std::this_thread::sleep_until(next);
  }
}

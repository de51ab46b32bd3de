// Ranks by a harm function of one's own: what the library finds out about each crash goes in, the
// order comes out.
#include <crashrank/crashrank.hpp>
#include <crashrank/scenario/scenario_models.hpp>

#include <algorithm>
#include <cstdio>
#include <vector>

using namespace crashrank;

static int fail(const Error& error) {
  std::fprintf(stderr, "%s\n", error.message().c_str());
  return 3;
}

/// People outside cars by the square of the speed that hits them, people inside by delta-v. The
/// numbers are an example and nobody's advice.
static double my_harm(const Scenario& scenario, const CandidateResult& candidate) {
  double harm = 0.0;
  for (const Contact& contact : candidate.contacts) {
    const double closing = contact.closing_speed_mps / 10.0;
    harm += contact.severity.ego.delta_v_mps / 20.0;
    switch (scenario.models[scenario.actors[contact.actor].model].kind) {
      case BodyKind::pedestrian:
      case BodyKind::bicycle:
      case BodyKind::motorcycle:
        harm += 5.0 * closing * closing;
        break;
      case BodyKind::car:
      case BodyKind::truck:
      case BodyKind::bus:
        harm += contact.severity.other.delta_v_mps / 20.0;
        break;
      default:
        break;
    }
  }
  return harm;
}

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  Result<Scenario> scenario = load_scenario_file(argv[1]);
  if (!scenario) return fail(scenario.error());
  const Result<std::vector<Model>> models = load_scenario_models(*scenario);
  if (!models) return fail(models.error());

  // The library's harm, everybody counting alike but for an ego that puts itself last.
  RankOptions options;
  options.measure = Measure::harm;
  options.harm = scenario->harm;
  options.harm->weights.ego_occupant = 0.5;
  const Result<RankResult> ranked = rank(*scenario, *models, options);
  if (!ranked) return fail(ranked.error());

  // And one's own, over the same simulated crashes. The sort is stable: what is equal stays in the
  // library's order.
  std::vector<CandidateResult> mine = ranked->ranking;
  std::stable_sort(mine.begin(), mine.end(),
                   [&](const CandidateResult& a, const CandidateResult& b) {
                     return my_harm(*scenario, a) < my_harm(*scenario, b);
                   });
  for (const CandidateResult& candidate : mine) {
    std::printf("%-32s mine %6.3f  library %6.3f\n",
                ranked->candidates[candidate.candidate].name.c_str(), my_harm(*scenario, candidate),
                candidate.score.value_or(-1.0));
  }
}

#include "crashrank/rank/anytime/ranker.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace crashrank {

Result<RankResult> rank_within(const Scenario& scenario, View<const Model> models,
                               const RankOptions& options, const RankBudget& budget,
                               double explanation_s) {
  if (scenario.ego.model >= models.size()) {
    return make_error(ErrorCode::usage, "the number of models differs from that of the scenario");
  }
  const double ego_length_m =
      static_cast<double>(models[scenario.ego.model].mesh.bounds().extent().x());
  const Result<std::vector<Candidate>> candidates = make_candidates(scenario, ego_length_m);
  if (!candidates) return candidates.error();
  RankerOptions prepared;
  prepared.rank = options;
  prepared.limits.candidates = candidates->size();
  prepared.limits.actors = scenario.actors.size();
  prepared.limits.triangles = std::numeric_limits<std::size_t>::max();
  Result<Ranker> ranker = Ranker::prepare(scenario, models, prepared);
  if (!ranker) return ranker.error();
  const RankerAnswer answer = ranker->rank(*candidates, budget);
  const double explained_s = budget.deadline_s < std::numeric_limits<double>::infinity()
                                 ? std::max(budget.deadline_s, explanation_s)
                                 : budget.deadline_s;
  return ranker->explain(*candidates, answer, budget.cancel, explained_s);
}

}  // namespace crashrank

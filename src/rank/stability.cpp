#include "rank/evaluate.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace crashrank::detail {

void tell_stability(RankResult& result) {
  std::vector<CandidateResult>& ranking = result.ranking;
  for (std::size_t place = 0; place < ranking.size(); ++place) {
    ranking[place].best_place = place;
    ranking[place].worst_place = place;
  }
  const std::size_t samples = result.samples.size();
  // Without a score there is nothing to put in order; those come last.
  const auto known = static_cast<std::size_t>(
      std::count_if(ranking.begin(), ranking.end(), [samples](const CandidateResult& c) {
        return c.score.has_value() && c.sample_scores.size() == samples;
      }));
  if (samples == 0 || known != ranking.size()) return;
  std::vector<std::size_t> order(known);
  for (std::size_t sample = 0; sample < samples; ++sample) {
    std::iota(order.begin(), order.end(), std::size_t{0});
    // Where a sample tells no difference, the ranking's own order stands.
    std::stable_sort(order.begin(), order.end(), [&](std::size_t p, std::size_t q) {
      return ranking[p].sample_scores[sample] < ranking[q].sample_scores[sample];
    });
    for (std::size_t place = 0; place < known; ++place) {
      CandidateResult& c = ranking[order[place]];
      c.best_place = std::min(c.best_place, place);
      c.worst_place = std::max(c.worst_place, place);
    }
  }
  for (std::size_t place = 0; place + 1 < known; ++place) {
    std::size_t turned = 0;
    for (std::size_t sample = 0; sample < samples; ++sample) {
      if (ranking[place + 1].sample_scores[sample] < ranking[place].sample_scores[sample]) {
        ++turned;
      }
    }
    ranking[place].overtaken = static_cast<double>(turned) / static_cast<double>(samples);
    ranking[place].separable = ranking[place].overtaken <= separable_share;
  }
}

}  // namespace crashrank::detail

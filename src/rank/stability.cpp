#include "rank/evaluate.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace crashrank::detail {
namespace {

/// Where scores are open, a candidate stands behind those whose scores are lower whatever is found
/// out, and before those whose scores are higher.
void places_by_intervals(std::vector<CandidateResult>& ranking) {
  std::vector<double> lowest;
  std::vector<double> highest;
  for (const CandidateResult& c : ranking) {
    lowest.push_back(c.score_interval.lowest);
    highest.push_back(c.score_interval.highest);
  }
  std::sort(lowest.begin(), lowest.end());
  std::sort(highest.begin(), highest.end());
  for (std::size_t place = 0; place < ranking.size(); ++place) {
    CandidateResult& c = ranking[place];
    const auto before =
        std::lower_bound(highest.begin(), highest.end(), c.score_interval.lowest) - highest.begin();
    const auto behind =
        lowest.end() - std::upper_bound(lowest.begin(), lowest.end(), c.score_interval.highest);
    // Of candidates that are level the order says who stands where.
    c.best_place = std::min(place, static_cast<std::size_t>(before));
    c.worst_place = std::max(place, ranking.size() - 1 - static_cast<std::size_t>(behind));
  }
}

}  // namespace

void tell_stability(RankResult& result) {
  std::vector<CandidateResult>& ranking = result.ranking;
  for (std::size_t place = 0; place < ranking.size(); ++place) {
    ranking[place].best_place = place;
    ranking[place].worst_place = place;
  }
  if (!result.complete) {
    places_by_intervals(ranking);
    return;
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

#include "rank/order.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace crashrank::detail {
namespace {

/// Where scores are open, a candidate stands behind those whose scores are lower whatever is found
/// out, and before those whose scores are higher.
void places_by_intervals(RankResult& result) {
  std::vector<CandidateResult>& ranking = result.ranking;
  std::vector<double> lowest;
  std::vector<double> highest;
  for (const CandidateResult& c : ranking) {
    lowest.push_back(c.score_interval.lowest);
    highest.push_back(c.score_interval.highest);
  }
  std::sort(lowest.begin(), lowest.end());
  std::sort(highest.begin(), highest.end());
  for (CandidateResult& c : ranking) {
    const auto before =
        std::lower_bound(highest.begin(), highest.end(), c.score_interval.lowest) - highest.begin();
    const auto behind =
        lowest.end() - std::upper_bound(lowest.begin(), lowest.end(), c.score_interval.highest);
    // Those tied with it overlap it and never stand before it. Where all else is level, the order
    // of the ranking decides.
    const std::size_t worst = ranking.size() - c.sharing - static_cast<std::size_t>(behind);
    c.best_place = std::min(c.place - 1, static_cast<std::size_t>(before));
    c.worst_place = std::max(c.place - 1, worst);
    if (!result.proved) continue;
    if (c.place == 1) {
      c.worst_place = 0;
    } else {
      c.best_place = std::max<std::size_t>(c.best_place, 1);
    }
  }
}

/// Whether the scores of two candidates differ, whatever value they take within their intervals.
bool scores_differ(const CandidateResult& a, const CandidateResult& b) {
  if (a.score && b.score) return *a.score != *b.score;
  const double lowest_a = a.score.value_or(a.score_interval.lowest);
  const double lowest_b = b.score.value_or(b.score_interval.lowest);
  return a.score.value_or(a.score_interval.highest) < lowest_b ||
         b.score.value_or(b.score_interval.highest) < lowest_a;
}

}  // namespace

void tell_stability(RankResult& result) {
  std::vector<CandidateResult>& ranking = result.ranking;
  assign_places(result);
  // What the vehicle cannot follow stands behind in every sample.
  const auto demoted = [&](const CandidateResult& c) {
    return !c.feasible && result.infeasible != Infeasible::keep;
  };
  for (CandidateResult& c : ranking) {
    c.best_place = c.place - 1;
    c.worst_place = c.place - 1;
  }
  for (std::size_t i = 0; i + 1 < ranking.size(); ++i) {
    ranking[i].separable =
        demoted(ranking[i]) != demoted(ranking[i + 1]) || scores_differ(ranking[i], ranking[i + 1]);
  }
  if (!result.complete) {
    places_by_intervals(result);
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
    if (is_numerical(result.samples[sample])) continue;
    std::iota(order.begin(), order.end(), std::size_t{0});
    // Where a sample tells no difference, the ranking's own order stands.
    std::stable_sort(order.begin(), order.end(), [&](std::size_t p, std::size_t q) {
      if (demoted(ranking[p]) != demoted(ranking[q])) return demoted(ranking[q]);
      return ranking[p].sample_scores[sample] < ranking[q].sample_scores[sample];
    });
    std::size_t place = 0;
    for (std::size_t i = 0; i < known; ++i) {
      CandidateResult& c = ranking[order[i]];
      // The sort is stable: candidates that tie in the ranking and in the sample stand together.
      const bool shared = i > 0 && ranking[order[i - 1]].place == c.place &&
                          ranking[order[i - 1]].sample_scores[sample] == c.sample_scores[sample];
      if (!shared) place = i;
      c.best_place = std::min(c.best_place, place);
      c.worst_place = std::max(c.worst_place, place);
    }
  }
  const std::size_t counted = range_sample_count(result);
  for (std::size_t place = 0; place + 1 < known; ++place) {
    if (demoted(ranking[place]) != demoted(ranking[place + 1])) continue;
    std::size_t turned = 0;
    for (std::size_t sample = 0; sample < samples; ++sample) {
      if (is_numerical(result.samples[sample])) continue;
      if (ranking[place + 1].sample_scores[sample] < ranking[place].sample_scores[sample]) {
        ++turned;
      }
    }
    CandidateResult& c = ranking[place];
    const CandidateResult& next = ranking[place + 1];
    c.overtaken = static_cast<double>(turned) / static_cast<double>(counted);
    c.within_numerical_error = counted < samples && c.place != next.place &&
                               c.numerical_interval.highest >= next.numerical_interval.lowest;
    c.separable = c.separable && !c.within_numerical_error && c.overtaken <= separable_share;
  }
}

}  // namespace crashrank::detail

#include "rank/order.hpp"
#include "rank/sampling_error.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace crashrank::detail {
namespace {

/// Feasibility of a candidate as far as it decides the place: demoted candidates follow all others.
enum Tier : std::uint8_t { followable, undecided, demoted, tiers };

Tier tier_of(const CandidateResult& c, Infeasible infeasible) {
  if (infeasible == Infeasible::keep) return followable;
  if (!c.feasible) return demoted;
  return c.score || c.searched ? followable : undecided;
}

/// Bounds on what orders a candidate.
double lowest_of(const CandidateResult& c, RankOrder order) {
  return c.score ? ordering_score(c, order) : c.score_interval.lowest;
}
double highest_of(const CandidateResult& c, RankOrder order) { return ordering_score(c, order); }

/// Returns true if `a` precedes `b` by tier and score, whatever the unknown values are.
bool is_certainly_before(const CandidateResult& a, const CandidateResult& b, const RankResult& of) {
  const Tier p = tier_of(a, of.infeasible);
  const Tier q = tier_of(b, of.infeasible);
  if (p == followable && q == demoted) return true;
  return p <= q && !(p == undecided && q == undecided) &&
         highest_of(a, of.order) < lowest_of(b, of.order);
}

/// Ends of the score intervals of the candidates of a tier, ascending.
struct TierEnds {
  std::vector<double> lowest;
  std::vector<double> highest;

  void sort() {
    std::sort(lowest.begin(), lowest.end());
    std::sort(highest.begin(), highest.end());
  }
  std::size_t all_below(double score) const {
    return static_cast<std::size_t>(std::lower_bound(highest.begin(), highest.end(), score) -
                                    highest.begin());
  }
  std::size_t all_above(double score) const {
    return static_cast<std::size_t>(lowest.end() -
                                    std::upper_bound(lowest.begin(), lowest.end(), score));
  }
};

/// Counts the candidates that certainly precede one with such bounds, and those that certainly
/// follow it.
void count_by_tiers(const std::array<TierEnds, tiers>& ends, Tier tier, double lowest,
                    double highest, std::size_t& before, std::size_t& behind) {
  for (const Tier other : {followable, undecided, demoted}) {
    const TierEnds& of = ends[other];
    if (tier == undecided && other == undecided) continue;
    if (other < tier) {
      before += other == followable && tier == demoted ? of.highest.size() : of.all_below(lowest);
    } else if (other > tier) {
      behind += tier == followable && other == demoted ? of.lowest.size() : of.all_above(highest);
    } else {
      before += of.all_below(lowest);
      behind += of.all_above(highest);
    }
  }
}

/// Places of a partial answer: bounded by the numbers of candidates that certainly precede or
/// follow.
void places_by_intervals(RankResult& result) {
  std::vector<CandidateResult>& ranking = result.ranking;
  std::array<TierEnds, tiers> ends;
  for (const CandidateResult& c : ranking) {
    TierEnds& own = ends[tier_of(c, result.infeasible)];
    own.lowest.push_back(lowest_of(c, result.order));
    own.highest.push_back(highest_of(c, result.order));
  }
  for (TierEnds& each : ends) each.sort();
  for (std::size_t first = 0, end = 0; first < ranking.size(); first = end) {
    // Candidates with equal known scores are ordered by the tie-breaks, which are known too.
    end = first + 1;
    const Tier tier = tier_of(ranking[first], result.infeasible);
    const double score = highest_of(ranking[first], result.order);
    while (ranking[first].score && end < ranking.size() && ranking[end].score &&
           highest_of(ranking[end], result.order) == score &&
           tier_of(ranking[end], result.infeasible) == tier) {
      ++end;
    }
    for (std::size_t i = first; i < end; ++i) {
      CandidateResult& c = ranking[i];
      std::size_t before = c.place - 1 - std::min(first, c.place - 1);
      std::size_t not_before = end - first - 1 - before;
      count_by_tiers(ends, tier, lowest_of(c, result.order), highest_of(c, result.order), before,
                     not_before);
      c.best_place = before;
      c.worst_place = ranking.size() - 1 - not_before;
      const bool wins = result.in_race.size() == 1 && result.in_race.front() == c.candidate;
      if (wins) c.worst_place = c.best_place;
    }
  }
}

/// Compares the scores of neighbours in the drawn futures: both follow the same sample, so errors
/// that affect both alike do not count.
void compare_samples(RankResult& result) {
  std::vector<CandidateResult>& ranking = result.ranking;
  for (std::size_t i = 0; i + 1 < ranking.size(); ++i) {
    CandidateResult& c = ranking[i];
    const CandidateResult& next = ranking[i + 1];
    if (c.drawn_scores.empty() || next.drawn_scores.empty()) continue;
    if (result.futures.undrawn == 0) {
      c.sampling_error_to_next =
          difference_error(result.futures, c.drawn_scores, next.drawn_scores);
    }
    const bool by_score =
        c.place != next.place && tier_of(c, result.infeasible) == tier_of(next, result.infeasible);
    if (!by_score || c.sampling_error_to_next == 0.0) continue;
    c.within_sampling_error =
        !c.sampling_error_to_next ||
        *next.score - *c.score <= separable_errors * *c.sampling_error_to_next;
    c.separable = c.separable && !c.within_sampling_error;
  }
}

}  // namespace

void compute_stability(RankResult& result) {
  std::vector<CandidateResult>& ranking = result.ranking;
  assign_places(result);
  // Infeasible candidates follow the others in every sample.
  const auto is_demoted = [&](const CandidateResult& c) {
    return tier_of(c, result.infeasible) == demoted;
  };
  for (CandidateResult& c : ranking) {
    c.best_place = c.place - 1;
    c.worst_place = c.place - 1;
  }
  for (std::size_t i = 0; i + 1 < ranking.size(); ++i) {
    ranking[i].separable = is_certainly_before(ranking[i], ranking[i + 1], result) ||
                           is_certainly_before(ranking[i + 1], ranking[i], result);
  }
  const bool by_score = result.order == RankOrder::score;
  if (by_score) compare_samples(result);
  if (!result.complete) places_by_intervals(result);
  // Samples vary the score alone.
  if (!result.complete || !by_score) return;
  const std::size_t samples = result.samples.size();
  // A candidate without scores in the samples cannot be sorted.
  const auto known = static_cast<std::size_t>(
      std::count_if(ranking.begin(), ranking.end(), [samples](const CandidateResult& c) {
        return c.score.has_value() && c.sample_scores.size() == samples;
      }));
  if (samples == 0 || known != ranking.size()) return;
  std::vector<std::size_t> order(known);
  for (std::size_t sample = 0; sample < samples; ++sample) {
    if (is_numerical(result.samples[sample])) continue;
    std::iota(order.begin(), order.end(), std::size_t{0});
    // The sort is stable: candidates that score equally in a sample keep the order of the ranking.
    std::stable_sort(order.begin(), order.end(), [&](std::size_t p, std::size_t q) {
      if (is_demoted(ranking[p]) != is_demoted(ranking[q])) return is_demoted(ranking[q]);
      return ranking[p].sample_scores[sample] < ranking[q].sample_scores[sample];
    });
    std::size_t place = 0;
    for (std::size_t i = 0; i < known; ++i) {
      CandidateResult& c = ranking[order[i]];
      // Candidates that are tied in the ranking and score equally in the sample are neighbours,
      // because the sort is stable.
      const bool shared = i > 0 && ranking[order[i - 1]].place == c.place &&
                          ranking[order[i - 1]].sample_scores[sample] == c.sample_scores[sample];
      if (!shared) place = i;
      c.best_place = std::min(c.best_place, place);
      c.worst_place = std::max(c.worst_place, place);
    }
  }
  const std::size_t counted = range_sample_count(result);
  for (std::size_t place = 0; place + 1 < known; ++place) {
    if (is_demoted(ranking[place]) != is_demoted(ranking[place + 1])) continue;
    std::size_t reversed = 0;
    for (std::size_t sample = 0; sample < samples; ++sample) {
      if (is_numerical(result.samples[sample])) continue;
      if (ranking[place + 1].sample_scores[sample] < ranking[place].sample_scores[sample]) {
        ++reversed;
      }
    }
    CandidateResult& c = ranking[place];
    const CandidateResult& next = ranking[place + 1];
    c.overtaken = static_cast<double>(reversed) / static_cast<double>(counted);
    c.within_numerical_error = counted < samples && c.place != next.place &&
                               c.numerical_interval.highest >= next.numerical_interval.lowest;
    c.separable = c.separable && !c.within_numerical_error && c.overtaken <= separable_share;
  }
}

}  // namespace crashrank::detail

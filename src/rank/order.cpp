#include "rank/evaluate.hpp"

#include <algorithm>
#include <limits>

namespace crashrank::detail {

bool ranks_before(const CandidateResult& a, const CandidateResult& b) {
  // A score where it is known, the worst that may come where it is not.
  const double worth_a = a.score.value_or(a.score_interval.highest);
  const double worth_b = b.score.value_or(b.score_interval.highest);
  if (worth_a != worth_b) return worth_a < worth_b;
  if (a.score.has_value() != b.score.has_value()) return a.score.has_value();
  if (a.collides != b.collides) return !a.collides;
  if (a.grazes.empty() != b.grazes.empty()) return a.grazes.empty();
  if (a.collides) {
    const Contact& p = a.contacts.front();
    const Contact& q = b.contacts.front();
    if (p.time_of_impact_s != q.time_of_impact_s) return p.time_of_impact_s > q.time_of_impact_s;
    if (p.closing_speed_mps != q.closing_speed_mps) {
      return p.closing_speed_mps < q.closing_speed_mps;
    }
  }
  return a.candidate < b.candidate;
}

void put_in_order(RankResult& result) {
  std::vector<CandidateResult>& ranking = result.ranking;
  std::sort(ranking.begin(), ranking.end(), ranks_before);
  result.complete = std::all_of(ranking.begin(), ranking.end(),
                                [](const CandidateResult& c) { return c.score.has_value(); });
  // Known scores have one winner, the first of them in the order. It and those not yet known stay
  // in the race unless somebody's highest score is below their lowest.
  double lowest_high = std::numeric_limits<double>::infinity();
  for (const CandidateResult& c : ranking) {
    lowest_high = std::min(lowest_high, c.score.value_or(c.score_interval.highest));
  }
  bool winner_seen = false;
  for (const CandidateResult& c : ranking) {
    const bool beaten = c.score.has_value() && winner_seen;
    winner_seen = winner_seen || c.score.has_value();
    if (!beaten && c.score_interval.lowest <= lowest_high) result.in_race.push_back(c.candidate);
  }
  result.proved = result.in_race.size() <= 1;
  tell_stability(result);
}

}  // namespace crashrank::detail

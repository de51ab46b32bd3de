#include "rank/evaluate.hpp"

#include <algorithm>
#include <limits>

namespace crashrank {
namespace {

/// -1: `a` stands before `b`; 1: behind it; 0: only the order of the candidates decides.
int compare(const CandidateResult& a, const CandidateResult& b) {
  // A score where it is known, the worst that may come where it is not.
  const double worth_a = a.score.value_or(a.score_interval.highest);
  const double worth_b = b.score.value_or(b.score_interval.highest);
  const auto before = [](bool first) { return first ? -1 : 1; };
  if (worth_a != worth_b) return before(worth_a < worth_b);
  if (a.score.has_value() != b.score.has_value()) return before(a.score.has_value());
  if (a.collision_probability != b.collision_probability) {
    return before(a.collision_probability < b.collision_probability);
  }
  if (a.collides != b.collides) return before(!a.collides);
  if (a.grazes.empty() != b.grazes.empty()) return before(a.grazes.empty());
  if (a.collides && !a.contacts.empty() && !b.contacts.empty()) {
    const Contact& p = a.contacts.front();
    const Contact& q = b.contacts.front();
    if (p.time_of_impact_s != q.time_of_impact_s) {
      return before(p.time_of_impact_s > q.time_of_impact_s);
    }
    if (p.closing_speed_mps != q.closing_speed_mps) {
      return before(p.closing_speed_mps < q.closing_speed_mps);
    }
  }
  return 0;
}

}  // namespace

std::size_t range_sample_count(const RankResult& result) noexcept {
  return static_cast<std::size_t>(
      std::count_if(result.samples.begin(), result.samples.end(),
                    [](const HarmSample& sample) { return !is_numerical(sample); }));
}

std::vector<std::size_t> tied_with(const RankResult& result, std::size_t index) {
  std::vector<std::size_t> tied;
  const std::size_t first = result.ranking[index].place - 1;
  const std::size_t end = std::min(first + result.ranking[index].sharing, result.ranking.size());
  for (std::size_t i = first; i < end; ++i) {
    if (i != index) tied.push_back(result.ranking[i].candidate);
  }
  return tied;
}

namespace detail {

bool ranks_before(const CandidateResult& a, const CandidateResult& b) {
  const int compared = compare(a, b);
  return compared != 0 ? compared < 0 : a.candidate < b.candidate;
}

void assign_places(std::vector<CandidateResult>& ranking) {
  for (std::size_t first = 0, end = 0; first < ranking.size(); first = end) {
    end = first + 1;
    // What is not known of a score may still decide: only known scores tie.
    while (end < ranking.size() && ranking[first].score && ranking[end].score &&
           compare(ranking[first], ranking[end]) == 0) {
      ++end;
    }
    for (std::size_t i = first; i < end; ++i) {
      ranking[i].place = first + 1;
      ranking[i].sharing = end - first;
    }
  }
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

}  // namespace detail
}  // namespace crashrank

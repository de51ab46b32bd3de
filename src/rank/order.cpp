#include "rank/order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crashrank {
namespace {

detail::OrderKey result_key(const CandidateResult& c, const RankResult& of) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  detail::OrderKey key;
  key.demoted = !c.feasible && of.infeasible != Infeasible::keep;
  key.score = detail::ordering_score(c, of.order);
  key.known = c.score.has_value();
  key.set_collision_probability(c.collision_probability);
  key.collides = c.collides;
  key.grazes = !c.grazes.empty();
  key.leaves_road = c.leaves_road.has_value();
  key.set_clearance(c.least_distance_m.value_or(infinity), c.least_time_gap_s.value_or(infinity),
                    c.time_to_collision_s.value_or(infinity));
  if (!c.contacts.empty()) {
    key.first_s = c.contacts.front().time_of_impact_s;
    key.closing_mps = c.contacts.front().closing_speed_mps;
  } else if (c.first_touch) {
    key.first_s = c.first_touch->time_of_impact_s;
    key.closing_mps = c.first_touch->closing_speed_mps;
  }
  if (c.at_horizon) key.end_speed_mps = c.at_horizon->speed_mps;
  return key;
}

}  // namespace

std::size_t range_sample_count(const RankResult& result) noexcept {
  return static_cast<std::size_t>(
      std::count_if(result.samples.begin(), result.samples.end(),
                    [](const HarmSample& sample) { return !is_numerical(sample); }));
}

std::size_t first_by(const RankResult& result, RankOrder order) noexcept {
  const std::vector<CandidateResult>& ranking = result.ranking;
  std::size_t first = 0;
  for (std::size_t row = 1; row < ranking.size(); ++row) {
    const bool demoted =
        !ranking[row].feasible && ranking[first].feasible && result.infeasible != Infeasible::keep;
    if (!demoted && detail::ordering_score(ranking[row], order) <
                        detail::ordering_score(ranking[first], order)) {
      first = row;
    }
  }
  return first;
}

std::optional<std::size_t> first_without_errors(const RankResult& result) noexcept {
  const std::vector<CandidateResult>& ranking = result.ranking;
  if (!result.futures.has_state_errors || result.futures.combinations > 1.0) return std::nullopt;
  std::optional<std::size_t> first;
  double least = std::numeric_limits<double>::infinity();
  const bool keeps = result.infeasible == Infeasible::keep;
  for (std::size_t row = 0; row < ranking.size(); ++row) {
    if (!ranking[row].score || ranking[row].futures.empty()) return std::nullopt;
    if (!keeps && !ranking[row].feasible && ranking.front().feasible) continue;
    const double score = ranking[row].futures.front().score;
    if (first && !(score < least)) continue;
    first = row;
    least = score;
  }
  return first;
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

const char* infeasible_name(Infeasible infeasible) noexcept {
  switch (infeasible) {
    case Infeasible::demote:
      return "demote";
    case Infeasible::drop:
      return "drop";
    case Infeasible::keep:
      return "keep";
  }
  return "demote";
}

Result<Infeasible> infeasible_from_name(const std::string& name) {
  for (const Infeasible each : {Infeasible::demote, Infeasible::drop, Infeasible::keep}) {
    if (name == infeasible_name(each)) return each;
  }
  return make_error(ErrorCode::usage, "'" + name + "' is not a treatment of infeasible manoeuvres",
                    "choose demote, drop or keep");
}

const char* order_name(RankOrder order) noexcept {
  return order == RankOrder::upper ? "upper" : "score";
}

Result<RankOrder> order_from_name(const std::string& name) {
  for (const RankOrder each : {RankOrder::score, RankOrder::upper}) {
    if (name == order_name(each)) return each;
  }
  return make_error(ErrorCode::usage, "'" + name + "' is not an order of candidates",
                    "choose score or upper");
}

const char* basis_name(RankBasis basis) noexcept {
  switch (basis) {
    case RankBasis::braking:
      return "braking";
    case RankBasis::coarse:
      return "coarse";
    case RankBasis::simulated:
      return "simulated";
    case RankBasis::proved:
      return "proved";
  }
  return "proved";
}

namespace detail {

double ordering_score(const CandidateResult& candidate, RankOrder order) noexcept {
  const double highest = candidate.score_interval.highest;
  return order == RankOrder::upper ? highest : candidate.score.value_or(highest);
}

void OrderKey::set_collision_probability(double probability) noexcept {
  constexpr double per_step = 1e9;
  collision_probability = std::round(per_step * probability) / per_step;
}

void OrderKey::set_clearance(double least_m, double least_gap_s,
                             double time_to_collision_s) noexcept {
  time_to_collision_cs = std::round(100.0 * std::min(time_to_collision_s, imminent_crash_s));
  distance_cm = std::round(100.0 * std::min(least_m, enough_distance_m));
  time_gap_cs = std::round(100.0 * std::min(least_gap_s, enough_time_gap_s));
}

bool OrderKey::is_best_of_its_score() const noexcept {
  return !(collision_probability > 0.0) && !collides && !grazes && !leaves_road &&
         time_to_collision_cs == std::round(100.0 * imminent_crash_s) &&
         distance_cm == std::round(100.0 * enough_distance_m) &&
         time_gap_cs == std::round(100.0 * enough_time_gap_s) && end_speed_mps == 0.0;
}

int compare(const OrderKey& a, const OrderKey& b) noexcept {
  const auto before = [](bool first) { return first ? -1 : 1; };
  if (a.demoted != b.demoted) return before(b.demoted);
  if (a.score != b.score) return before(a.score < b.score);
  if (a.known != b.known) return before(a.known);
  if (a.collision_probability != b.collision_probability) {
    return before(a.collision_probability < b.collision_probability);
  }
  if (a.collides != b.collides) return before(!a.collides);
  if (a.grazes != b.grazes) return before(!a.grazes);
  if (a.time_to_collision_cs != b.time_to_collision_cs) {
    return before(a.time_to_collision_cs > b.time_to_collision_cs);
  }
  if (a.leaves_road != b.leaves_road) return before(!a.leaves_road);
  if (a.distance_cm != b.distance_cm) return before(a.distance_cm > b.distance_cm);
  if (a.time_gap_cs != b.time_gap_cs) return before(a.time_gap_cs > b.time_gap_cs);
  if (!a.collides) {
    if (a.end_speed_mps == b.end_speed_mps) return 0;
    return before(a.end_speed_mps < b.end_speed_mps);
  }
  if (a.first_s != b.first_s) return before(a.first_s > b.first_s);
  if (a.closing_mps != b.closing_mps) return before(a.closing_mps < b.closing_mps);
  return 0;
}

void assign_places(RankResult& result) {
  std::vector<CandidateResult>& ranking = result.ranking;
  for (std::size_t first = 0, end = 0; first < ranking.size(); first = end) {
    end = first + 1;
    const OrderKey key = result_key(ranking[first], result);
    // An unknown score can still differ, so only known scores tie.
    while (end < ranking.size() && ranking[first].score && ranking[end].score &&
           compare(key, result_key(ranking[end], result)) == 0) {
      ++end;
    }
    for (std::size_t i = first; i < end; ++i) {
      ranking[i].place = first + 1;
      ranking[i].sharing = end - first;
    }
  }
}

void drop_infeasible(RankResult& result) {
  // The feasibility of candidates that are not fully evaluated is not known.
  if (result.infeasible != Infeasible::drop || !result.complete) return;
  const auto first = std::find_if(result.ranking.begin(), result.ranking.end(),
                                  [](const CandidateResult& c) { return !c.feasible; });
  if (first == result.ranking.begin()) return;
  for (auto c = first; c != result.ranking.end(); ++c) result.dropped.push_back(c->candidate);
  std::sort(result.dropped.begin(), result.dropped.end());
  result.ranking.erase(first, result.ranking.end());
}

void sort_ranking(RankResult& result) {
  std::vector<CandidateResult>& ranking = result.ranking;
  std::sort(ranking.begin(), ranking.end(), [&](const auto& a, const auto& b) {
    const int compared = compare(result_key(a, result), result_key(b, result));
    return compared != 0 ? compared < 0 : a.candidate < b.candidate;
  });
  result.complete = std::all_of(ranking.begin(), ranking.end(),
                                [](const CandidateResult& c) { return c.score.has_value(); });
  drop_infeasible(result);
  // Among the known scores only the first of the sorted ranking can win. It and the unknown ones
  // stay in the race unless the upper bound of another candidate is below their lower bound.
  double lowest_high = std::numeric_limits<double>::infinity();
  const auto demoted = [&](const CandidateResult& c) {
    return !c.feasible && result.infeasible != Infeasible::keep;
  };
  const auto followable = [&](const CandidateResult& c) {
    return !demoted(c) && (c.score || c.searched || result.infeasible == Infeasible::keep);
  };
  const bool all_demoted = std::all_of(ranking.begin(), ranking.end(), demoted);
  const bool any_followable = std::any_of(ranking.begin(), ranking.end(), followable);
  for (const CandidateResult& c : ranking) {
    if (!all_demoted && !followable(c)) continue;
    lowest_high = std::min(lowest_high, ordering_score(c, result.order));
  }
  bool winner_seen = false;
  for (const CandidateResult& c : ranking) {
    // Demoted candidates can be first only if no candidate is known to be feasible.
    if (demoted(c) && any_followable) continue;
    const bool beaten = c.score.has_value() && winner_seen;
    winner_seen = winner_seen || c.score.has_value();
    if (!beaten && c.score_interval.lowest <= lowest_high) result.in_race.push_back(c.candidate);
  }
  result.proved = result.in_race.size() <= 1;
  result.basis = result.proved           ? RankBasis::proved
                 : ranking.front().score ? RankBasis::simulated
                                         : RankBasis::coarse;
  compute_stability(result);
}

}  // namespace detail
}  // namespace crashrank

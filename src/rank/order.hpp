#pragma once

#include "crashrank/rank/rank.hpp"

#include <cstddef>

namespace crashrank::detail {

/// Sort key of a candidate: what is known so far of the quantities that decide its place.
struct OrderKey {
  bool demoted = false;  ///< the vehicle cannot follow it, and infeasible candidates rank last
  double score = 0.0;    ///< what orders, or its upper bound or estimate if it is not known
  bool known = false;
  double collision_probability = 0.0;  ///< a multiple of 1e-9
  bool collides = false;               ///< in the likeliest future, like the next
  bool grazes = false;
  bool leaves_road = false;
  /// Hundredths of a second, at most `imminent_crash_s`.
  double time_to_collision_cs = 0.0;
  double distance_cm = 0.0;  ///< whole centimetres, at most `enough_distance_m`
  double time_gap_cs = 0.0;  ///< hundredths of a second, at most `enough_time_gap_s`
  double first_s = 0.0;      ///< time of the first contact; only for candidates that collide
  double closing_mps = 0.0;
  double end_speed_mps = 0.0;  ///< speed at the horizon; only for candidates that do not collide

  /// Rounds the probability, so that the rounding of its sum does not decide.
  void set_collision_probability(double probability) noexcept;
  /// Rounds all to their accuracy, so that smaller differences do not decide.
  void set_clearance(double least_m, double least_gap_s, double time_to_collision_s) noexcept;
  /// Returns true if no candidate with the same score can precede it.
  bool is_best_of_its_score() const noexcept;
};

/// The number by which a candidate is ordered: its score or the upper end of its interval as
/// requested; the upper end if its score is not known.
double ordering_score(const CandidateResult& candidate, RankOrder order) noexcept;

/// Returns -1 if `a` precedes `b`, 1 if it follows, 0 if only the order of the candidates decides.
int compare(const OrderKey& a, const OrderKey& b) noexcept;

/// Sorts the ranking, drops infeasible candidates if requested, and computes which candidates can
/// be first and how stable the places are.
void sort_ranking(RankResult& result);

/// Removes infeasible candidates from a sorted ranking, if that is requested and at least one
/// candidate remains.
void drop_infeasible(RankResult& result);

/// Assigns the places of a sorted ranking and computes their stability over the samples.
void compute_stability(RankResult& result);

/// Sets `place` and `sharing` of a sorted ranking.
void assign_places(RankResult& result);

}  // namespace crashrank::detail

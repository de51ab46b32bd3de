#pragma once

#include "crashrank/rank/rank.hpp"

#include <cstddef>

namespace crashrank::detail {

/// What decides the place of a candidate, as far as it is known.
struct OrderKey {
  bool demoted = false;  ///< the vehicle cannot follow it, and that counts
  double score = 0.0;    ///< the score, the worst that may come where it is not known
  bool known = false;
  double collision_probability = 0.0;
  bool collides = false;  ///< this and the next in the likeliest future
  bool grazes = false;
  bool leaves_road = false;
  double distance_cm = 0.0;  ///< whole ones, at most `enough_distance_m`
  double time_gap_cs = 0.0;  ///< whole hundredths of a second, at most `enough_time_gap_s`
  double first_s = 0.0;      ///< of the first contact; of candidates that collide
  double closing_mps = 0.0;
  double end_speed_mps = 0.0;  ///< at the horizon; of candidates that do not

  /// To what both are exact: less must not decide.
  void set_clearance(double least_m, double least_s) noexcept;
  /// No other stands before it at the same score.
  bool is_best_of_its_score() const noexcept;
};

/// -1: `a` stands before `b`; 1: behind it; 0: only the order of the candidates decides.
int compare(const OrderKey& a, const OrderKey& b) noexcept;

/// Orders the ranking, leaves out what is dropped, and says how sure its first place is.
void sort_ranking(RankResult& result);

/// Leaves what the vehicle cannot follow out of a ranking in order, where that is asked for and
/// something is left.
void drop_infeasible(RankResult& result);

/// Fills the places of a ranking that is in order, and says how stable they are over the samples.
void compute_stability(RankResult& result);

/// Fills `place` and `sharing` of a ranking that is in order.
void assign_places(RankResult& result);

}  // namespace crashrank::detail

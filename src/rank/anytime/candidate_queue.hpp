#pragma once

#include "rank/anytime/refine.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace crashrank::detail {

/// Decides which candidates can still be first and in which order candidates are refined. Those of
/// which nothing is known wait in an order that spreads over their list, the hardest braking one
/// first. The others form a heap with the most promising on top: the hardest braking one until its
/// score is known, then by score estimates. Candidates that are demoted as infeasible come last.
class CandidateQueue {
public:
  void prepare(std::size_t most) {
    waiting_.reserve(most);
    beaten_.reserve(most);
    tiers_.reserve(most);
  }

  /// Starts a call with all candidates.
  void begin(const std::vector<CandidateState>& states, std::size_t count);

  /// Moves up to `most` candidates of which nothing is known into `chosen` and returns their
  /// number.
  std::size_t choose_unseen(std::size_t most, std::uint32_t* chosen);
  /// Moves up to `most` waiting candidates that can still be first into `chosen` and returns their
  /// number; 0 if no waiting candidate can change the first place. After `requeue_beaten` all
  /// waiting candidates are eligible.
  std::size_t choose(const std::vector<CandidateState>& states, std::size_t most,
                     std::uint32_t* chosen);

  /// Inserts a candidate after a refinement step.
  void insert(std::uint32_t candidate, const std::vector<CandidateState>& states);

  /// Called once the first place is decided: makes the candidates that cannot be first eligible, so
  /// that the remaining places are decided. Returns false if there are none.
  bool requeue_beaten(const std::vector<CandidateState>& states);

  bool decided() const noexcept { return resumed_; }
  /// Upper bound on the score of the best candidate.
  double limit() const noexcept { return limit_of(first_tier()); }

  /// Sets `in_race` of every candidate.
  void mark_in_race(std::vector<CandidateState>& states);
  /// The candidate to choose by what is known, after `mark_in_race`: the proved one; else the best
  /// known one, unless braking hardest may be better; else one that keeps clear of everybody by
  /// its estimate; else braking. Requires a candidate.
  std::uint32_t choice(const std::vector<CandidateState>& states, RankBasis& basis) const;

private:
  /// Feasibility: the first place goes to the first tier that is not empty.
  enum Tier : std::uint8_t { feasible, undecided, demoted };

  static Tier tier(const CandidateState& state) noexcept {
    if (!state.result.feasible) return demoted;
    return state.demand_known || state.result.known ? feasible : undecided;
  }
  Tier first_tier() const noexcept {
    if (counts_[feasible] > 0) return feasible;
    return counts_[undecided] > 0 ? undecided : demoted;
  }
  /// Infinite for undecided candidates, because it is not known whether their scores count.
  double limit_of(Tier tier) const noexcept {
    if (tier == undecided) return std::numeric_limits<double>::infinity();
    return limits_[tier];
  }
  bool goes_first(const std::vector<CandidateState>& states, std::uint32_t a,
                  std::uint32_t b) const;
  bool can_be_first(const CandidateState& state, const std::vector<CandidateState>& states) const;
  void push(const std::vector<CandidateState>& states, std::uint32_t candidate);
  void find_braking(const std::vector<CandidateState>& states);

  std::vector<std::uint32_t> waiting_;  ///< heap
  std::vector<std::uint32_t> beaten_;
  std::size_t count_ = 0;
  std::size_t seen_ = 0;    ///< number of candidates that were chosen as unseen
  std::size_t stride_ = 1;  ///< between two of them
  bool resumed_ = false;
  std::vector<Tier> tiers_;              ///< by candidate
  std::array<std::size_t, 3> counts_{};  ///< number of candidates, by tier
  std::array<double, 3> limits_{};       ///< smallest upper bound on a score, by tier
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t best_known_ = none;
  std::uint32_t braking_ = 0;  ///< brakes hardest of those that are not demoted
  std::uint32_t first_seen_ = 0;
};

}  // namespace crashrank::detail

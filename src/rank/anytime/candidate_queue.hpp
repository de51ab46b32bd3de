#pragma once

#include "rank/anytime/refine.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace crashrank::detail {

/// Who can still be first, and whose turn it is to be looked at more closely. Candidates wait in a
/// heap, the most promising on top: those of the lowest possible score, of these that of the lowest
/// certain one, then in their own order; last those that are demoted as not feasible.
class CandidateQueue {
public:
  void prepare(std::size_t most) {
    waiting_.reserve(most);
    beaten_.reserve(most);
    tiers_.reserve(most);
  }

  /// All begin.
  void begin(std::size_t count);

  /// Takes up to `most` from the waiting into `chosen`; 0 when none that waits has a part in what
  /// is to be decided.
  std::size_t choose(const std::vector<CandidateState>& states, std::size_t most,
                     std::uint32_t* chosen);

  /// One that was chosen, or has been looked at for the first time, comes back.
  void insert(std::uint32_t candidate, const std::vector<CandidateState>& states);

  /// The first place is decided: those who cannot have it get their turn for the others. False when
  /// there are none.
  bool requeue_beaten(const std::vector<CandidateState>& states);

  bool decided() const noexcept { return resumed_; }
  /// The best candidate's score is at most this.
  double limit() const noexcept { return limit_of(first_tier()); }

  /// Says of everybody whether he is in the race.
  void mark_in_race(std::vector<CandidateState>& states);

private:
  /// Whether the vehicle can follow it: the first place goes to the first tier that has anybody.
  enum Tier : std::uint8_t { feasible, undecided, demoted };

  static Tier tier(const CandidateState& state) noexcept {
    if (!state.result.feasible) return demoted;
    return state.demand_known || state.result.known ? feasible : undecided;
  }
  Tier first_tier() const noexcept {
    if (counts_[feasible] > 0) return feasible;
    return counts_[undecided] > 0 ? undecided : demoted;
  }
  /// Of those yet undecided none knows whether their scores count.
  double limit_of(Tier tier) const noexcept {
    if (tier == undecided) return std::numeric_limits<double>::infinity();
    return limits_[tier];
  }
  bool goes_first(const std::vector<CandidateState>& states, std::uint32_t a,
                  std::uint32_t b) const;
  bool can_be_first(const CandidateState& state, const std::vector<CandidateState>& states) const;
  void push(const std::vector<CandidateState>& states, std::uint32_t candidate);

  std::vector<std::uint32_t> waiting_;  ///< a heap
  std::vector<std::uint32_t> beaten_;
  std::size_t count_ = 0;
  bool resumed_ = false;
  std::vector<Tier> tiers_;              ///< by candidate
  std::array<std::size_t, 3> counts_{};  ///< of candidates, by tier
  std::array<double, 3> limits_{};       ///< the least of their highest scores
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t best_known_ = none;
};

}  // namespace crashrank::detail

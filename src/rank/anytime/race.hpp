#pragma once

#include "rank/anytime/refine.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace crashrank::detail {

/// Who can still be first, and whose turn it is to be looked at more closely. Candidates wait in a
/// heap, the most promising on top: those of the lowest possible score, of these that of the lowest
/// certain one, then in their own order.
class Race {
public:
  void prepare(std::size_t most) {
    waiting_.reserve(most);
    beaten_.reserve(most);
  }

  /// All begin.
  void begin(const std::vector<Refined>& states, std::size_t count);

  /// Takes up to `most` from the waiting into `chosen`; 0 when nobody that waits has a part in what
  /// is to be decided.
  std::size_t choose(const std::vector<Refined>& states, std::size_t most, std::uint32_t* chosen);

  /// One that was chosen, or has been looked at for the first time, comes back.
  void put_back(std::uint32_t candidate, const std::vector<Refined>& states);

  /// The first place is decided: those who cannot have it get their turn for the others. False when
  /// there are none.
  bool resume(const std::vector<Refined>& states);

  bool decided() const noexcept { return resumed_; }
  /// The best candidate's score is at most this.
  double limit() const noexcept { return limit_; }

  /// Says of everybody whether he is in the race.
  void mark(std::vector<Refined>& states);

private:
  bool sooner(const std::vector<Refined>& states, std::uint32_t a, std::uint32_t b) const;
  bool can_win(const RankedCandidate& candidate, const std::vector<Refined>& states) const;
  void push(const std::vector<Refined>& states, std::uint32_t candidate);

  std::vector<std::uint32_t> waiting_;  ///< a heap
  std::vector<std::uint32_t> beaten_;
  std::size_t count_ = 0;
  bool resumed_ = false;
  double limit_ = std::numeric_limits<double>::infinity();
  static constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t best_known_ = nobody;
};

}  // namespace crashrank::detail

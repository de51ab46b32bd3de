#pragma once

#include "crashrank/rank/anytime/ranker.hpp"
#include "rank/bounds.hpp"
#include "rank/deadline.hpp"
#include "rank/evaluate.hpp"
#include "rank/order.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace crashrank::detail {

/// What is known of the score of a candidate in one future.
struct FutureScore {
  static constexpr double unknown = -1.0;
  static constexpr std::uint32_t no_contact = static_cast<std::uint32_t>(-1);

  double score = unknown;
  double lower_bound = 0.0;  ///< lower bound while the score is not known
  double estimate = 0.0;     ///< estimate while the score is not known, see BoxCrash
  /// Work of the longest simulation of its crash so far, in outline pieces moved.
  std::uint64_t simulated = 0;
  std::uint32_t first = no_contact;    ///< index of its first contact in CandidateState::first_hits
  bool contact_without_force = false;  ///< see Contact; valid if the score is known

  bool known() const noexcept { return score >= 0.0; }
};

/// State of a candidate between two refinement steps.
struct CandidateState {
  RankedCandidate result;
  bool unresolved = false;    ///< a test stayed undecided: the candidate cannot be refined further
  double upper_bound = 0.0;   ///< upper bound on the score in any future
  bool demand_known = false;  ///< `result.feasible` is final
  double coarse = 0.0;        ///< estimate in the likeliest future; valid from the stage `near` on
  /// How hard its plan brakes and how little it turns: the sums of the squared speeds and yaw rates
  /// at a few times. The least is the hardest braking with the least steering.
  double speed2 = 0.0;
  double turn2 = 0.0;
  /// Actors that were left out of the futures and that its crash reaches; further ones follow when
  /// these are included.
  std::array<std::uint32_t, 16> needed{};
  std::size_t needed_count = 0;
  /// leaving the road on its plan; valid from the stage `near` on
  std::optional<RoadLeaving> leaving;
  std::vector<FutureScore> futures;  ///< by future
  /// First contacts of the futures, within a group in order of time; valid from the stage
  /// `searched` on.
  std::vector<Scratch::Hit> first_hits;

  /// Allocates for any scene with these plans and at most as many futures; no step allocates
  /// afterwards.
  void reserve(const Futures& all) {
    const std::size_t count = all.max_future_count();
    futures.reserve(count);
    // Each is the first contact of some future, and within a group a plan has at most one.
    first_hits.reserve(all.displaces_ego() ? count : std::min(count, all.plans.size()));
  }

  bool needs_refinement() const noexcept { return !result.known && !unresolved; }
  /// An estimate is known, or the score.
  bool seen() const noexcept { return result.known || result.stage > RankStage::unseen; }
  bool brakes_harder_than(const CandidateState& other) const noexcept {
    return speed2 != other.speed2 ? speed2 < other.speed2 : turn2 < other.turn2;
  }
};

/// Inputs of a refinement step.
struct RefineQuery {
  const Scene& scene;
  const ScoreBounds& bounds;
  const Candidate& candidate;
  /// The step may stop once the score is proved to exceed this. Other threads may lower it.
  const std::atomic<double>& limit;
  const Deadline& deadline;

  double stop_above() const noexcept { return limit.load(std::memory_order_relaxed); }
};

/// Result of a refinement step.
struct StepResult {
  std::uint64_t work = 0;
  bool finished = true;  ///< false: the deadline passed first; the interval may still be narrower
};

/// Initialises the state of a candidate of which only the upper bound is known. `displaced` is
/// working memory for a motion.
void begin_refining(const Scene& scene, const ScoreBounds& bounds, const Candidate& candidate,
                    std::size_t index, Motion& displaced, CandidateState& state);

/// For a candidate whose swept boxes overlap no actor: its score is at most the harm of leaving the
/// road.
void bound_as_clear(const Scene& scene, CandidateState& state);

/// Refines a candidate by one stage. Depends on the query and the state of the candidate alone. The
/// interval never widens. Requires `needs_refinement`.
StepResult refine(const RefineQuery& query, CandidateState& state, Scratch& scratch);

/// Sort key from what is known of a candidate. If its score is not known, the estimate takes its
/// place.
OrderKey key_of(const RankedCandidate& candidate) noexcept;
/// Returns true if `a` precedes `b` by what is known of both: those that cannot be followed and
/// those of which nothing is known come last, these the hardest braking first.
bool ranks_before(const CandidateState& a, const CandidateState& b) noexcept;

}  // namespace crashrank::detail

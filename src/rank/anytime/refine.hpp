#pragma once

#include "crashrank/rank/anytime/ranker.hpp"
#include "rank/bounds.hpp"
#include "rank/deadline.hpp"
#include "rank/evaluate.hpp"
#include "rank/order.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace crashrank::detail {

/// What is known of a candidate's score in one future.
struct FutureScore {
  static constexpr double unknown = -1.0;
  static constexpr std::uint32_t no_contact = static_cast<std::uint32_t>(-1);

  double score = unknown;
  double lower_bound = 0.0;  ///< it is not below, where it is not known
  double estimate = 0.0;     ///< what it is taken for, where it is not known: see estimate_score
  /// Pieces of outlines that the longest simulation of its crash so far has moved.
  std::uint64_t simulated = 0;
  std::uint32_t first = no_contact;  ///< index of its first contact in CandidateState::first_hits

  bool known() const noexcept { return score >= 0.0; }
};

/// A candidate on its way to its score, between two steps.
struct CandidateState {
  RankedCandidate result;
  bool unresolved = false;             ///< a question about it stayed undecided: no step follows
  double upper_bound = 0.0;            ///< no future's score is above
  bool demand_known = false;           ///< `result.feasible` is final
  bool needs_left_out = false;         ///< its crash reaches an actor left out of the futures
  std::optional<RoadLeaving> leaving;  ///< of its plan; from the stage `near` on
  std::vector<FutureScore> futures;    ///< what is known of each
  /// First contacts of the futures, those of a group by their times; from the stage `searched` on.
  std::vector<Scratch::Hit> first_hits;

  /// Room for any scene of so many plans and futures: nothing allocates after it.
  void reserve(const Futures& all) {
    const std::size_t count = all.max_future_count();
    futures.reserve(count);
    // Every one is some future's, and no plan has two in one group.
    first_hits.reserve(all.displaces_ego() ? count : std::min(count, all.plans.size()));
  }

  bool needs_refinement() const noexcept { return !result.known && !unresolved; }
};

/// What a step needs to know.
struct RefineQuery {
  const Scene& scene;
  const ScoreBounds& bounds;
  const Candidate& candidate;
  /// The step may end once the score is proved to exceed this. If it is finite, who is first is to
  /// be decided, and a crash is simulated a part at a time.
  double stop_above;
  const Deadline& deadline;
};

/// What came of a step.
struct StepResult {
  std::uint64_t work = 0;
  bool finished = true;  ///< false: time was up first; the interval may be narrower all the same
};

/// Begins with a candidate of which nothing is known yet. `displaced` is for a motion.
void begin_refining(const Scene& scene, const ScoreBounds& bounds, const Candidate& candidate,
                    std::size_t index, Motion& displaced, CandidateState& state);

/// The candidate is known to come near nobody: what it scores is that of leaving the road at most.
void bound_as_clear(const Scene& scene, CandidateState& state);

/// Takes an open candidate one stage further. Depends on the query and the candidate's own state
/// alone. The interval only ever narrows.
StepResult refine(const RefineQuery& query, CandidateState& state, Scratch& scratch);

/// What decides the place, for what is known of a candidate so far. Where the score is not known,
/// by its estimate or by the worst that may come.
OrderKey key_of(const RankedCandidate& candidate, bool by_estimate) noexcept;
/// Whether `a` stands before `b`, for what is known of both.
bool ranks_before(const RankedCandidate& a, const RankedCandidate& b, bool by_estimate) noexcept;

}  // namespace crashrank::detail

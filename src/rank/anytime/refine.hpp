#pragma once

#include "crashrank/rank/anytime/ranker.hpp"
#include "rank/anytime/bounds.hpp"
#include "rank/anytime/watch.hpp"
#include "rank/evaluate.hpp"
#include "rank/order.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace crashrank::detail {

/// A candidate on its way to its score, between two steps.
struct Refined {
  RankedCandidate told;
  bool stuck = false;      ///< a question about it stayed undecided: no step follows
  Contact first;           ///< of `future`: from which its crash is simulated
  std::size_t future = 0;  ///< whose crash is simulated next
  /// Pieces of outline that the simulation of that crash has moved so far.
  std::uint64_t simulated = 0;
  double most = 0.0;                   ///< no future's score is above
  bool demand_known = false;           ///< `told.feasible` is final
  std::optional<RoadLeaving> leaving;  ///< of its plan; from the stage `near` on
  std::vector<double> scores;          ///< by future; below 0: not known

  bool open() const noexcept { return !told.known && !stuck; }
};

/// What a step needs to know.
struct RefineQuery {
  const Scene& scene;
  const ScoreBounds& bounds;
  const Candidate& candidate;
  /// The step may end once the score is proved to exceed this. If it is finite, who is first is to
  /// be decided, and a crash is simulated a part at a time.
  double give_up_above;
  const Watch& watch;
};

/// What came of a step.
struct StepEnd {
  std::uint64_t work = 0;
  bool finished = true;  ///< false: time was up first; the interval may be narrower all the same
};

/// Begins with a candidate of which nothing is known yet. `room` is for a motion.
void begin_refining(const Scene& scene, const ScoreBounds& bounds, const Candidate& candidate,
                    std::size_t index, Motion& room, Refined& state);

/// The candidate is known to come near nobody: what it scores is that of leaving the road at most.
void bound_as_clear(const Scene& scene, Refined& state);

/// Takes an open candidate one stage further. Depends on the query and the candidate's own state
/// alone. The interval only ever narrows.
StepEnd refine(const RefineQuery& query, Refined& state, Scratch& scratch);

/// What decides the place, for what is known of a candidate so far.
OrderKey key_of(const RankedCandidate& candidate) noexcept;
/// Whether `a` stands before `b`, for what is known of both.
bool promises_more(const RankedCandidate& a, const RankedCandidate& b) noexcept;

}  // namespace crashrank::detail

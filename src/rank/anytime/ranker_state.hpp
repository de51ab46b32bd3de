#pragma once

#include "base/hidden.hpp"
#include "crashrank/dispatch/worker_pool.hpp"
#include "crashrank/rank/anytime/ranker.hpp"
#include "rank/anytime/candidate_queue.hpp"
#include "rank/anytime/refine.hpp"
#include "rank/anytime/step_rounds.hpp"
#include "rank/bounds.hpp"
#include "rank/deadline.hpp"
#include "rank/scene.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace crashrank {

/// Memory and state of a Ranker, and the rounds of refinement of a call.
struct CRASHRANK_HIDDEN Ranker::State {
  State(detail::Scene&& made, WorkerPool&& started)
      : scene(std::move(made)), rounds(scene, bounds, std::move(started)) {}

  detail::Scene scene;
  detail::ScoreBounds bounds;
  detail::StepRounds rounds;
  RankerLimits limits;
  RankResult bodies;  ///< the part of the result that `explain` copies: bodies and options
  /// Samples of a complete answer. The scene has none during `rank`, since no step evaluates them.
  std::vector<HarmSample> samples;
  double prepare_s = 0.0;
  std::vector<detail::CandidateState> states;
  std::vector<RankedCandidate> ranking;
  detail::CandidateQueue queue;
  std::array<std::uint32_t, detail::StepRounds::max_steps> chosen{};
  std::vector<Motion> new_motions;  ///< motions of the actors while they are checked and copied
  Motion displaced;                 ///< working memory for a displaced motion
  std::size_t known = 0;            ///< number of candidates with a known score in this call
  std::vector<char> rings;          ///< by actor: see leave_out_distant_actors
  std::vector<char> needed;         ///< by actor: left out and reached by a crash
  std::vector<char> places;         ///< by actor: it keeps a place, see Ranker::enter
  bool needs_left_out = false;      ///< there is such an actor

  /// Stores the results of a round in the order of its steps, as far as the work budget allows.
  /// Returns false if work or time is used up.
  bool collect_results(std::size_t steps, const RankBudget& budget, std::uint64_t& work) noexcept;
  /// Refines candidates until time or work is used up or all is decided.
  void refine_all(const RankBudget& budget, RankerEffort& effort) noexcept;
  /// Refines candidates in futures that leave out distant actors. If a crash reaches one of these,
  /// starts again with it included.
  void refine_in_futures(View<const Candidate> candidates, const RankBudget& budget,
                         RankerEffort& effort) noexcept;
  /// Refuses an actor that keeps no place, or whose place is taken or not as it should not be.
  Status check_place(std::size_t actor, bool taken) const;
  /// Lets an actor exist in every future or in none.
  void set_existence(std::size_t actor, bool exists) noexcept;
  /// Resets all candidates to their upper bounds. Does not touch what running workers use.
  void begin(View<const Candidate> candidates) noexcept;
  /// Evaluates the candidates of an answer in full, the first first. Marks in `needed` the actors
  /// that were left out of the futures and that a crash reaches. Returns false if the deadline left
  /// known ones without contacts and samples.
  bool explain_all(View<const Candidate> candidates, const RankerAnswer& answer,
                   const detail::Deadline& deadline, RankResult& result);
  /// Writes the answer from the first `all` states. Does not touch what running workers use.
  void write_answer(RankerAnswer& answer, std::size_t all) noexcept;
};

}  // namespace crashrank

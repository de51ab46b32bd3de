#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/dispatch/worker_pool.hpp"
#include "rank/anytime/refine.hpp"
#include "rank/deadline.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace crashrank::detail {

/// Rounds of refinement steps of a Ranker, shared by the calling thread and its workers.
///
/// At the deadline a round returns without waiting for workers in the middle of a step. They read
/// and write only this object, the scene and the bounds, none of which may change before `await`.
class StepRounds {
public:
  /// Largest number of steps in a round. It does not depend on the number of workers, because
  /// answers that are limited by work depend on it.
  static constexpr std::size_t max_steps = 64;

  /// `scene` and `bounds` must outlive the object.
  StepRounds(const Scene& scene, const ScoreBounds& bounds, WorkerPool&& pool)
      : scene_(scene), bounds_(bounds), pool_(std::move(pool)) {}
  StepRounds(const StepRounds&) = delete;
  StepRounds& operator=(const StepRounds&) = delete;
  ~StepRounds() { await(); }

  /// Allocates for a number of candidates.
  void prepare(std::size_t candidates);

  /// Waits for workers that are still running from an earlier call.
  void await() noexcept;
  /// Waits until the deadline at the latest; returns false if workers are still running.
  bool await(const Deadline& limit) noexcept;

  /// Starts a call with its candidates and deadline. The call will not wait for running workers at
  /// its deadline if the workers check the clock often enough and the candidates can be copied
  /// without allocation.
  void begin(View<const Candidate> candidates, const Deadline& deadline) noexcept;
  View<const Candidate> candidates() const noexcept { return candidates_; }
  bool expired() const noexcept { return deadline_.expired(); }
  const Deadline& deadline() const noexcept { return deadline_; }

  /// Refines the chosen candidates by one stage, on all threads. A step may stop once the score is
  /// proved to exceed `stop_above`. If the call has a deadline and `lowers`, scores that become
  /// known lower that limit for all steps at once: without a deadline answers must not depend on
  /// which thread is faster.
  void run(const std::vector<CandidateState>& states, const std::uint32_t* chosen,
           std::size_t steps, double stop_above, bool lowers) noexcept;

  /// Result of a step of the last round; null state if it was not finished. Valid until the next
  /// round.
  struct Done {
    const CandidateState* state = nullptr;
    StepResult end;
  };
  Done done(std::size_t step) const noexcept;

  /// Working memory of the calling thread.
  Scratch& caller_scratch() noexcept { return scratch_.front(); }

private:
  struct Slot {
    CandidateState state;
    StepResult end;
    std::atomic<bool> done{false};  ///< the other two members are complete
  };
  struct Helper {
    StepRounds* rounds = nullptr;
    std::uint32_t worker = 0;
  };

  void run_steps(Scratch& own, const Deadline& deadline) noexcept;

  const Scene& scene_;
  const ScoreBounds& bounds_;
  WorkerPool pool_;
  std::vector<Scratch> scratch_;  ///< that of the calling thread first
  std::vector<Helper> helpers_;
  /// copies without names, for workers that may outlast the call
  std::vector<Candidate> copies_;

  // Written by the calling thread, read by all threads.
  View<const Candidate> candidates_;
  Deadline deadline_;
  Deadline workers_deadline_;
  std::atomic<double> stop_above_{0.0};
  bool lowers_ = false;
  std::size_t count_ = 0;
  std::array<std::uint32_t, max_steps> chosen_{};
  std::atomic<std::size_t> next_{0};
  std::array<Slot, max_steps> slots_;

  /// the call returns at its deadline even if workers are running
  bool returns_at_deadline_ = false;
  bool workers_running_ = false;  ///< workers may still be running from the last call
};

}  // namespace crashrank::detail

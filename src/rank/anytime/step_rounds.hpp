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

/// Steps of a Ranker, shared by the calling thread and its workers in rounds.
///
/// At the end of time a round returns without the workers that are still at a step: what they read
/// and write is in here, in the scene and in the bounds, and none of it may change before `await`.
class StepRounds {
public:
  /// Steps that are begun together at most, whatever the number of workers: answers cut by work
  /// depend on it.
  static constexpr std::size_t max_steps = 64;

  /// Both have to outlive it.
  StepRounds(const Scene& scene, const ScoreBounds& bounds, WorkerPool&& pool)
      : scene_(scene), bounds_(bounds), pool_(std::move(pool)) {}
  StepRounds(const StepRounds&) = delete;
  StepRounds& operator=(const StepRounds&) = delete;
  ~StepRounds() { await(); }

  /// Sets aside memory for as many candidates.
  void prepare(std::size_t candidates);

  /// Waits for workers that an earlier call has left.
  void await() noexcept;
  /// The same until time is up at the latest; false where they are still at it.
  bool await(const Deadline& limit) noexcept;

  /// The candidates of a call and its time. Workers are left behind where they look at the clock
  /// all along, and where candidates can be kept without memory.
  void begin(View<const Candidate> candidates, const Deadline& deadline) noexcept;
  View<const Candidate> candidates() const noexcept { return candidates_; }
  bool expired() const noexcept { return deadline_.expired(); }
  const Deadline& deadline() const noexcept { return deadline_; }

  /// Takes the chosen candidates one stage further, on all threads. Each may be left as soon as its
  /// score is proved to exceed `stop_above`.
  void run(const std::vector<CandidateState>& states, const std::uint32_t* chosen,
           std::size_t steps, double stop_above) noexcept;

  /// What came of one of these; null where none is through with it. Stands until the next round.
  struct Done {
    const CandidateState* state = nullptr;
    StepResult end;
  };
  Done done(std::size_t step) const noexcept;

  /// The calling thread's memory.
  Scratch& caller_scratch() noexcept { return scratch_.front(); }

private:
  struct Slot {
    CandidateState state;
    StepResult end;
    std::atomic<bool> done{false};  ///< the other two are whole
  };
  struct Helper {
    StepRounds* rounds = nullptr;
    std::uint32_t worker = 0;
  };

  void run_steps(Scratch& own, const Deadline& deadline) noexcept;

  const Scene& scene_;
  const ScoreBounds& bounds_;
  WorkerPool pool_;
  std::vector<Scratch> scratch_;  ///< the calling thread's first
  std::vector<Helper> helpers_;
  std::vector<Candidate> copies_;  ///< copies for workers that may be left, without names

  // Set by the calling thread, read by all.
  View<const Candidate> candidates_;
  Deadline deadline_;
  Deadline workers_deadline_;
  double stop_above_ = 0.0;
  std::size_t count_ = 0;
  std::array<std::uint32_t, max_steps> chosen_{};
  std::atomic<std::size_t> next_{0};
  std::array<Slot, max_steps> slots_;

  bool returns_at_deadline_ = false;  ///< the call returns at its time, whatever the workers are at
  bool workers_running_ = false;      ///< it did so: they may still be at it
};

}  // namespace crashrank::detail

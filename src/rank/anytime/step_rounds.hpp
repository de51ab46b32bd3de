#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/dispatch/worker_pool.hpp"
#include "rank/anytime/refine.hpp"
#include "rank/watch.hpp"

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
  static constexpr std::size_t most_steps = 64;

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
  bool await(const Watch& limit) noexcept;

  /// The candidates of a call and its time. Workers are left behind where they look at the clock
  /// all along, and where candidates can be kept without memory.
  void begin(View<const Candidate> candidates, const Watch& watch) noexcept;
  View<const Candidate> candidates() const noexcept { return candidates_; }
  bool expired() const noexcept { return watch_.expired(); }
  const Watch& watch() const noexcept { return watch_; }

  /// Takes the chosen candidates one stage further, on all threads. Each may be left as soon as its
  /// score is proved to exceed `give_up_above`.
  void run(const std::vector<Refined>& states, const std::uint32_t* chosen, std::size_t steps,
           double give_up_above) noexcept;

  /// What came of one of these; null where nobody is through with it. Stands until the next round.
  struct Done {
    const Refined* state = nullptr;
    StepEnd end;
  };
  Done done(std::size_t step) const noexcept;

  /// The calling thread's memory.
  Scratch& own() noexcept { return scratch_.front(); }

private:
  struct Slot {
    Refined state;
    StepEnd end;
    std::atomic<bool> done{false};  ///< the other two are whole
  };
  struct Helper {
    StepRounds* rounds = nullptr;
    std::uint32_t worker = 0;
  };

  void take_part(Scratch& own, const Watch& until) noexcept;

  const Scene& scene_;
  const ScoreBounds& bounds_;
  WorkerPool pool_;
  std::vector<Scratch> scratch_;  ///< the calling thread's first
  std::vector<Helper> helpers_;
  std::vector<Candidate> kept_;  ///< copies for workers that may be left, without names

  // Set by the calling thread, read by all.
  View<const Candidate> candidates_;
  Watch watch_;
  Watch helpers_watch_;
  double give_up_above_ = 0.0;
  std::size_t count_ = 0;
  std::array<std::uint32_t, most_steps> chosen_{};
  std::atomic<std::size_t> next_{0};
  std::array<Slot, most_steps> slots_;

  bool leaves_ = false;  ///< the call returns at its time, whatever the workers are at
  bool left_ = false;    ///< it did so: they may still be at it
};

}  // namespace crashrank::detail

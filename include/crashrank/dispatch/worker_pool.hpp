#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/internal/base/export.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>

namespace crashrank {

/// One bit per worker in the words that say who holds what.
inline constexpr std::uint32_t max_workers = 64;

/// How many threads, and how they wait.
struct PoolOptions {
  std::uint32_t workers = 4;  ///< threads beside the caller's, 0 to `max_workers`
  bool pinned = false;        ///< worker i stays on processor i modulo their number
  /// How long an idle thread looks for work before it sleeps, µs, at most 1000. Negative: 20 where
  /// there are more processors than workers, 0 elsewhere, where spinning would hold up a worker.
  std::int32_t spin_us = -1;
};

/// Threads that are started once and fed by one other thread, the owner, which alone calls the
/// members. A worker takes tasks in the order posted, one running and one waiting at most; idle
/// workers and a waiting owner sleep after a short spin. Nothing is allocated after the start.
class CRASHRANK_API WorkerPool {
public:
  /// What a worker runs. A task that throws ends the thread's task, not the thread: see `failure`.
  struct Task {
    /// Called with `context` and the number of the worker.
    void (*run)(void* context, std::uint32_t worker) = nullptr;
    void* context = nullptr;  ///< the task's own
  };

  /// Errors: usage for numbers out of range, internal when a thread cannot be started.
  static Result<WorkerPool> start(const PoolOptions& options);

  /// Moves; the threads go along.
  WorkerPool(WorkerPool&& other) noexcept;
  WorkerPool& operator=(WorkerPool&& other) noexcept;  ///< Moves; ends the threads it had.
  /// Ends the threads after the task each has in hand; tasks that wait are dropped.
  ~WorkerPool();

  /// Number of workers.
  std::uint32_t size() const noexcept;
  /// How long idle threads spin before they sleep, s.
  double spin_seconds() const noexcept;
  /// Sets that until the next call, s, at most a millisecond: for a stretch of work in which every
  /// thread has a processor, so that none need be woken. Negative: back to what it was at the
  /// start.
  void set_spin(double seconds) noexcept;
  /// Wakes a worker that sleeps, so that it spins when its task comes.
  void rouse(std::uint32_t worker) noexcept;
  /// Tasks posted to a worker and neither finished nor taken back: 0, 1 or 2.
  std::uint32_t outstanding(std::uint32_t worker) const noexcept;
  /// Hands a task over; `outstanding(worker)` has to be below 2.
  void post(std::uint32_t worker, Task task) noexcept;
  /// Takes back the oldest task that the worker has not begun, for the owner to run; false where
  /// there is none.
  bool recall(std::uint32_t worker, Task& task) noexcept;
  /// Sleeps until a task has finished that had not when `seen` was taken from `finished_tasks()`.
  void wait_beyond(std::uint32_t seen) noexcept;
  /// Tasks finished by all workers since the start, modulo 2^32.
  std::uint32_t finished_tasks() const noexcept;
  /// Waits until nothing is outstanding.
  void wait_all() noexcept;
  /// The same until that time at the latest, whatever the workers are at; true when nothing is
  /// outstanding. Workers go on with what they have in hand.
  bool wait_all_until(std::chrono::steady_clock::time_point until) noexcept;
  /// True after a task threw, until `take_failure`. May be asked at any time, also by workers.
  bool failed() const noexcept;
  /// What the first task that threw said, as an Error of kind internal; clears it. Call after
  /// `wait_all`; success when nothing threw.
  Status take_failure();

  /// Runs `body(index, worker)` once for every index below `count`, on all workers; returns when
  /// all are done, or with the first failure. `body` is called from several threads at a time. With
  /// no workers the calling thread does all (as worker 0).
  template <class Body> Status for_each(std::size_t count, Body&& body) {
    using Plain = std::remove_reference_t<Body>;
    return run_indices(
        count,
        [](void* opaque, std::size_t index, std::uint32_t worker) {
          (*static_cast<Plain*>(opaque))(index, worker);
        },
        const_cast<std::remove_const_t<Plain>*>(&body));
  }

private:
  struct State;
  using IndexBody = void (*)(void* opaque, std::size_t index, std::uint32_t worker);

  explicit WorkerPool(std::unique_ptr<State> state) noexcept;
  Status run_indices(std::size_t count, IndexBody body, void* opaque);

  std::unique_ptr<State> state_;
};

}  // namespace crashrank

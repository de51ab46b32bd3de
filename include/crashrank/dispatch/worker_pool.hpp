#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/internal/base/export.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>

namespace crashrank {

/// Limit of the bit masks that have one bit per worker.
inline constexpr std::uint32_t max_workers = 64;

/// Number of threads, and how they wait.
struct PoolOptions {
  std::uint32_t workers = 4;  ///< threads beside the caller's, 0 to `max_workers`
  /// Time for which an idle thread polls before it sleeps, µs, at most 1000. Negative: 20 where
  /// there are more processors than workers, 0 elsewhere, where polling would delay a worker.
  std::int32_t spin_us = -1;
};

/// Threads that are started once and get tasks from one other thread, the owner, which alone calls
/// the members. A worker takes tasks in the order posted, one running and one waiting at most; idle
/// workers and a waiting owner sleep after a short spin. Nothing is allocated after the start.
class CRASHRANK_API WorkerPool {
public:
  /// A function and its argument. An exception ends the task, not the thread: see `take_failure`.
  struct Task {
    /// Called with `context` and the number of the worker.
    void (*run)(void* context, std::uint32_t worker) = nullptr;
    void* context = nullptr;  ///< the task's own
  };

  /// Errors: usage for numbers out of range, internal when a thread cannot be started.
  static Result<WorkerPool> start(const PoolOptions& options);

  /// Moves; the threads go along.
  WorkerPool(WorkerPool&& other) noexcept;
  WorkerPool& operator=(WorkerPool&& other) noexcept;  ///< Moves; ends the threads of the target.
  /// Ends the threads after the tasks they run; waiting tasks are dropped.
  ~WorkerPool();

  /// Number of workers.
  std::uint32_t size() const noexcept;
  /// Time for which idle threads poll before they sleep, s.
  double spin_seconds() const noexcept;
  /// Sets that time until the next call, s, at most a millisecond: for work during which
  /// every thread has a processor, so that none has to be woken. Negative: the value at the
  /// start.
  void set_spin(double seconds) noexcept;
  /// Wakes a sleeping worker, so that it polls when its task arrives.
  void rouse(std::uint32_t worker) noexcept;
  /// Tasks posted to a worker and neither finished nor recalled: 0, 1 or 2.
  std::uint32_t outstanding(std::uint32_t worker) const noexcept;
  /// Posts a task; `outstanding(worker)` has to be below 2.
  void post(std::uint32_t worker, Task task) noexcept;
  /// Removes the oldest task that the worker has not begun, for the owner to run; false if there is
  /// none.
  bool recall(std::uint32_t worker, Task& task) noexcept;
  /// Sleeps until a task has finished that had not when `seen` was taken from `finished_tasks()`.
  void wait_beyond(std::uint32_t seen) noexcept;
  /// Tasks finished by all workers since the start, modulo 2^32.
  std::uint32_t finished_tasks() const noexcept;
  /// Waits until nothing is outstanding.
  void wait_all() noexcept;
  /// The same until that time at the latest; true when nothing is outstanding. Workers continue the
  /// tasks they run.
  bool wait_all_until(std::chrono::steady_clock::time_point until) noexcept;
  /// True after a task threw, until `take_failure`. Any thread may call it at any time.
  bool failed() const noexcept;
  /// Returns the first exception of a task as an Error of kind internal, and clears it. Call after
  /// `wait_all`; success if no task threw.
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

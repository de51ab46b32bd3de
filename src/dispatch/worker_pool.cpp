#include "crashrank/dispatch/worker_pool.hpp"

#include "base/hidden.hpp"
#include "dispatch/alarm.hpp"
#include "dispatch/pause.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <chrono>
#include <cstring>
#include <exception>
#include <mutex>
#include <new>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

/// A slot for a task. The worker may read it while the owner, which has recalled the task, writes
/// the next one there: what it saw then counts for nothing.
class Place {
public:
  void put(const WorkerPool::Task& task) noexcept {
    run_.store(task.run, std::memory_order_relaxed);
    context_.store(task.context, std::memory_order_relaxed);
  }
  WorkerPool::Task look() const noexcept {
    return {run_.load(std::memory_order_relaxed), context_.load(std::memory_order_relaxed)};
  }

private:
  std::atomic<decltype(WorkerPool::Task::run)> run_{};
  std::atomic<void*> context_{nullptr};
};

/// A ring of two tasks with one writer, the owner, and one reader, the worker. The counters grow
/// without end; a task's place is its number's last bit. A task belongs to whoever moves `claimed`
/// past it: the worker, or the owner who wants it back. The place of task n is written again, for
/// n + 2, only once n is claimed, and claims go in order: who looks first and claims then has seen
/// task n. A sleeping worker waits for the bell.
struct alignas(64) Mailbox {
  std::array<Place, 2> ring{};
  alignas(64) std::atomic<std::uint32_t> posted{0};
  std::atomic<std::uint32_t> bell{0};
  std::uint32_t recalled = 0;  ///< the owner's
  alignas(64) std::atomic<std::uint32_t> claimed{0};
  std::atomic<std::uint32_t> finished{0};

  void ring_bell() noexcept {
    bell.fetch_add(1, std::memory_order_release);
    bell.notify_one();
  }
};

}  // namespace

struct CRASHRANK_HIDDEN WorkerPool::State {
  explicit State(std::uint32_t workers) : mailboxes(workers) {}

  std::vector<Mailbox> mailboxes;
  std::vector<std::thread> threads;
  std::atomic<std::int64_t> spin_ns{0};
  std::int64_t usual_spin_ns = 0;
  alignas(64) std::atomic<std::uint32_t> finished{0};
  detail::Alarm owner_alarm;  ///< for an owner that waits until a time
  alignas(64) std::atomic<bool> stop{false};
  std::atomic<bool> failed{false};
  std::mutex failure_lock;
  std::array<char, 256> failure{};  ///< what the first failure said, cut to fit

  /// Allocates nothing: memory may be what has run out.
  void fail(const char* what) noexcept {
    const std::lock_guard<std::mutex> hold(failure_lock);
    if (failed.load(std::memory_order_relaxed)) return;
    const std::size_t length = std::min(std::strlen(what), failure.size() - 1);
    std::copy_n(what, length, failure.begin());
    failure[length] = '\0';
    failed.store(true, std::memory_order_release);
  }

  void run(const Task& task, std::uint32_t worker) noexcept {
    try {
      task.run(task.context, worker);
    } catch (const std::bad_alloc&) {
      fail("out of memory");
    } catch (const std::exception& error) {
      fail(error.what());
    } catch (...) {
      fail("an exception that is no std::exception");
    }
  }

  void serve(std::uint32_t worker) noexcept {
    Mailbox& mail = mailboxes[worker];
    for (std::uint32_t taken = 0;; ++taken) {
      detail::wait_until(mail.bell, spin_ns,
                         [&] { return mail.posted.load(std::memory_order_acquire) != taken; });
      if (stop.load(std::memory_order_acquire)) return;
      const Task task = mail.ring[taken & 1U].look();
      std::uint32_t next = taken;
      if (!mail.claimed.compare_exchange_strong(next, taken + 1, std::memory_order_acq_rel)) {
        continue;  // taken back
      }
      run(task, worker);
      mail.finished.fetch_add(1, std::memory_order_release);
      finished.fetch_add(1, std::memory_order_release);
      finished.notify_one();
      owner_alarm.ring();
    }
  }

  void end() noexcept {
    stop.store(true, std::memory_order_release);
    for (Mailbox& mail : mailboxes) {
      mail.posted.fetch_add(1, std::memory_order_release);
      mail.ring_bell();
    }
    for (std::thread& thread : threads) thread.join();
  }

  ~State() { end(); }
};

WorkerPool::WorkerPool(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
WorkerPool::WorkerPool(WorkerPool&& other) noexcept = default;
WorkerPool& WorkerPool::operator=(WorkerPool&& other) noexcept = default;
WorkerPool::~WorkerPool() = default;

Result<WorkerPool> WorkerPool::start(const PoolOptions& options) {
  if (options.workers > max_workers) {
    return make_error(ErrorCode::usage, "more than 64 workers", "ask for 0 to 64");
  }
  if (options.spin_us > 1000) {
    return make_error(ErrorCode::usage, "idle workers may spin for 1000 µs at most");
  }
  try {
    auto state = std::make_unique<State>(options.workers);
    const bool room = std::thread::hardware_concurrency() > options.workers;
    state->usual_spin_ns = std::int64_t{1000} * (options.spin_us >= 0 ? options.spin_us
                                                 : room               ? 20
                                                                      : 0);
    state->spin_ns.store(state->usual_spin_ns, std::memory_order_relaxed);
    state->threads.reserve(options.workers);
    State* const raw = state.get();
    for (std::uint32_t worker = 0; worker < options.workers; ++worker) {
      state->threads.emplace_back([raw, worker] { raw->serve(worker); });
    }
    return WorkerPool(std::move(state));
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  } catch (const std::exception& error) {
    return make_error(ErrorCode::internal,
                      std::string("a worker thread could not be started: ") + error.what(),
                      "ask for fewer workers, or raise the limits on threads and memory");
  }
}

std::uint32_t WorkerPool::size() const noexcept {
  return static_cast<std::uint32_t>(state_->mailboxes.size());
}

double WorkerPool::spin_seconds() const noexcept {
  return 1e-9 * static_cast<double>(state_->spin_ns.load(std::memory_order_relaxed));
}

void WorkerPool::set_spin(double seconds) noexcept {
  const std::int64_t spin = seconds < 0.0
                                ? state_->usual_spin_ns
                                : static_cast<std::int64_t>(std::min(seconds, 1e-3) * 1e9);
  state_->spin_ns.store(spin, std::memory_order_relaxed);
}

void WorkerPool::rouse(std::uint32_t worker) noexcept { state_->mailboxes[worker].ring_bell(); }

std::uint32_t WorkerPool::outstanding(std::uint32_t worker) const noexcept {
  const Mailbox& mail = state_->mailboxes[worker];
  return mail.posted.load(std::memory_order_relaxed) - mail.recalled -
         mail.finished.load(std::memory_order_acquire);
}

void WorkerPool::post(std::uint32_t worker, Task task) noexcept {
  assert(outstanding(worker) < 2);
  Mailbox& mail = state_->mailboxes[worker];
  mail.ring[mail.posted.load(std::memory_order_relaxed) & 1U].put(task);
  mail.posted.fetch_add(1, std::memory_order_release);
  mail.ring_bell();
}

bool WorkerPool::recall(std::uint32_t worker, Task& task) noexcept {
  Mailbox& mail = state_->mailboxes[worker];
  const std::uint32_t posted = mail.posted.load(std::memory_order_relaxed);
  std::uint32_t next = mail.claimed.load(std::memory_order_relaxed);
  while (next != posted) {
    if (mail.claimed.compare_exchange_weak(next, next + 1, std::memory_order_acq_rel)) {
      ++mail.recalled;
      task = mail.ring[next & 1U].look();
      return true;
    }
  }
  return false;
}

std::uint32_t WorkerPool::finished_tasks() const noexcept {
  return state_->finished.load(std::memory_order_acquire);
}

void WorkerPool::wait_beyond(std::uint32_t seen) noexcept {
  detail::wait_until(state_->finished, state_->spin_ns,
                     [&] { return state_->finished.load(std::memory_order_acquire) != seen; });
}

void WorkerPool::wait_all() noexcept {
  for (std::uint32_t worker = 0; worker < size(); ++worker) {
    for (;;) {
      const std::uint32_t seen = finished_tasks();
      if (outstanding(worker) == 0) break;
      wait_beyond(seen);
    }
  }
}

bool WorkerPool::wait_all_until(std::chrono::steady_clock::time_point until) noexcept {
  const std::chrono::nanoseconds spin(state_->spin_ns.load(std::memory_order_relaxed));
  return state_->owner_alarm.wait_until(until, spin, [this] {
    for (std::uint32_t worker = 0; worker < size(); ++worker) {
      if (outstanding(worker) != 0) return false;
    }
    return true;
  });
}

bool WorkerPool::failed() const noexcept { return state_->failed.load(std::memory_order_acquire); }

Status WorkerPool::take_failure() {
  const std::lock_guard<std::mutex> hold(state_->failure_lock);
  if (!state_->failed.load(std::memory_order_acquire)) return Success{};
  state_->failed.store(false, std::memory_order_release);
  return make_error(ErrorCode::internal, std::string("a worker failed: ") + state_->failure.data());
}

Status WorkerPool::run_indices(std::size_t count, IndexBody body, void* opaque) {
  struct Shared {
    IndexBody body;
    void* opaque;
    std::size_t count;
    const State* state;
    std::atomic<std::size_t> next{0};
  } shared{body, opaque, count, state_.get()};
  const Task task{[](void* context, std::uint32_t worker) {
                    Shared& work = *static_cast<Shared*>(context);
                    while (!work.state->failed.load(std::memory_order_relaxed)) {
                      const std::size_t index = work.next.fetch_add(1, std::memory_order_relaxed);
                      if (index >= work.count) return;
                      work.body(work.opaque, index, worker);
                    }
                  },
                  &shared};
  if (size() == 0) {
    state_->run(task, 0);
  } else {
    wait_all();
    const auto helpers = static_cast<std::uint32_t>(std::min<std::size_t>(size(), count));
    for (std::uint32_t worker = 0; worker < helpers; ++worker) post(worker, task);
    wait_all();
  }
  return take_failure();
}

}  // namespace crashrank

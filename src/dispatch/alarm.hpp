#pragma once

#include "dispatch/pause.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>

// A futex takes the kernel's own timespec, which where long has 32 bits is not the C library's.
#if defined(__linux__) && defined(__LP64__)
#define CRASHRANK_HAS_FUTEX 1
#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <ctime>
#else
#include <thread>
#endif

namespace crashrank::detail {

/// Lets one thread sleep until something is done or a time has come; std::atomic cannot wait for a
/// time. Others ring after what may have made it done: one load if no thread sleeps.
class Alarm {
public:
  using Clock = std::chrono::steady_clock;

  void ring() noexcept {
    // Whoever sleeps has said so before looking, we have changed what is looked at before asking;
    // both orders are sequentially consistent, so one of us sees the other.
    std::atomic_thread_fence(std::memory_order_seq_cst);
    if (!sleeps_.load(std::memory_order_seq_cst)) return;
    rung_.fetch_add(1, std::memory_order_seq_cst);
#if defined(CRASHRANK_HAS_FUTEX)
    ::syscall(SYS_futex, &rung_, FUTEX_WAKE_PRIVATE, 1, nullptr, nullptr, 0);
#endif
  }

  /// Looks for at most `spin`, then sleeps, until `done()` or that time; says which. Being woken by
  /// the time takes about 0.1 ms (the kernel's slack for timers is half of that): the last part is
  /// looked through.
  template <class Done>
  bool wait_until(Clock::time_point until, std::chrono::nanoseconds spin, Done&& done) noexcept {
    constexpr std::chrono::microseconds waking{120};
    if (look(std::min(until, Clock::now() + spin), done)) return true;
    if (Clock::now() + waking < until && sleep_until(until - waking, done)) return true;
    return look(until, done);
  }

private:
  template <class Done> static bool look(Clock::time_point until, Done& done) noexcept {
    for (;;) {
      const bool over = Clock::now() >= until;
      for (int i = 0; i < 32; ++i) {
        if (done()) return true;
        if (over) return false;
        pause();
      }
    }
  }

  template <class Done> bool sleep_until(Clock::time_point until, Done& done) noexcept {
    sleeps_.store(true, std::memory_order_seq_cst);
    bool is_done = false;
    for (;;) {
      const std::uint32_t rung = rung_.load(std::memory_order_seq_cst);
      std::atomic_thread_fence(std::memory_order_seq_cst);
      is_done = done();
      if (is_done || Clock::now() >= until) break;
      sleep(rung, until);
    }
    sleeps_.store(false, std::memory_order_seq_cst);
    return is_done;
  }

  void sleep(std::uint32_t rung, Clock::time_point until) noexcept {
#if defined(CRASHRANK_HAS_FUTEX)
    // The steady clock is CLOCK_MONOTONIC, by which FUTEX_WAIT_BITSET takes an absolute time.
    static_assert(sizeof(rung_) == sizeof(std::uint32_t));
    const auto at = std::chrono::nanoseconds(until.time_since_epoch()).count();
    timespec end{};
    end.tv_sec = static_cast<std::time_t>(at / 1'000'000'000);
    end.tv_nsec = static_cast<long>(at % 1'000'000'000);
    ::syscall(SYS_futex, &rung_, FUTEX_WAIT_BITSET_PRIVATE, rung, &end, nullptr,
              FUTEX_BITSET_MATCH_ANY);
#else
    static_cast<void>(rung);
    constexpr std::chrono::microseconds nap(50);
    std::this_thread::sleep_until(std::min(Clock::now() + nap, until));
#endif
  }

  std::atomic<bool> sleeps_{false};
  std::atomic<std::uint32_t> rung_{0};
};

}  // namespace crashrank::detail

#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

namespace crashrank::detail {

/// Tells the processor that this is a spinning loop.
inline void pause() noexcept {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield" ::: "memory");
#endif
}

/// Waits until `done()`: looks for at most `spin_ns`, which may change meanwhile, then sleeps until
/// `bell` changes, which it does after every change of what `done` looks at.
template <class Done>
void wait_until(const std::atomic<std::uint32_t>& bell, const std::atomic<std::int64_t>& spin_ns,
                Done&& done) noexcept {
  using Clock = std::chrono::steady_clock;
  for (;;) {
    const std::uint32_t rung = bell.load(std::memory_order_acquire);
    if (done()) return;
    if (spin_ns.load(std::memory_order_relaxed) > 0) {
      const Clock::time_point start = Clock::now();
      do {
        for (int i = 0; i < 32; ++i) {
          if (done()) return;
          pause();
        }
      } while (Clock::now() - start <
               std::chrono::nanoseconds(spin_ns.load(std::memory_order_relaxed)));
    }
    bell.wait(rung, std::memory_order_acquire);
  }
}

}  // namespace crashrank::detail

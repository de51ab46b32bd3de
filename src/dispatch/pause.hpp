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

/// Waits until `word` differs from `seen`: looks for at most `spin`, then sleeps.
inline void wait_until_changed(const std::atomic<std::uint32_t>& word, std::uint32_t seen,
                               std::chrono::microseconds spin) noexcept {
  if (word.load(std::memory_order_acquire) != seen) return;
  if (spin.count() > 0) {
    const auto until = std::chrono::steady_clock::now() + spin;
    do {
      for (int i = 0; i < 32; ++i) {
        if (word.load(std::memory_order_acquire) != seen) return;
        pause();
      }
    } while (std::chrono::steady_clock::now() < until);
  }
  word.wait(seen, std::memory_order_acquire);
}

}  // namespace crashrank::detail

#pragma once

#include <atomic>
#include <cstddef>
#include <system_error>
#include <thread>
#include <vector>

namespace crashrank::detail {

/// Calls body(index, worker) for every index below `count`, from up to `workers` threads of which
/// the calling one is worker 0; returns when all are done. Which worker gets which index varies,
/// so the body writes to its index alone. It must not throw. Where the system refuses a thread, the
/// others do its work.
template <class Body> void for_each_index(std::size_t count, unsigned workers, const Body& body) {
  std::atomic<std::size_t> next{0};
  const auto work = [&](unsigned worker) {
    for (std::size_t i = next.fetch_add(1); i < count; i = next.fetch_add(1)) body(i, worker);
  };
  std::vector<std::thread> threads;
  threads.reserve(workers);
  try {
    for (unsigned worker = 1; worker < workers; ++worker) threads.emplace_back(work, worker);
  } catch (const std::system_error&) {
    // Fewer threads give the same answer.
  }
  work(0);
  for (std::thread& thread : threads) thread.join();
}

}  // namespace crashrank::detail

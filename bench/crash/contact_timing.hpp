#pragma once

#include "bench/timing.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <vector>

namespace bench {

/// Least value that a share of the values does not exceed; 0 of none.
inline double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const auto place =
      static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  return values[std::min(values.size() - 1, place == 0 ? 0 : place - 1)];
}

/// Writes to every line of twice the last-level cache, so that nothing else is left in it.
class CacheFlush {
public:
  CacheFlush() {
    const long last_level = sysconf(_SC_LEVEL3_CACHE_SIZE);
    constexpr std::size_t least = std::size_t{32} << 20U;
    bytes_.resize(2 * std::max(least, last_level > 0 ? static_cast<std::size_t>(last_level) : 0));
  }
  void operator()() {
    constexpr std::size_t line = 64;
    for (std::size_t i = 0; i < bytes_.size(); i += line) ++bytes_[i];
  }
  std::size_t bytes() const { return bytes_.size(); }

private:
  std::vector<unsigned char> bytes_;
};

/// Thread times of contacts, ms.
struct ContactTimes {
  std::vector<double> cold;
  std::vector<double> warm;
};

/// Times one contact: once with cold caches, then the median of `repeats` calls that follow it.
template <class Simulate>
void time_contact(const Simulate& simulate, std::size_t repeats, CacheFlush& flush,
                  ContactTimes& times) {
  const auto timed_ms = [&] {
    const double start = now_s();
    simulate();
    return 1e3 * (now_s() - start);
  };
  flush();
  times.cold.push_back(timed_ms());
  std::vector<double> warm;
  for (std::size_t i = 0; i < repeats; ++i) warm.push_back(timed_ms());
  times.warm.push_back(median(warm));
}

/// {"cold_ms": {"median": ..., "p95": ...}, "warm_ms": ...}
inline void print_json(const ContactTimes& times) {
  std::printf(R"({"cold_ms": {"median": %.4f, "p95": %.4f}, )", quantile(times.cold, 0.5),
              quantile(times.cold, 0.95));
  std::printf(R"("warm_ms": {"median": %.4f, "p95": %.4f}})", quantile(times.warm, 0.5),
              quantile(times.warm, 0.95));
}

}  // namespace bench

#pragma once

#include <cstdint>
#include <random>

namespace oracle {

/// Seeded numbers that are the same with every compiler and library: std::mt19937_64 is specified
/// to the bit, the distributions of <random> are not, so the mapping is written here.
class Random {
public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  std::uint64_t bits() { return engine_(); }
  /// An integer in [low, high].
  std::int64_t integer(std::int64_t low, std::int64_t high) {
    const auto count = static_cast<std::uint64_t>(high - low) + 1;
    return low + static_cast<std::int64_t>(engine_() % count);
  }
  /// A real in [low, high), 53 random bits.
  double real(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11U) * 0x1p-53);
  }
  bool chance(double probability) { return real(0.0, 1.0) < probability; }

private:
  std::mt19937_64 engine_;
};

}  // namespace oracle

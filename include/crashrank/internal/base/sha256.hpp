#pragma once

#include "crashrank/internal/base/export.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace crashrank {

/// SHA-256 (FIPS 180-4), incremental. Used to give answers and model files a fingerprint that means
/// the same on every machine.
class CRASHRANK_API Sha256 {
public:
  /// Adds bytes to the message.
  void update(const void* data, std::size_t bytes) noexcept;
  /// Ends the message and returns the digest; the object is spent afterwards.
  std::array<std::uint8_t, 32> digest() noexcept;

private:
  void compress(const std::uint8_t* block) noexcept;

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::uint8_t, 64> block_{};
  std::size_t filled_ = 0;
  std::uint64_t bytes_ = 0;
};

}  // namespace crashrank

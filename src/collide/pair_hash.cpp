#include "crashrank/collide/pair.hpp"

#include "crashrank/internal/base/sha256.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>

namespace crashrank {
namespace {

std::uint8_t* put(std::uint8_t* to, std::int32_t value) {
  const auto bits = static_cast<std::uint32_t>(value);
  for (unsigned shift = 0; shift < 32; shift += 8) {
    *to++ = static_cast<std::uint8_t>((bits >> shift) & 0xffU);
  }
  return to;
}

}  // namespace

std::string pairs_hash(View<const Pair> sorted) {
  assert(std::is_sorted(sorted.begin(), sorted.end()));
  Sha256 hash;
  std::array<std::uint8_t, 4096> block{};
  std::uint8_t* end = block.data();
  for (const Pair& pair : sorted) {
    end = put(put(end, pair.a), pair.b);
    if (end == block.data() + block.size()) {
      hash.update(block.data(), block.size());
      end = block.data();
    }
  }
  hash.update(block.data(), static_cast<std::size_t>(end - block.data()));
  static constexpr char digits[] = "0123456789abcdef";
  std::string text;
  const std::array<std::uint8_t, 32> digest = hash.digest();
  for (std::size_t i = 0; i < 8; ++i) {
    text += digits[digest[i] >> 4U];
    text += digits[digest[i] & 15U];
  }
  return text;
}

}  // namespace crashrank

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace crashrank::detail {

/// The set bits of every byte, lowest first, unused entries 0.
struct LaneLists {
  alignas(64) std::array<std::array<std::uint8_t, 8>, 256> of{};
};

constexpr LaneLists make_lane_lists() {
  LaneLists lists;
  for (std::size_t byte = 0; byte < 256; ++byte) {
    std::size_t n = 0;
    for (std::size_t bit = 0; bit < 8; ++bit) {
      if ((byte >> bit & 1U) != 0) lists.of[byte][n++] = static_cast<std::uint8_t>(bit);
    }
  }
  return lists;
}

inline constexpr LaneLists lane_lists = make_lane_lists();

}  // namespace crashrank::detail

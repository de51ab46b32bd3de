#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace crashrank::detail {

/// RFC 4648 section 4, padded.
inline std::string base64(const void* data, std::size_t size) {
  constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  std::string text;
  text.reserve((size + 2) / 3 * 4);
  for (std::size_t i = 0; i < size; i += 3) {
    const std::size_t left = size - i;
    const std::uint32_t group = std::uint32_t{bytes[i]} << 16U |
                                (left > 1 ? std::uint32_t{bytes[i + 1]} << 8U : 0U) |
                                (left > 2 ? std::uint32_t{bytes[i + 2]} : 0U);
    text += letters[group >> 18U];
    text += letters[group >> 12U & 63U];
    text += left > 1 ? letters[group >> 6U & 63U] : '=';
    text += left > 2 ? letters[group & 63U] : '=';
  }
  return text;
}

}  // namespace crashrank::detail

#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace crashrank::detail {

struct CodePoint {
  std::uint32_t value = 0;
  std::size_t bytes = 1;  ///< consumed; 1 where the text is not UTF-8
  bool valid = false;
};

/// Decodes the front of a text that is not empty. Overlong forms, surrogates and values past
/// U+10FFFF are not UTF-8 (RFC 3629).
CodePoint decode_utf8(std::string_view text) noexcept;

/// Index of the first byte that is not UTF-8; npos where there is none.
std::size_t first_invalid_utf8(std::string_view text) noexcept;

inline bool is_utf8(std::string_view text) noexcept {
  return first_invalid_utf8(text) == std::string_view::npos;
}

}  // namespace crashrank::detail

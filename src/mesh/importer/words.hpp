#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>

namespace crashrank::importer {

/// The next word of a line, which is taken off; empty at the end.
inline std::string_view take_word(std::string_view& line) {
  constexpr std::string_view blanks = " \t\v\r";
  const std::size_t begin = line.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  line.remove_prefix(begin);
  const std::string_view word = line.substr(0, line.find_first_of(blanks));
  line.remove_prefix(word.size());
  return word;
}

/// The number that the whole word is; nothing if it is no integer.
inline std::optional<std::int64_t> whole_number(std::string_view word) {
  std::int64_t number = 0;
  const char* const end = word.data() + word.size();
  const std::from_chars_result read = std::from_chars(word.data(), end, number);
  if (read.ec != std::errc() || read.ptr != end) return std::nullopt;
  return number;
}

}  // namespace crashrank::importer

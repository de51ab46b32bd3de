#include "numbers.hpp"

#include <charconv>
#include <limits>
#include <system_error>

namespace crashrank::cli {

namespace {

/// What a number rounds to that no double holds: zero or infinity. Such a number has an exponent,
/// or hundreds of digits before its point, or of zeros behind it.
double beyond_double(std::string_view word) {
  const std::size_t exponent = word.find_first_of("eE");
  const std::string_view digits = word.substr(0, exponent);
  const bool small = exponent == std::string_view::npos ? digits.find('.') < 3
                                                        : word.substr(exponent + 1, 1) == "-";
  return small ? 0.0 : std::numeric_limits<double>::infinity();
}

}  // namespace

std::optional<std::vector<double>> parse_numbers(std::string_view line) {
  constexpr std::string_view separators = " \t,\r";
  std::vector<double> numbers;
  while (true) {
    const std::size_t begin = line.find_first_not_of(separators);
    if (begin == std::string_view::npos) return numbers;
    line.remove_prefix(begin);
    std::string_view word = line.substr(0, line.find_first_of(separators));
    line.remove_prefix(word.size());
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    double value = 0.0;
    const std::from_chars_result end =
        std::from_chars(word.data(), word.data() + word.size(), value);
    if (end.ec == std::errc::invalid_argument || end.ptr != word.data() + word.size()) {
      return std::nullopt;
    }
    if (end.ec == std::errc::result_out_of_range) value = beyond_double(word);
    numbers.push_back(value);
  }
}

}  // namespace crashrank::cli

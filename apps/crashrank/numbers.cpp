#include "numbers.hpp"

#include <charconv>
#include <limits>
#include <system_error>

namespace crashrank::cli {

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
    const bool beyond = end.ec == std::errc::result_out_of_range;
    numbers.push_back(beyond ? std::numeric_limits<double>::infinity() : value);
  }
}

}  // namespace crashrank::cli

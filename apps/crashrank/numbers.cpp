#include "numbers.hpp"

#include <charconv>
#include <cstdlib>
#include <string>
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
    if (end.ec == std::errc::result_out_of_range) {
      // Says only that no double holds the number; strtod tells infinity from zero, and the sign.
      // Its locale is the C one: the program sets none.
      value = std::strtod(std::string(word).c_str(), nullptr);
    }
    numbers.push_back(value);
  }
}

CLI::Validator one_number(const std::string& wanted) {
  return {[wanted](const std::string& text) {
            const std::optional<std::vector<double>> numbers = parse_numbers(text);
            const bool one = numbers && numbers->size() == 1 &&
                             text.find_first_of(" \t,\r") == std::string::npos;
            // An option without a value has an error of its own.
            return one || text.empty() ? std::string()
                                       : "'" + text + "' is not a number: give " + wanted;
          },
          "", "one number"};
}

}  // namespace crashrank::cli

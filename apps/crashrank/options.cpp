#include "options.hpp"

#include "numbers.hpp"

#include "base/nearest_word.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace crashrank::cli {
namespace {

class HelpFormatter : public CLI::Formatter {
public:
  std::string make_option_opts(const CLI::Option* option) const override {
    if (option->get_type_size() == 0) return {};
    std::string type = option->get_type_name();
    type.resize(std::min(type.find(':'), type.size()));
    if (type.empty() || option->get_positional()) return repeats(option);
    return " " + type + repeats(option) + (option->get_required() ? " (required)" : "");
  }

private:
  static std::string repeats(const CLI::Option* option) {
    const bool many = option->get_expected_max() == CLI::detail::expected_max_vector_size;
    return many ? " ..." : "";
  }
};

}  // namespace

CLI::Validator count_from(std::uint64_t lowest, std::uint64_t highest) {
  return {[lowest, highest](const std::string& text) {
            constexpr std::size_t most_digits = 18;
            const bool digits = !text.empty() && text.size() <= most_digits &&
                                text.find_first_not_of("0123456789") == std::string::npos &&
                                (text.size() == 1 || text[0] != '0');
            const std::string remedy =
                fmt::format("give a whole number from {} to {}", lowest, highest);
            if (!digits) return "'" + text + "' is no count: " + remedy;
            const std::uint64_t count = std::stoull(text);
            return count >= lowest && count <= highest ? std::string()
                                                       : text + " is out of range: " + remedy;
          },
          "", "count"};
}

CLI::Validator number_from(double lowest, double highest, const std::string& unit) {
  return {[lowest, highest, unit](const std::string& text) {
            // An option without a value has an error of its own.
            if (text.empty()) return std::string();
            const std::string remedy =
                fmt::format("give {} from {:g} to {:g}", unit, lowest, highest);
            const std::optional<std::vector<double>> numbers = parse_numbers(text);
            const bool one = numbers && numbers->size() == 1 && std::isfinite(numbers->front()) &&
                             text.find_first_of(" \t,\r") == std::string::npos;
            if (!one) return "'" + text + "' is not a number: " + remedy;
            const double number = numbers->front();
            return number >= lowest && number <= highest ? std::string()
                                                         : text + " is out of range: " + remedy;
          },
          "", "number"};
}

std::string listed_with_or(const std::vector<std::string>& values) {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == values.size() ? " or " : ", ") + values[i];
  }
  return text;
}

CLI::Validator one_of(const std::vector<std::string>& values) {
  return {[values](const std::string& text) {
            if (text.empty() || std::find(values.begin(), values.end(), text) != values.end()) {
              return std::string();
            }
            const std::string meant = detail::nearest_word(text, values);
            return "'" + text + "' is not known: give " + listed_with_or(values) +
                   (meant.empty() ? "" : "; did you mean '" + meant + "'?");
          },
          "", "choice"};
}

CLI::Option* add_choice(CLI::App& command, const std::string& name, std::string& value,
                        const std::string& what, const std::vector<std::string>& values,
                        const std::string& otherwise) {
  std::string type;
  for (const std::string& one : values) type += (type.empty() ? "" : "|") + one;
  return command
      .add_option(name, value,
                  fmt::format("{} [default {}]", what, otherwise.empty() ? value : otherwise))
      ->check(one_of(values))
      ->type_name(type);
}

CLI::Option* add_file(CLI::App& command, const std::string& name, std::string& value,
                      const std::string& what) {
  return command.add_option(name, value, what)->type_name("FILE");
}

std::shared_ptr<CLI::FormatterBase> help_formatter() { return std::make_shared<HelpFormatter>(); }

}  // namespace crashrank::cli

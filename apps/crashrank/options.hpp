#pragma once

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace crashrank::cli {

// Options as help texts, errors and completion scripts show them. What an option takes stands in
// its type name: "FILE", "FOLDER", or its values with '|' between; anything else is free text.

/// Checks a whole number: digits alone, a 0 not before others, since that would make it octal.
/// Bounds are inclusive, `highest` below 10^18.
CLI::Validator count_from(std::uint64_t lowest, std::uint64_t highest);

/// Checks a finite number; `unit` is what it counts: "milliseconds".
CLI::Validator number_from(double lowest, double highest, const std::string& unit);

/// Checks that it is one of those, and says which was probably meant.
CLI::Validator one_of(const std::vector<std::string>& values);

/// "a, b or c".
std::string listed_with_or(const std::vector<std::string>& values);

/// Adds an option that counts; its value is the default that help shows, `otherwise` in its place
/// where that is not empty.
template <class T>
CLI::Option* add_count(CLI::App& command, const std::string& name, T& value,
                       const std::string& what, std::uint64_t lowest, std::uint64_t highest,
                       const std::string& otherwise = {}) {
  const std::string standard = otherwise.empty() ? std::to_string(value) : otherwise;
  return command
      .add_option(name, value,
                  fmt::format("{} [{} to {}, default {}]", what, lowest, highest, standard))
      ->check(count_from(lowest, highest))
      ->type_name("N");
}

/// Adds an option that takes one of some words. The value is the default, where it is empty
/// `otherwise` says what that comes to.
CLI::Option* add_choice(CLI::App& command, const std::string& name, std::string& value,
                        const std::string& what, const std::vector<std::string>& values,
                        const std::string& otherwise = {});

/// Adds an option, or an argument, that names a file.
CLI::Option* add_file(CLI::App& command, const std::string& name, std::string& value,
                      const std::string& what);

/// How help shows options: their type as it is, without the words of their checks.
std::shared_ptr<CLI::FormatterBase> help_formatter();

}  // namespace crashrank::cli

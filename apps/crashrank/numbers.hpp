#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace crashrank::cli {

/// The numbers of a line, separated by spaces, tabs or commas, whatever the locale; nothing when
/// something else stands among them. Infinity and NaN are numbers here, and what is beyond a double
/// rounds to infinity or 0 with its sign: callers refuse the former.
std::optional<std::vector<double>> parse_numbers(std::string_view line);

/// Checks an option that takes one number; `wanted` are its unit and an example: "kg, such as
/// 1450".
CLI::Validator one_number(const std::string& wanted);

}  // namespace crashrank::cli

#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace crashrank::cli {

/// The numbers of a line, separated by spaces, tabs or commas, whatever the locale; nothing when
/// something else stands among them. Infinity and NaN are numbers here, and what is beyond a double
/// rounds to infinity or 0 with its sign: callers refuse the former.
std::optional<std::vector<double>> parse_numbers(std::string_view line);

}  // namespace crashrank::cli

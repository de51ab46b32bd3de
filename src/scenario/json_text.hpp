#pragma once

#include "crashrank/base/result.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace crashrank::detail {

/// Parses JSON that is not trusted: nothing but standard JSON in UTF-8, no key twice in one object,
/// at most 12 levels deep. Errors name line and column, or the key path.
Result<nlohmann::json> parse_json(const std::string& text);

}  // namespace crashrank::detail

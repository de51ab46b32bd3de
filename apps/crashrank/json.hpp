#pragma once

#include "console.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace crashrank::cli {

/// Keys stay in the order they are written in.
using Json = nlohmann::ordered_json;

/// A document's text. Numbers take the shortest form that reads back to the same bits, NaN and
/// infinity become null; bytes in names that are not UTF-8 become U+FFFD.
inline std::string json_text(const Json& document) {
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

inline void print_json(const Json& document) { print(json_text(document)); }

}  // namespace crashrank::cli

#include "scenario/json_text.hpp"

#include "base/utf8.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>
#include <vector>

namespace crashrank::detail {
namespace {

using nlohmann::json;

constexpr std::size_t max_levels = 12;

/// Leaves the parser from inside its callback; never leaves this file.
struct Refusal {
  Error error;
};

/// Follows the parser to know where it is and to see what a finished value no longer shows: a key
/// that came twice.
class Watcher {
public:
  void see(json::parse_event_t event, const json& parsed) {
    switch (event) {
      case json::parse_event_t::object_start:
      case json::parse_event_t::array_start:
        next_element();
        levels_.push_back({event == json::parse_event_t::array_start, {}, 0, {}});
        if (levels_.size() > max_levels) refuse("nested too deeply", "12 levels are enough");
        break;
      case json::parse_event_t::key:
        levels_.back().key = parsed.get<std::string>();
        if (!levels_.back().keys.insert(levels_.back().key).second) {
          refuse("this key is there twice", "keep one of them");
        }
        break;
      case json::parse_event_t::value:
        next_element();
        break;
      case json::parse_event_t::object_end:
      case json::parse_event_t::array_end:
        levels_.pop_back();
        break;
    }
  }

  /// Path of the value that the parser has in hand and has not shown yet.
  std::string place_in_hand() const {
    std::string path;
    for (const Level& level : levels_) {
      const bool innermost = &level == &levels_.back();
      append(level, level.elements - (innermost || level.elements == 0 ? 0 : 1), path);
    }
    return path;
  }

private:
  struct Level {
    bool array = false;
    std::string key;
    std::size_t elements = 0;
    std::set<std::string> keys;
  };

  void next_element() {
    if (!levels_.empty() && levels_.back().array) ++levels_.back().elements;
  }

  [[noreturn]] void refuse(const char* reason, const char* remedy) const {
    std::string path;
    for (const Level& level : levels_) {
      append(level, level.elements == 0 ? 0 : level.elements - 1, path);
    }
    throw Refusal{{ErrorCode::bad_input, {}, path, reason, remedy}};
  }

  static void append(const Level& level, std::size_t element, std::string& path) {
    if (level.array) {
      path.append("[").append(std::to_string(element)).append("]");
    } else if (!level.key.empty()) {
      path.append(path.empty() ? "" : ".").append(level.key);
    }
  }

  std::vector<Level> levels_;
};

std::string line_and_column(const std::string& text, std::size_t byte) {
  const std::size_t at = std::min(byte == 0 ? 0 : byte - 1, text.size());
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(at);
  const auto line = std::count(text.begin(), end, '\n') + 1;
  const std::size_t start = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
  const std::size_t column = start == std::string::npos ? at + 1 : at - start;
  return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

}  // namespace

Result<json> parse_json(const std::string& text) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    return make_error(ErrorCode::bad_input, "is empty", "give a file in JSON");
  }
  Watcher watcher;
  const auto callback = [&watcher](int, json::parse_event_t event, json& parsed) {
    watcher.see(event, parsed);
    return true;
  };
  try {
    return json::parse(text, callback);
  } catch (const Refusal& refusal) {
    return refusal.error;
  } catch (const json::parse_error& error) {
    if (error.byte <= text.find_first_not_of(" \t\r\n") + 1) {
      return Error{ErrorCode::bad_input,
                   {},
                   line_and_column(text, error.byte),
                   "this is not JSON, which begins with {",
                   "give a JSON file here, not a mesh or a model file"};
    }
    const std::size_t invalid = first_invalid_utf8(text);
    if (invalid < error.byte) {
      return Error{ErrorCode::bad_input,
                   {},
                   line_and_column(text, invalid + 1),
                   "this byte is not UTF-8",
                   "save the text in UTF-8"};
    }
    return Error{ErrorCode::bad_input,
                 {},
                 line_and_column(text, error.byte),
                 error.byte > text.size() ? "the text ends too early" : "this is not JSON",
                 "correct the text there or just before; JSON has neither comments nor trailing "
                 "commas, NaN nor Infinity"};
  } catch (const json::exception&) {
    return Error{ErrorCode::bad_input,
                 {},
                 watcher.place_in_hand(),
                 "this number is larger than a double holds",
                 "write one below 1.8e308; the schema in data/ states each key's range"};
  }
}

}  // namespace crashrank::detail

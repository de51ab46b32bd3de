#include "mesh/importer/obj_fault.hpp"

#include "mesh/importer/content.hpp"
#include "mesh/text.hpp"

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace crashrank::importer {
namespace {

constexpr std::size_t window = 1U << 20U;
constexpr std::size_t longest_line = 1U << 16U;  // what is longer is not looked at

/// Calls `look(line, number)` for each line until it gives an error.
template <class Look> std::optional<Error> first_fault(int descriptor, const Look& look) {
  std::string rest;
  std::size_t number = 0;
  bool skipping = false;
  for (std::size_t offset = 0;; offset += window) {
    const std::string bytes = read_at(descriptor, offset, window);
    const bool last = bytes.size() < window;
    rest += bytes;
    std::size_t begin = 0;
    while (begin < rest.size()) {
      std::size_t end = rest.find('\n', begin);
      if (end == std::string::npos) {
        if (!last) break;
        end = rest.size();
      }
      ++number;
      if (!skipping) {
        std::optional<Error> fault =
            look(std::string_view(rest).substr(begin, end - begin), number);
        if (fault) return fault;
      }
      skipping = false;
      begin = end + 1;
    }
    if (last) return std::nullopt;
    rest.erase(0, begin);
    if (rest.size() > longest_line) {
      rest.clear();
      skipping = true;
    }
  }
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/// The next word, which is taken off; empty at the end.
std::string_view word(std::string_view& line) {
  while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
  std::size_t size = 0;
  while (size < line.size() && !is_blank(line[size])) ++size;
  const std::string_view found = line.substr(0, size);
  line.remove_prefix(size);
  return found;
}

/// Whether the word, or for `whole` what stands before its first slash, is a number.
template <class Number> bool is_number(std::string_view text, Number& value) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const char* const end = text.data() + text.size();
  const std::from_chars_result read = std::from_chars(text.data(), end, value);
  return read.ptr == end && !text.empty() && read.ec != std::errc::invalid_argument;
}

Error at_line(std::size_t number, std::string reason) {
  Error error = make_error(ErrorCode::bad_input, std::move(reason),
                           "mend the line, or export the file again");
  error.place = "line " + std::to_string(number);
  return error;
}

}  // namespace

std::optional<Error> find_obj_fault(int descriptor) {
  std::int64_t vertices = 0;
  bool continued = false;  // lines that go on in the next one are left to the parser
  const auto plain = [&](std::string_view line) {
    const bool before = continued;
    while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
    continued = !line.empty() && line.back() == '\\';
    return !before && !continued;
  };
  std::optional<Error> fault =
      first_fault(descriptor, [&](std::string_view line, std::size_t number) {
        std::optional<Error> none;
        std::string_view rest = line;
        if (!plain(line) || word(rest) != "v") return none;
        ++vertices;
        for (int i = 0; i < 3; ++i) {
          double value = 0.0;
          const std::string_view text = word(rest);
          if (is_number(text, value)) continue;
          return std::optional<Error>(
              at_line(number, text.empty() ? "a vertex has three numbers, this one fewer"
                                           : detail::quoted(text, 40) + " is no number"));
        }
        return none;
      });
  if (fault) return fault;
  std::int64_t defined = 0;
  continued = false;
  return first_fault(descriptor, [&](std::string_view line, std::size_t number) {
    std::optional<Error> none;
    std::string_view rest = line;
    if (!plain(line)) return none;
    const std::string_view kind = word(rest);
    if (kind == "v") ++defined;
    if (kind != "f") return none;
    for (std::string_view corner = word(rest); !corner.empty(); corner = word(rest)) {
      std::int64_t index = 0;
      const std::string_view name = corner.substr(0, corner.find('/'));
      if (!is_number(name, index)) {
        return std::optional<Error>(at_line(number, detail::quoted(corner, 40) + " is no corner"));
      }
      if (index >= 1 ? index <= vertices : index != 0 && -index <= defined) continue;
      return std::optional<Error>(at_line(number, "vertex " + std::string(name) +
                                                      " is out of range: there are " +
                                                      std::to_string(vertices)));
    }
    return none;
  });
}

}  // namespace crashrank::importer

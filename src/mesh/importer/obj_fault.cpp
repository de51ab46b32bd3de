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
constexpr std::size_t longest_line = 1U << 16U;

/// Calls `look(line, number)` for each line until it answers false. False, too, where a line is too
/// long to be looked at.
template <class Look> bool each_line(int descriptor, const Look& look) {
  constexpr std::string_view mark = "\xef\xbb\xbf";
  std::string rest;
  std::size_t number = 0;
  for (std::size_t offset = 0;; offset += window) {
    const std::string bytes = read_at(descriptor, offset, window);
    const bool last = bytes.size() < window;
    rest += bytes;
    std::size_t begin = offset == 0 && rest.compare(0, mark.size(), mark) == 0 ? mark.size() : 0;
    while (begin < rest.size()) {
      std::size_t end = rest.find('\n', begin);
      if (end == std::string::npos) {
        if (!last) break;
        end = rest.size();
      }
      if (!look(std::string_view(rest).substr(begin, end - begin), ++number)) return false;
      begin = end + 1;
    }
    if (last) return true;
    rest.erase(0, begin);
    if (rest.size() > longest_line) return false;
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

/// Whether the whole text is a number; one that no double or integer holds counts as one.
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
  std::optional<Error> bad_vertex;
  const bool plain = each_line(descriptor, [&](std::string_view line, std::size_t number) {
    while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
    if (!line.empty() && line.back() == '\\') return false;  // it goes on in the next one
    if (word(line) != "v") return true;
    ++vertices;
    for (int i = 0; i < 3 && !bad_vertex; ++i) {
      double value = 0.0;
      const std::string_view text = word(line);
      if (is_number(text, value)) continue;
      bad_vertex = at_line(number, text.empty() ? "a vertex has three numbers, this one fewer"
                                                : detail::quoted(text, 40) + " is no number");
    }
    return true;
  });
  if (!plain) return std::nullopt;
  std::int64_t defined = 0;
  std::optional<Error> bad_face;
  each_line(descriptor, [&](std::string_view line, std::size_t number) {
    const std::string_view kind = word(line);
    if (kind == "v") ++defined;
    if (kind != "f") return true;
    for (std::string_view corner = word(line); !corner.empty(); corner = word(line)) {
      std::int64_t index = 0;
      const std::string_view name = corner.substr(0, corner.find('/'));
      if (!is_number(name, index)) {
        bad_face = at_line(number, detail::quoted(corner, 40) + " is no corner");
        return false;
      }
      if (index >= 1 ? index <= vertices : index != 0 && index >= -defined) continue;
      bad_face = at_line(number, "vertex " + detail::quoted(name, 40) +
                                     " is out of range: there are " + std::to_string(vertices));
      return false;
    }
    return true;
  });
  return bad_face ? bad_face : bad_vertex;
}

std::uint64_t obj_face_lines(int descriptor) {
  std::uint64_t faces = 0;
  const bool plain = each_line(descriptor, [&](std::string_view line, std::size_t) {
    if (!line.empty() && line.back() == '\\') return false;
    const std::string_view kind = word(line);
    if (kind == "f" || kind == "F") ++faces;
    return true;
  });
  return plain ? faces : 0;
}

}  // namespace crashrank::importer

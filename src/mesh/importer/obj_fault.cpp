#include "mesh/importer/obj_fault.hpp"

#include "mesh/importer/content.hpp"
#include "mesh/importer/obj_lines.hpp"
#include "mesh/text.hpp"

#include <sys/stat.h>

#include <charconv>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace crashrank::importer {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t'; }

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The next word, which is taken off; empty at the end.
std::string_view word(std::string_view& line) {
  while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
  std::size_t size = 0;
  while (size < line.size() && !is_blank(line[size])) ++size;
  const std::string_view found = line.substr(0, size);
  line.remove_prefix(size);
  return found;
}

/// Whether the whole text is an index; one that no integer holds counts as one.
bool is_index(std::string_view text, std::int64_t& value) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const char* const end = text.data() + text.size();
  const std::from_chars_result read = std::from_chars(text.data(), end, value);
  return read.ptr == end && !text.empty() && read.ec != std::errc::invalid_argument;
}

/// Whether the parser counts the word among a vertex's numbers; it looks at the beginning alone.
bool counts_as_number(std::string_view text) {
  if (is_digit(text.front()) || text.front() == '-' || text.front() == '+') return true;
  std::string begin(text.substr(0, 3));
  for (char& c : begin) c = static_cast<char>(c | 0x20);
  return begin == "nan" || begin == "inf";
}

bool begins_with_point(std::string_view text) {
  return text.size() > 1 && text[0] == '.' && is_digit(text[1]);
}

Error at_line(std::size_t number, std::string reason,
              std::string remedy = "correct the line, or export the file again") {
  Error error = make_error(ErrorCode::bad_input, std::move(reason), std::move(remedy));
  error.place = "line " + std::to_string(number);
  return error;
}

/// The parser counts the numbers of the whole line, takes 3 for x y z, 4 for x y z w and 6 for
/// x y z and a colour, then reads that many words from the left; any other count it passes over.
std::optional<Error> vertex_fault(std::string_view line, std::size_t number) {
  word(line);
  std::size_t counted = 0;
  std::size_t words = 0;
  std::size_t leading = 0;
  std::string_view other;  // the first word that does not count
  std::string_view point;  // the first that would, had it a digit before its point
  for (std::string_view text = word(line); !text.empty(); text = word(line), ++words) {
    if (counts_as_number(text)) {
      ++counted;
      if (other.empty()) ++leading;
    } else {
      if (other.empty()) other = text;
      if (point.empty() && begins_with_point(text)) point = text;
    }
  }
  const bool read = leading == counted && (counted == 3 || counted == 4 || counted == 6);
  if (read && (counted == 3 || point.empty())) return std::nullopt;
  if (!point.empty()) {
    return at_line(number, detail::quoted(point, 40) + " has no digit before its point",
                   "write a zero before it, or export the file again");
  }
  if (leading < 3) {
    return at_line(number, other.empty() ? "a vertex has three numbers, this one fewer"
                                         : detail::quoted(other, 40) + " is no number");
  }
  if (leading < counted) {
    return at_line(
        number,
        "the numbers after " + detail::quoted(other, 40) + " would be taken for the vertex's",
        "take them away, or export the file again");
  }
  return at_line(number, "a vertex has 3, 4 or 6 numbers, this line " + std::to_string(counted));
}

std::size_t corners_of(std::string_view face) {
  word(face);
  std::size_t corners = 0;
  while (!word(face).empty()) ++corners;
  return corners;
}

bool ends_in_newline(int descriptor) {
  struct stat file = {};
  if (::fstat(descriptor, &file) != 0 || file.st_size == 0) return true;
  const std::string last = read_at(descriptor, static_cast<std::size_t>(file.st_size) - 1, 1);
  return last == "\n" || last == "\r";
}

/// Whether the parser is where it passes over all lines up to one that says `end`.
bool in_section(bool inside, std::string_view line) {
  return inside ? word(line) != "end" : word(line) == "cstype";
}

}  // namespace

Result<std::uint64_t> check_obj_lines(int descriptor) {
  ObjStatements statements(descriptor);
  std::uint64_t faces = 0;
  std::size_t section = 0;   // the line of the cstype whose end has not come yet
  std::size_t cut_face = 0;  // the last line, if it is a face with too few corners
  for (ObjStatement statement; statements.next(statement);) {
    const std::string_view text = statement.text;
    if (statement.swallows > 0) {
      return at_line(
          statement.swallows,
          "the vertex or face is lost: a line before it ends in a backslash, which joins "
          "the two (line " +
              std::to_string(statement.number) + ")",
          "take that backslash away");
    }
    if (means(text, 'f')) ++faces;
    cut_face = means(text, 'f') && corners_of(text) < 3 ? statement.number : 0;
    if (means(text, 'v')) {
      if (section > 0) {
        return at_line(statement.number,
                       "the vertex is lost: it stands between cstype (line " +
                           std::to_string(section) + ") and end",
                       "move it before the cstype");
      }
      if (text.size() > 1 && (text[0] != 'v' || !is_blank(text[1]))) {
        return at_line(statement.number, "the vertex is lost: its line does not begin with 'v '",
                       "begin it with a small v and a blank");
      }
      if (std::optional<Error> fault = vertex_fault(text, statement.number)) return *fault;
    }
    if (!text.empty() && (text[0] == 'c' || text[0] == 'e')) {
      if (!in_section(section > 0, text)) {
        section = 0;
      } else if (section == 0) {
        section = statement.number;
      }
    }
  }
  if (cut_face > 0 && !ends_in_newline(descriptor)) {
    return at_line(cut_face, "the file ends within a face: it was cut", "export or copy it again");
  }
  return faces;
}

std::optional<Error> find_obj_fault(int descriptor) {
  std::int64_t vertices = 0;
  ObjStatements once(descriptor);
  for (ObjStatement statement; once.next(statement);) {
    if (!statement.whole) return std::nullopt;
    if (word(statement.text) == "v") ++vertices;
  }
  std::int64_t defined = 0;
  ObjStatements again(descriptor);
  for (ObjStatement statement; again.next(statement);) {
    const std::string_view kind = word(statement.text);
    if (kind == "v") ++defined;
    if (kind != "f") continue;
    for (std::string_view corner = word(statement.text); !corner.empty();
         corner = word(statement.text)) {
      std::int64_t index = 0;
      const std::string_view name = corner.substr(0, corner.find('/'));
      if (!is_index(name, index)) {
        return at_line(statement.number, detail::quoted(corner, 40) + " is no corner");
      }
      if (index >= 1 ? index <= vertices : index != 0 && index >= -defined) continue;
      return at_line(statement.number, "vertex " + detail::quoted(name, 40) +
                                           " is out of range: there are " +
                                           std::to_string(vertices));
    }
  }
  return std::nullopt;
}

}  // namespace crashrank::importer

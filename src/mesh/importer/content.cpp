#include "mesh/importer/content.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

namespace crashrank::importer {
namespace {

using namespace std::string_view_literals;

constexpr std::size_t head_bytes = 4096;
constexpr std::string_view utf8_mark = "\xef\xbb\xbf"sv;

Error refuse(std::string reason, std::string remedy) {
  return make_error(ErrorCode::bad_input, std::move(reason), std::move(remedy));
}

bool is_archive(std::string_view head) {
  constexpr std::array marks{"PK\x03\x04"sv,
                             "PK\x05\x06"sv,
                             "\x1f\x8b"sv,
                             "BZh"sv,
                             "\xfd"
                             "7zXZ\0"sv,
                             "\x28\xb5\x2f\xfd"sv,
                             "7z\xbc\xaf\x27"sv,
                             "Rar!"sv};
  return std::any_of(marks.begin(), marks.end(),
                     [&](std::string_view mark) { return head.substr(0, mark.size()) == mark; });
}

bool is_utf16(std::string_view head) {
  return head.substr(0, 2) == "\xfe\xff"sv || head.substr(0, 2) == "\xff\xfe"sv;
}

// The value of meter in <unit ... meter="VALUE" ...>; 1 if there is none.
double unit_in_metres(std::string_view tag) {
  const std::size_t name = tag.find("meter=");
  if (name == std::string_view::npos || name + 7 >= tag.size()) return 1.0;
  const char quote = tag[name + 6];
  tag.remove_prefix(name + 7);
  tag = tag.substr(0, tag.find(quote));
  while (!tag.empty() && (tag.front() == ' ' || tag.front() == '+')) tag.remove_prefix(1);
  // Exporters in some countries write "0,01", and the parser takes the comma for a point.
  std::string number(tag);
  std::replace(number.begin(), number.end(), ',', '.');
  double metres = 0.0;
  const auto result = std::from_chars(number.data(), number.data() + number.size(), metres);
  return result.ec == std::errc() ? metres : std::nan("");
}

// Goes through the whole file in overlapping windows. Zero bytes are left out, which turns UTF-16
// into the characters that matter here.
Result<Content> look_at_collada(int descriptor, Content content) {
  constexpr std::size_t window = 1 << 20;
  constexpr std::size_t overlap = 1024;
  for (std::size_t offset = 0;; offset += window - overlap) {
    const std::string bytes = read_at(descriptor, offset, window);
    if (bytes.find("PK\x05\x06"sv) != std::string::npos) {
      return refuse("there is an archive in the file", "unpack it");
    }
    std::string text = bytes;
    text.erase(std::remove(text.begin(), text.end(), '\0'), text.end());
    if (text.find("<!ENTITY") != std::string::npos) {
      return refuse("the file declares XML entities", "export it without a document type");
    }
    // A transform that is valid, and at which the parser ends the process.
    if (text.find("<skew>") != std::string::npos || text.find("<skew ") != std::string::npos) {
      Error error =
          refuse("the transform <skew> is not supported", "export it with transforms as matrices");
      error.place = "<node>";
      return error;
    }
    for (std::size_t at = text.find("<unit "); at != std::string::npos;
         at = text.find("<unit ", at + 1)) {
      const std::size_t end = text.find('>', at);
      if (end == std::string::npos || end - at > overlap) continue;
      const double metres = unit_in_metres(std::string_view(text).substr(at, end - at));
      if (!(metres > 0.0) || !std::isfinite(metres)) {
        Error error = refuse("the unit is not a positive length", "correct the attribute meter");
        error.place = "<unit>";
        return error;
      }
    }
    if (bytes.size() < window) return content;
  }
}

Result<Content> look_at_head(std::string_view head, const std::string& extension, Content content) {
  const bool binary = head.find('\0') != std::string_view::npos;
  head.remove_prefix(content.skip);
  if (extension == "obj" && is_utf16(head)) {
    return refuse("the text is UTF-16, marked by its byte order mark", "save it as UTF-8");
  }
  if ((extension == "obj" || extension == "off") && binary) {
    return refuse("the file is binary, not text", "export it as text");
  }
  if (extension == "ply" && head.substr(0, 3) != "ply") {
    return refuse("it does not begin with 'ply'", "name the file after its format");
  }
  if (extension == "3ds" && head.substr(0, 2) != "\x4d\x4d"sv &&
      head.substr(0, 2) != "\xc2\x3d"sv) {
    return refuse("it does not begin with the mark of 3DS", "name the file after its format");
  }
  if (extension == "glb" && head.substr(0, 4) != "glTF") {
    return refuse("it does not begin with 'glTF'", "name the file after its format");
  }
  return content;
}

}  // namespace

std::string read_at(int descriptor, std::size_t offset, std::size_t size) {
  std::string text(size, '\0');
  std::size_t done = 0;
  while (done < size) {
    const ssize_t got =
        ::pread(descriptor, text.data() + done, size - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    done += static_cast<std::size_t>(got);
  }
  text.resize(done);
  return text;
}

Result<Content> look_at(int descriptor, const std::string& extension) {
  const std::string head = read_at(descriptor, 0, head_bytes);
  if (is_archive(head)) return refuse("the file is a compressed archive", "unpack it");
  Content content;
  // A binary STL may begin with any 80 bytes, these among them.
  const bool marked = std::string_view(head).substr(0, utf8_mark.size()) == utf8_mark;
  if (marked && (extension != "stl" || head.compare(utf8_mark.size(), 5, "solid") == 0)) {
    content.skip = utf8_mark.size();
    if (head.size() == content.skip) return refuse("the file is empty", "export it again");
  }
  if (extension == "dae") return look_at_collada(descriptor, content);
  return look_at_head(head, extension, content);
}

}  // namespace crashrank::importer

#include "crashrank/internal/report/escape.hpp"

#include "base/utf8.hpp"

#include <fmt/format.h>

#include <string_view>

namespace crashrank {
namespace {

bool is_control(std::uint32_t c) { return c < 0x20 || (c >= 0x7f && c < 0xa0); }

// Bidirectional controls, line and paragraph separators, zero-width characters and the byte order
// mark: invisible, and able to make one name look like another.
bool is_deceptive(std::uint32_t c) {
  return (c >= 0x200b && c <= 0x200f) || (c >= 0x2028 && c <= 0x202e) ||
         (c >= 0x2060 && c <= 0x206f) || c == 0x061c || c == 0xfeff;
}

std::string named_text(std::uint32_t c) { return fmt::format("\\u{{{:04x}}}", c); }

// What XML 1.0 section 2.2 calls Char, less the C1 controls it discourages.
bool is_xml_char(std::uint32_t c) {
  if (c == '\t' || c == '\n' || c == '\r') return true;
  return !is_control(c) && c != 0xfffe && c != 0xffff;
}

/// Calls `visit(code point, its bytes)` along the text.
template <class Visit> void each(std::string_view text, Visit visit) {
  while (!text.empty()) {
    const detail::CodePoint c = detail::decode_utf8(text);
    visit(c, text.substr(0, c.bytes));
    text.remove_prefix(c.bytes);
  }
}

}  // namespace

std::string escape_terminal(const std::string& text) {
  std::string out;
  each(text, [&](const detail::CodePoint& c, std::string_view bytes) {
    if (!c.valid || (is_control(c.value) && c.value < 0x80)) {
      out += fmt::format("\\x{:02x}", c.value);
    } else if (is_control(c.value) || is_deceptive(c.value)) {
      out += named_text(c.value);
    } else {
      out += bytes;
    }
  });
  return out;
}

std::string escape_xml(const std::string& text) {
  std::string out;
  each(text, [&](const detail::CodePoint& c, std::string_view bytes) {
    if (!c.valid || !is_xml_char(c.value)) {
      out += "\xef\xbf\xbd";
      return;
    }
    if (is_deceptive(c.value)) {
      out += named_text(c.value);
      return;
    }
    switch (c.value) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += bytes;
    }
  });
  return out;
}

std::string escape_file_name(const std::string& text) {
  constexpr std::size_t longest = 80;
  std::string out;
  for (const char c : text) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    const bool kept = letter || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
    out += kept ? c : '_';
    if (out.size() == longest) break;
  }
  if (out.empty()) return "_";
  if (out.front() == '.') out.front() = '_';
  return out;
}

std::size_t display_width(const std::string& text) {
  std::size_t width = 0;
  each(text, [&](const detail::CodePoint&, std::string_view) { ++width; });
  return width;
}

}  // namespace crashrank

#include "mesh/importer/obj_lines.hpp"

#include "mesh/importer/content.hpp"

#include <algorithm>

namespace crashrank::importer {
namespace {

constexpr std::size_t window = 1U << 20U;
constexpr std::size_t longest = 1U << 16U;
constexpr std::size_t ending = 3;  // a backslash, a carriage return and a line feed

bool ends_line(char c) { return c == '\n' || c == '\r' || c == '\f' || c == '\0'; }

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

bool goes_on(const ObjLine& line) { return !line.text.empty() && line.text.back() == '\\'; }

}  // namespace

bool ObjLines::refill() {
  if (last_) return false;
  buffer_.erase(0, begin_);
  begin_ = 0;
  if (buffer_.size() > longest + ending) {
    buffer_.erase(longest, buffer_.size() - longest - ending);
    whole_ = false;
  }
  const std::string bytes = read_at(descriptor_, offset_, window);
  constexpr std::string_view mark = "\xef\xbb\xbf";
  if (offset_ == 0 && bytes.compare(0, mark.size(), mark) == 0) begin_ = mark.size();
  last_ = bytes.size() < window;
  offset_ += bytes.size();
  buffer_ += bytes;
  return true;
}

bool ObjLines::next(ObjLine& line) {
  std::size_t end = 0;
  do {
    const auto found = std::find_if(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_),
                                    buffer_.end(), ends_line);
    end = static_cast<std::size_t>(found - buffer_.begin());
    // A carriage return at the end of the window may have its line feed in the next one.
  } while (end + 1 >= buffer_.size() && refill());
  if (begin_ >= buffer_.size()) return false;
  const bool ended = end < buffer_.size();
  const bool pair = ended && buffer_.compare(end, 2, "\r\n") == 0;
  line.text = std::string_view(buffer_).substr(begin_, end - begin_);
  line.number = number_;
  line.whole = whole_;
  line.ends_in_crlf = pair;
  line.ends_in_lf = pair || (ended && buffer_[end] == '\n');
  if (line.ends_in_lf || (ended && buffer_[end] == '\r')) ++number_;
  begin_ = end + (pair ? 2 : 1);
  whole_ = true;
  return true;
}

bool ObjStatements::next(ObjStatement& statement) {
  ObjLine line;
  if (!lines_.next(line)) return false;
  statement = {line.text, line.number, line.whole, 0};
  if (!goes_on(line)) return true;
  joined_ = line.text.substr(0, line.text.size() - 1);
  // After a backslash the parser looks for a line feed, and loses what stands before it; it copies
  // the first byte of the line that follows without a look, so that an empty one ends nothing.
  bool unlooked = true;
  bool cut = false;
  for (bool open = true; open;) {
    const bool lost = !line.ends_in_lf;
    if (!lines_.next(line)) break;
    if (statement.swallows == 0 && (means(line.text, 'v') || means(line.text, 'f'))) {
      statement.swallows = line.number;
    }
    if (lost) continue;
    const bool more = goes_on(line);
    if (!cut) joined_ += line.text.substr(0, line.text.size() - (more ? 1 : 0));
    const bool unseen_end = unlooked && line.text.empty() && !line.ends_in_crlf;
    cut = cut || unseen_end || joined_.size() > longest;
    statement.whole = statement.whole && line.whole && joined_.size() <= longest;
    open = more || unseen_end;
    unlooked = more;
  }
  statement.text = joined_;
  return true;
}

bool means(std::string_view line, char letter) {
  const auto shows = [](char c) { return c > ' ' && c < '\x7f'; };
  const auto first = std::find_if(line.begin(), line.end(), shows);
  if (first == line.end() || (*first != letter && *first != letter - 'a' + 'A')) return false;
  return first + 1 == line.end() || !is_letter(first[1]);
}

}  // namespace crashrank::importer

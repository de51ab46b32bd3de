#include "mesh/importer/ply_check.hpp"

#include "mesh/importer/content.hpp"
#include "mesh/importer/words.hpp"
#include "mesh/text.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace crashrank::importer {
namespace {

/// A number, or a list with its own number of items before it.
struct Property {
  std::uint64_t bytes = 0;        ///< of the number, or of an item of the list
  std::uint64_t count_bytes = 0;  ///< of the number of items; 0: no list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  enum class Format { text, little, big };
  Format format = Format::text;
  std::vector<Element> elements;
  std::uint64_t end = 0;  ///< offset of the first element
};

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
    words.push_back(word);
  }
  return words;
}

std::optional<std::uint64_t> count_of(std::string_view word) {
  const std::optional<std::int64_t> number = whole_number(word);
  if (!number || *number < 0) return std::nullopt;
  return static_cast<std::uint64_t>(*number);
}

/// Bytes of a number of that type; 0: no type.
std::uint64_t bytes_of(std::string_view type) {
  constexpr std::array<std::pair<std::string_view, std::uint64_t>, 16> types{{{"char", 1},
                                                                              {"int8", 1},
                                                                              {"uchar", 1},
                                                                              {"uint8", 1},
                                                                              {"short", 2},
                                                                              {"int16", 2},
                                                                              {"ushort", 2},
                                                                              {"uint16", 2},
                                                                              {"int", 4},
                                                                              {"int32", 4},
                                                                              {"uint", 4},
                                                                              {"uint32", 4},
                                                                              {"float", 4},
                                                                              {"float32", 4},
                                                                              {"double", 8},
                                                                              {"float64", 8}}};
  for (const auto& [name, bytes] : types) {
    if (name == type) return bytes;
  }
  return 0;
}

/// Takes a line of the header; returns false if it cannot be read.
bool take_line(const std::vector<std::string_view>& words, Header& header) {
  if (words.empty()) return true;
  if (words[0] == "format" && words.size() >= 2) {
    if (words[1] == "binary_little_endian") header.format = Header::Format::little;
    if (words[1] == "binary_big_endian") header.format = Header::Format::big;
  } else if (words[0] == "element") {
    const std::optional<std::uint64_t> count =
        words.size() == 3 ? count_of(words[2]) : std::optional<std::uint64_t>();
    if (!count) return false;
    header.elements.push_back({std::string(words[1]), *count, {}});
  } else if (words[0] == "property") {
    const bool is_list = words.size() == 5 && words[1] == "list";
    if (header.elements.empty() || (!is_list && words.size() != 3)) return false;
    Property property;
    property.bytes = bytes_of(words[is_list ? 3 : 1]);
    if (is_list) property.count_bytes = bytes_of(words[2]);
    if (property.bytes == 0 || (is_list && property.count_bytes == 0)) return false;
    header.elements.back().properties.push_back(property);
  }
  return true;
}

/// The header; nothing if it cannot be read or is longer than any.
std::optional<Header> read_header(int descriptor) {
  constexpr std::size_t longest = std::size_t{1} << 16U;
  const std::string text = read_at(descriptor, 0, longest);
  Header header;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string::npos) return std::nullopt;
    const std::vector<std::string_view> words =
        words_of(std::string_view(text).substr(begin, end - begin));
    begin = end + 1;
    if (!words.empty() && words[0] == "end_header") {
      header.end = begin;
      return header;
    }
    if (!take_line(words, header)) return std::nullopt;
  }
  return std::nullopt;
}

/// The fault of a header in the order of its elements; nothing if there is none.
std::optional<Error> order_fault(const Header& header) {
  constexpr const char* remedy = "export vertices and faces alone";
  bool has_vertices = false;
  for (const Element& element : header.elements) {
    if (element.count == 0) continue;
    const std::string named = "element " + detail::quoted(element.name, 40);
    if (element.properties.empty()) {
      return make_error(ErrorCode::bad_input, named + " has no properties", remedy);
    }
    const bool is_known = header.format == Header::Format::text && element.name == "material";
    if (!has_vertices && element.name != "vertex" && !is_known) {
      return make_error(ErrorCode::bad_input,
                        named + " stands before the vertices, where it cannot be read", remedy);
    }
    if (element.name == "face") return std::nullopt;
    has_vertices = has_vertices || element.name == "vertex";
    const bool has_lists =
        std::any_of(element.properties.begin(), element.properties.end(),
                    [](const Property& property) { return property.count_bytes > 0; });
    if (has_lists && element.name != "vertex") {
      return make_error(ErrorCode::bad_input,
                        named + " has lists before the faces, where they cannot be read", remedy);
    }
  }
  return std::nullopt;
}

/// Bytes of a file from an offset on, read a window at a time.
class Bytes {
public:
  Bytes(int descriptor, std::uint64_t offset) : descriptor_(descriptor), offset_(offset) {}

  /// The next byte; nothing at the end.
  std::optional<unsigned char> next() {
    if (place_ == window_.size()) {
      offset_ += window_.size();
      window_ = read_at(descriptor_, offset_, window_bytes);
      place_ = 0;
      if (window_.empty()) return std::nullopt;
    }
    return static_cast<unsigned char>(window_[place_++]);
  }
  /// Passes over bytes of a file that has `size`; returns false if it ends before.
  bool skip(std::uint64_t count, std::uint64_t size) {
    const std::uint64_t here = offset_ + place_;
    if (count > size - std::min(here, size)) return false;
    if (count <= window_.size() - place_) {
      place_ += count;
    } else {
      offset_ = here + count;
      window_.clear();
      place_ = 0;
    }
    return true;
  }

private:
  static constexpr std::size_t window_bytes = std::size_t{1} << 16U;
  int descriptor_;
  std::uint64_t offset_;  ///< of the window
  std::string window_;
  std::size_t place_ = 0;
};

/// Result of reading one element.
enum class Read { whole, ended, unknown };

Read read_binary(const Element& element, bool big, std::uint64_t size, Bytes& bytes) {
  for (const Property& property : element.properties) {
    std::uint64_t items = 1;
    if (property.count_bytes > 0) {
      items = 0;
      for (std::uint64_t i = 0; i < property.count_bytes; ++i) {
        const std::optional<unsigned char> byte = bytes.next();
        if (!byte) return Read::ended;
        items = big ? (items << 8U) | *byte : items | (std::uint64_t{*byte} << (8U * i));
      }
      // A count that is no integer or negative.
      if (property.count_bytes == 8 || items > size) return Read::unknown;
    }
    if (!bytes.skip(items * property.bytes, size)) return Read::ended;
  }
  return Read::whole;
}

/// The next word of the text; returns false at the end of the file.
bool next_word(Bytes& bytes, std::string& word) {
  word.clear();
  for (;;) {
    const std::optional<unsigned char> byte = bytes.next();
    const bool blank = !byte || is_space(static_cast<char>(*byte));
    if (blank && (!word.empty() || !byte)) return !word.empty();
    constexpr std::size_t longest = 64;
    if (!blank && word.size() < longest) word.push_back(static_cast<char>(*byte));
  }
}

Read read_text(const Element& element, Bytes& bytes, std::string& word) {
  for (const Property& property : element.properties) {
    if (!next_word(bytes, word)) return Read::ended;
    if (property.count_bytes == 0) continue;
    const std::optional<std::uint64_t> items = count_of(word);
    if (!items) return Read::unknown;
    for (std::uint64_t i = 0; i < *items; ++i) {
      if (!next_word(bytes, word)) return Read::ended;
    }
  }
  return Read::whole;
}

Error cut_after(const Element& element, std::uint64_t whole) {
  const std::string things = element.name == "vertex" ? "vertices"
                             : element.name == "face"
                                 ? "faces"
                                 : "elements " + detail::quoted(element.name, 40);
  return make_error(ErrorCode::bad_input,
                    "it ends after " + std::to_string(whole) + " of the " +
                        std::to_string(element.count) + " " + things + " that its header promises",
                    "the file was cut; export or copy it again");
}

}  // namespace

Status check_ply(int descriptor) {
  const std::optional<Header> header = read_header(descriptor);
  struct stat file = {};
  if (!header || ::fstat(descriptor, &file) != 0) return Success{};
  if (std::optional<Error> fault = order_fault(*header)) return *fault;
  const auto size = static_cast<std::uint64_t>(file.st_size);
  Bytes bytes(descriptor, header->end);
  std::string word;
  for (const Element& element : header->elements) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      const Read read =
          header->format == Header::Format::text
              ? read_text(element, bytes, word)
              : read_binary(element, header->format == Header::Format::big, size, bytes);
      if (read == Read::ended) return cut_after(element, i);
      if (read == Read::unknown && header->format == Header::Format::text) {
        return make_error(ErrorCode::bad_input,
                          detail::quoted(element.name, 40) + " " + std::to_string(i) + " has " +
                              detail::quoted(word, 40) + " where the length of a list stands",
                          "correct it, or export the file again");
      }
      if (read == Read::unknown) return Success{};
    }
  }
  return Success{};
}

}  // namespace crashrank::importer

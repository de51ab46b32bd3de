#include "mesh/importer/text_checks.hpp"

#include "mesh/importer/content.hpp"
#include "mesh/importer/obj_lines.hpp"
#include "mesh/importer/words.hpp"
#include "mesh/text.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <optional>
#include <string_view>

namespace crashrank::importer {
namespace {

/// The lines that hold something: without comments and blank ones.
class FilledLines {
public:
  explicit FilledLines(int descriptor) : lines_(descriptor) {}

  bool next(ObjLine& line) {
    while (lines_.next(line)) {
      line.text = line.text.substr(0, line.text.find('#'));
      std::string_view rest = line.text;
      if (!take_word(rest).empty()) return true;
    }
    return false;
  }

private:
  ObjLines lines_;
};

Error cut_off(std::int64_t found, std::int64_t promised, const char* things) {
  return make_error(ErrorCode::bad_input,
                    "it ends after " + std::to_string(found) + " of the " +
                        std::to_string(promised) + " " + things + " that its header promises",
                    "the file was cut; export or copy it again");
}

Error bad_face(std::size_t line, std::int64_t face, const std::string& fault) {
  Error error = make_error(
      ErrorCode::bad_input, "face " + std::to_string(face) + " " + fault,
      "correct the line (faces and vertices are numbered from 0), or export the file again");
  error.place = "line " + std::to_string(line);
  return error;
}

/// Words of a facet that has begun, whatever their case.
bool is_word(std::string_view word, std::string_view wanted) {
  return word.size() == wanted.size() && std::equal(word.begin(), word.end(), wanted.begin(),
                                                    [](char a, char b) { return (a | 0x20) == b; });
}

/// Whether it begins as text does and is not as long as a binary file of its own number of facets.
bool is_stl_text(int descriptor) {
  constexpr std::size_t header = 80;
  std::string head = read_at(descriptor, 0, header + 4);
  std::string_view begin = head;
  if (begin.substr(0, 3) == "\xef\xbb\xbf") begin.remove_prefix(3);
  if (!is_word(take_word(begin).substr(0, 5), "solid")) return false;
  if (head.size() < header + 4) return true;
  std::uint32_t facets = 0;
  std::memcpy(&facets, head.data() + header, sizeof facets);
  const std::size_t end = header + 4 + std::size_t{50} * facets;
  return read_at(descriptor, end - 1, 2).size() != 1;
}

}  // namespace

Result<std::uint64_t> check_off_lines(int descriptor) {
  FilledLines lines(descriptor);
  ObjLine line;
  if (!lines.next(line)) return std::uint64_t{0};
  std::string_view counts = line.text;
  const std::string_view keyword = take_word(counts);
  // Vertices of OFF and its kin COFF, NOFF, STOFF; those of 4OFF and nOFF have other numbers.
  if (keyword.size() < 3 || keyword.substr(keyword.size() - 3) != "OFF") return std::uint64_t{0};
  if (keyword.find_first_of("4n") != std::string_view::npos) return std::uint64_t{0};
  if (counts.find_first_not_of(" \t\v") == std::string_view::npos) {
    if (!lines.next(line)) return std::uint64_t{0};
    counts = line.text;
  }
  const std::optional<std::int64_t> vertices = whole_number(take_word(counts));
  const std::optional<std::int64_t> faces = whole_number(take_word(counts));
  if (!vertices || !faces || *vertices < 0 || *faces < 0) return std::uint64_t{0};
  for (std::int64_t i = 0; i < *vertices; ++i) {
    if (!lines.next(line)) return cut_off(i, *vertices, "vertices");
  }
  std::uint64_t surfaces = 0;
  for (std::int64_t i = 0; i < *faces; ++i) {
    if (!lines.next(line)) return cut_off(i, *faces, "faces");
    std::string_view rest = line.text;
    const std::optional<std::int64_t> corners = whole_number(take_word(rest));
    if (!corners) return std::uint64_t{0};
    if (*corners >= 3) ++surfaces;
    for (std::int64_t k = 0; k < *corners; ++k) {
      const std::string_view word = take_word(rest);
      if (word.empty() && line.whole) {
        return bad_face(
            line.number, i,
            "has " + std::to_string(k) + " of its " + std::to_string(*corners) + " corners");
      }
      const std::optional<std::int64_t> index = whole_number(word);
      if (index && *index >= 0 && *index < *vertices) continue;
      if (!line.whole) break;  // the middle of a very long line is not here
      return bad_face(line.number, i,
                      "names vertex " + detail::quoted(word, 40) + ", but there are " +
                          std::to_string(*vertices));
    }
  }
  return surfaces;
}

Status check_ac3d_places(int descriptor) {
  ObjLines lines(descriptor);
  std::string name;
  bool has_vertices = false;
  bool moved = false;
  bool turned = false;
  std::int64_t materials = 0;
  for (ObjLine line; lines.next(line);) {
    std::string_view rest = line.text;
    const std::string_view word = take_word(rest);
    const auto differs = [&rest](std::initializer_list<double> usual) {
      return std::any_of(usual.begin(), usual.end(), [&rest](double wanted) {
        const std::string_view text = take_word(rest);
        double number = wanted;
        std::from_chars(text.data(), text.data() + text.size(), number);
        return number != wanted;
      });
    };
    if (word == "MATERIAL") {
      ++materials;
    } else if (word == "mat") {
      const std::int64_t material = whole_number(take_word(rest)).value_or(0);
      if (material < std::max<std::int64_t>(materials, 1)) continue;
      Error error = make_error(ErrorCode::bad_input,
                               "there is no material " + std::to_string(material) +
                                   ", and the parser leaves out surfaces without one",
                               "give the surface a material of the file (numbered from 0)");
      error.place = "line " + std::to_string(line.number);
      return error;
    } else if (word == "OBJECT") {
      has_vertices = moved = turned = false;
      name.clear();
    } else if (word == "name") {
      name = take_word(rest);
    } else if (word == "loc") {
      moved = differs({0, 0, 0});
    } else if (word == "rot") {
      turned = differs({1, 0, 0, 0, 1, 0, 0, 0, 1});
    } else if (word == "numvert") {
      has_vertices = whole_number(take_word(rest)).value_or(0) > 0;
    } else if (word == "kids" && has_vertices && moved &&
               (turned || whole_number(take_word(rest)).value_or(0) > 0)) {
      Error error = make_error(ErrorCode::bad_input,
                               "object " + detail::quoted(name, 40) + " has vertices, loc and " +
                                   (turned ? "rot" : "kids") + ", which the parser misplaces",
                               "export it with objects at the origin, or moved by groups");
      error.place = "line " + std::to_string(line.number);
      return error;
    }
  }
  return Success{};
}

std::string describe_binary_stl(int descriptor) {
  // 80 bytes of any content, the number of triangles, 50 bytes for each.
  constexpr std::size_t counted_at = 80;
  constexpr std::size_t header_bytes = 84;
  constexpr std::uint64_t triangle_bytes = 50;
  struct stat file = {};
  if (::fstat(descriptor, &file) != 0) return {};
  const std::string number = read_at(descriptor, counted_at, header_bytes - counted_at);
  if (number.size() < header_bytes - counted_at) {
    return "a binary one begins with 84 bytes, and it has " + std::to_string(file.st_size);
  }
  std::uint64_t triangles = 0;
  for (std::size_t i = number.size(); i > 0; --i) {
    triangles = 256 * triangles + static_cast<unsigned char>(number[i - 1]);
  }
  return "as a binary one its header promises " + std::to_string(triangles) + " triangles, " +
         std::to_string(header_bytes + triangle_bytes * triangles) + " bytes in all, and it has " +
         std::to_string(file.st_size);
}

std::string describe_stl_cut(int descriptor) {
  if (!is_stl_text(descriptor)) return {};
  ObjLines lines(descriptor);
  bool in_facet = false;
  bool in_solid = false;
  std::size_t facets = 0;
  for (ObjLine line; lines.next(line);) {
    const std::string_view first = take_word(line.text);
    if (is_word(first, "solid")) in_solid = true;
    if (is_word(first, "endsolid")) in_solid = false;
    if (is_word(first, "endfacet")) in_facet = false;
    if (!is_word(first, "facet")) continue;
    in_facet = true;
    ++facets;
  }
  if (in_facet) {
    return "the text ends within facet " + std::to_string(facets) +
           ": the file was cut, and the surface lacks what came after";
  }
  if (!in_solid) return {};
  return "the text ends without endsolid: it may have been cut after facet " +
         std::to_string(facets);
}

}  // namespace crashrank::importer

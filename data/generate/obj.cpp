#include "obj.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace generate {
namespace {

constexpr double steps_per_metre = 10000.0;

using Place = std::array<std::int64_t, 3>;

struct PlaceHash {
  std::size_t operator()(const Place& p) const {
    return static_cast<std::size_t>(p[0] * 73856093 ^ p[1] * 19349663 ^ p[2] * 83492791);
  }
};

Place rounded(const Vec3& p) {
  Place place{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double tenths = p[static_cast<int>(k)] * steps_per_metre;
    place[k] = static_cast<std::int64_t>(std::floor(tenths + 0.5));
  }
  return place;
}

void append_number(std::int64_t value, std::string* text) {
  if (value < 0) *text += '-';
  const std::int64_t size = value < 0 ? -value : value;
  *text += std::to_string(size / 10000);
  std::int64_t rest = size % 10000;
  if (rest == 0) return;
  *text += '.';
  for (std::int64_t digit = 1000; rest != 0; digit /= 10) {
    *text += static_cast<char>('0' + rest / digit);
    rest %= digit;
  }
}

}  // namespace

std::string to_obj(const Model& model, const std::string& about) {
  std::string text = "# " + about + "\n";
  std::unordered_map<Place, std::size_t, PlaceHash> number;
  for (const NamedMesh& part : model.parts) {
    text += "o " + part.name + "\n";
    std::string faces;
    for (const std::array<int, 3>& t : part.mesh.triangles) {
      std::array<Place, 3> corner{};
      for (std::size_t k = 0; k < 3; ++k) {
        corner[k] = rounded(part.mesh.vertices[static_cast<std::size_t>(t[k])]);
      }
      if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
      faces += 'f';
      for (const Place& place : corner) {
        const auto [entry, fresh] = number.emplace(place, number.size() + 1);
        if (fresh) {
          text += 'v';
          for (const std::int64_t value : place) {
            text += ' ';
            append_number(value, &text);
          }
          text += '\n';
        }
        faces += ' ' + std::to_string(entry->second);
      }
      faces += '\n';
    }
    text += faces;
  }
  return text;
}

}  // namespace generate

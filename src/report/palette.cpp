#include "report/palette.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <initializer_list>

namespace crashrank::detail {
namespace {

bool holds_any(const std::string& text, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(),
                     [&](const char* word) { return text.find(word) != std::string::npos; });
}

}  // namespace

Colour part_colour(const std::string& name, Colour paint) {
  std::string lower = name;
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  if (holds_any(lower, {"glass", "window", "windscreen", "windshield"})) {
    return {0.045F, 0.065F, 0.085F};
  }
  if (holds_any(lower, {"rim", "hub"})) return {0.35F, 0.36F, 0.38F};
  if (holds_any(lower, {"wheel", "tyre", "tire"})) return {0.018F, 0.018F, 0.02F};
  if (holds_any(lower, {"light", "lamp"})) return {0.75F, 0.72F, 0.60F};
  if (holds_any(lower, {"grille", "grid", "chassis", "underbody", "floor"})) {
    return {0.035F, 0.036F, 0.04F};
  }
  return paint;
}

std::uint8_t srgb(float linear) {
  const float x = std::clamp(linear, 0.0F, 1.0F);
  const float y = x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1.0F / 2.4F) - 0.055F;
  return static_cast<std::uint8_t>(std::lround(255.0F * y));
}

std::vector<bool> damage_flags(const TriangleMesh& mesh, View<const std::uint32_t> damaged) {
  std::vector<bool> flags(mesh.size(), false);
  for (const std::uint32_t index : damaged) {
    assert(index < mesh.size());
    flags[index] = true;
  }
  return flags;
}

}  // namespace crashrank::detail

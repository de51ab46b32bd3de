#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace crashrank::detail {

/// Linear RGB, 0 to 1.
struct Colour {
  float red = 0.0F;
  float green = 0.0F;
  float blue = 0.0F;

  friend bool operator==(const Colour& a, const Colour& b) {
    return a.red == b.red && a.green == b.green && a.blue == b.blue;
  }
};

inline constexpr Colour intact_colour{0.46F, 0.50F, 0.56F};
inline constexpr Colour damaged_colour{0.80F, 0.035F, 0.012F};
// Paint of bodies that move in the report's page and in animations.
inline constexpr Colour ego_paint{0.055F, 0.16F, 0.36F};
inline constexpr Colour other_paint{0.52F, 0.44F, 0.31F};

/// What a part of this name is usually coloured like: glass dark, tyres black, lamps bright;
/// `paint` otherwise.
Colour part_colour(const std::string& name, Colour paint);

/// sRGB transfer function of one linear channel, as a byte.
std::uint8_t srgb(float linear);

/// One flag a triangle of the mesh.
std::vector<bool> damage_flags(const TriangleMesh& mesh, View<const std::uint32_t> damaged);

}  // namespace crashrank::detail

#pragma once

#include "crashrank/report/ranking.hpp"
#include "report/palette.hpp"
#include "report/raster.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// All triangles of a picture in world coordinates, with their colours.
struct PictureScene {
  std::vector<std::array<Eigen::Vector3f, 3>> triangles;
  std::vector<Colour> colours;
  Eigen::Vector3f middle = Eigen::Vector3f::Zero();
  float radius = 0.0F;    ///< of a ball about `middle` that holds everything
  float ground_z = 0.0F;  ///< the lowest point
};

inline constexpr int samples = 2;  ///< of a raster, across and down a pixel of the final picture
inline constexpr Colour background{0.92F, 0.93F, 0.95F};

/// Marks a pixel of the raster that shows the ground.
inline constexpr std::uint32_t ground = nothing - 1;

/// Puts the ground plane into the raster, where no body is nearer.
void add_ground(const PictureScene& scene, const Viewer& camera, Raster& raster);

/// Colours the raster: a key light with shadows, a sky, darker in corners (ambient occlusion).
/// With `edges` the triangles' edges are drawn. Linear colours, row by row; the raster has
/// `samples` pixels across and down a pixel of the final picture.
std::vector<Colour> shade(const PictureScene& scene, const Viewer& camera, const Raster& raster,
                          bool edges);

/// The final picture of this size from what `shade` returns.
Image averaged(const std::vector<Colour>& fine, int width, int height);

}  // namespace crashrank::detail

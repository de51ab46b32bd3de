#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace crashrank::detail {

/// Something that looks at the scene: a camera (perspective) or a far light (parallel). Axes are
/// rows: right, up and back, world coordinates.
struct Viewer {
  Eigen::Matrix3f axes = Eigen::Matrix3f::Identity();
  Eigen::Vector3f eye = Eigen::Vector3f::Zero();
  float pixels = 1.0F;  ///< pixels a unit of tangent (perspective) or a metre (parallel)
  bool parallel = false;
  float middle_x = 0.0F;  ///< pixel on the view axis
  float middle_y = 0.0F;

  /// x and y in pixels, y down; z grows towards the viewer and is linear across a plane's picture.
  Eigen::Vector3f project(const Eigen::Vector3f& world) const;
  /// Undoes `project`.
  Eigen::Vector3f unproject(const Eigen::Vector3f& seen) const;
};

inline constexpr std::uint32_t nothing = std::numeric_limits<std::uint32_t>::max();

/// What is nearest at each pixel's middle.
struct Raster {
  Raster(int width_px, int height_px);

  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }

  int width;
  int height;
  std::vector<float> nearness;          ///< z of `Viewer::project`
  std::vector<std::uint32_t> triangle;  ///< index, `nothing` where there is none
  std::vector<float> edge;              ///< distance to the triangle's nearest edge, pixels
};

/// Draws triangles given in world coordinates; parts behind a camera's eye have to be absent.
void rasterise(const std::vector<std::array<Eigen::Vector3f, 3>>& triangles, const Viewer& viewer,
               Raster& raster);

}  // namespace crashrank::detail

#include "report/raster.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {

Eigen::Vector3f Viewer::project(const Eigen::Vector3f& world) const {
  const Eigen::Vector3f seen = axes * (world - eye);  // right, up, back
  if (parallel) {
    return {middle_x + pixels * seen.x(), middle_y - pixels * seen.y(), seen.z()};
  }
  const float away = -seen.z();
  return {middle_x + pixels * seen.x() / away, middle_y - pixels * seen.y() / away, 1.0F / away};
}

Eigen::Vector3f Viewer::unproject(const Eigen::Vector3f& seen) const {
  const float right = (seen.x() - middle_x) / pixels;
  const float up = (middle_y - seen.y()) / pixels;
  if (parallel) return eye + axes.transpose() * Eigen::Vector3f(right, up, seen.z());
  const float away = 1.0F / seen.z();
  return eye + axes.transpose() * Eigen::Vector3f(right * away, up * away, -away);
}

Raster::Raster(int width_px, int height_px) : width(width_px), height(height_px) {
  const std::size_t pixels =
      static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  nearness.assign(pixels, -std::numeric_limits<float>::infinity());
  triangle.assign(pixels, nothing);
  edge.assign(pixels, 0.0F);
}

namespace {

/// A triangle's edge as a line: signed distance in pixels, positive inside.
struct EdgeLine {
  EdgeLine(const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
    a = from.y() - to.y();
    b = to.x() - from.x();
    const float length = std::hypot(a, b);
    if (length > 0.0F) {
      a /= length;
      b /= length;
    }
    c = -(a * from.x() + b * from.y());
  }
  float operator()(float x, float y) const { return a * x + b * y + c; }

  float a;
  float b;
  float c;
};

}  // namespace

void rasterise(const std::vector<std::array<Eigen::Vector3f, 3>>& triangles, const Viewer& viewer,
               Raster& raster) {
  for (std::uint32_t index = 0; index < triangles.size(); ++index) {
    std::array<Eigen::Vector3f, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = viewer.project(triangles[index][i]);
    const float doubled = (p[1].x() - p[0].x()) * (p[2].y() - p[0].y()) -
                          (p[2].x() - p[0].x()) * (p[1].y() - p[0].y());
    if (!(std::abs(doubled) > 0.0F)) continue;
    if (doubled < 0.0F) std::swap(p[1], p[2]);
    const std::array<EdgeLine, 3> lines{EdgeLine(p[0], p[1]), EdgeLine(p[1], p[2]),
                                        EdgeLine(p[2], p[0])};
    // z over the picture: through the three corners.
    const float area = std::abs(doubled);
    const float zx = ((p[1].z() - p[0].z()) * (p[2].y() - p[0].y()) -
                      (p[2].z() - p[0].z()) * (p[1].y() - p[0].y())) /
                     area;
    const float zy = ((p[2].z() - p[0].z()) * (p[1].x() - p[0].x()) -
                      (p[1].z() - p[0].z()) * (p[2].x() - p[0].x())) /
                     area;
    const auto [low_x, high_x] = std::minmax({p[0].x(), p[1].x(), p[2].x()});
    const auto [low_y, high_y] = std::minmax({p[0].y(), p[1].y(), p[2].y()});
    const auto pixel = [](float value, int limit) {
      return static_cast<int>(std::clamp(value, 0.0F, static_cast<float>(limit)));
    };
    const int x_begin = pixel(std::floor(low_x), raster.width);
    const int x_end = pixel(std::ceil(high_x) + 1.0F, raster.width);
    const int y_begin = pixel(std::floor(low_y), raster.height);
    const int y_end = pixel(std::ceil(high_y) + 1.0F, raster.height);
    for (int y = y_begin; y < y_end; ++y) {
      const float py = static_cast<float>(y) + 0.5F;
      for (int x = x_begin; x < x_end; ++x) {
        const float px = static_cast<float>(x) + 0.5F;
        const float inside = std::min({lines[0](px, py), lines[1](px, py), lines[2](px, py)});
        if (!(inside >= 0.0F)) continue;
        const float z = p[0].z() + zx * (px - p[0].x()) + zy * (py - p[0].y());
        const std::size_t i = raster.at(x, y);
        if (!(z > raster.nearness[i])) continue;
        raster.nearness[i] = z;
        raster.triangle[i] = index;
        raster.edge[i] = inside;
      }
    }
  }
}

}  // namespace crashrank::detail

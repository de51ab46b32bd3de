#include "report/shading.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

using Eigen::Vector3f;

constexpr float pi = 3.14159265F;
constexpr Colour ground_colour{0.72F, 0.72F, 0.71F};

Colour scaled(const Colour& c, float by) { return {c.red * by, c.green * by, c.blue * by}; }

Colour mixed(const Colour& a, const Colour& b, float share_of_b) {
  return {a.red + (b.red - a.red) * share_of_b, a.green + (b.green - a.green) * share_of_b,
          a.blue + (b.blue - a.blue) * share_of_b};
}

float smooth_step(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

/// Different at neighbouring pixels, the same in every run.
std::uint32_t pixel_hash(int x, int y) {
  auto h =
      static_cast<std::uint32_t>(x) * 0x9e3779b1U ^ static_cast<std::uint32_t>(y) * 0x85ebca6bU;
  h ^= h >> 15U;
  h *= 0x2c1b3c6dU;
  return h ^ h >> 13U;
}

/// Points spread evenly over a disc of radius 1, turned by an angle that differs between
/// neighbouring pixels: few of them a pixel make a soft shadow over all.
template <std::size_t count> class Taps {
public:
  struct Tap {
    float x = 0.0F;
    float y = 0.0F;
  };
  using Disc = std::array<Tap, count>;

  Taps() {
    for (std::size_t turn = 0; turn < turns; ++turn) {
      for (std::size_t i = 0; i < count; ++i) {
        constexpr float golden_angle = 2.39996323F;
        const float angle =
            2.0F * pi * static_cast<float>(turn) / turns + golden_angle * static_cast<float>(i);
        const float reach = std::sqrt((static_cast<float>(i) + 0.5F) / count);
        discs_[turn][i] = {reach * std::cos(angle), reach * std::sin(angle)};
      }
    }
  }
  const Disc& at(std::uint32_t pixel_hash) const { return discs_[pixel_hash % turns]; }

private:
  static constexpr std::size_t turns = 64;
  std::array<Disc, turns> discs_;
};

/// The key light: far, up and to the left of the camera; what it sees first is lit.
class KeyLight {
public:
  KeyLight(const PictureScene& scene, const Viewer& camera) : depth_(side, side) {
    const Vector3f right = camera.axes.row(0);
    const Vector3f towards_camera = right.cross(Vector3f::UnitZ()) * -1.0F;
    direction_ = (Vector3f(0.0F, 0.0F, 1.1F) - 0.75F * right - 0.45F * towards_camera).normalized();
    const Vector3f across = Vector3f::UnitZ().cross(direction_).normalized();
    viewer_.axes.row(0) = across;
    viewer_.axes.row(1) = direction_.cross(across);
    viewer_.axes.row(2) = direction_;
    viewer_.eye = scene.middle;
    viewer_.parallel = true;
    viewer_.pixels = 0.49F * side / scene.radius;
    viewer_.middle_x = viewer_.middle_y = 0.5F * side;
    bias_ = 0.008F * scene.radius;
    rasterise(scene.triangles, viewer_, depth_);
  }

  const Vector3f& direction() const { return direction_; }

  /// 1 in full light, 0 in full shadow; soft at the border.
  float at(const Vector3f& world, std::uint32_t hash) const {
    const Vector3f seen = viewer_.project(world);
    int lit = 0;
    for (const auto& tap : taps_.at(hash)) {
      const int x = static_cast<int>(seen.x() + softness * tap.x);
      const int y = static_cast<int>(seen.y() + softness * tap.y);
      const bool outside = x < 0 || y < 0 || x >= side || y >= side;
      lit += outside || depth_.nearness[depth_.at(x, y)] < seen.z() + bias_ ? 1 : 0;
    }
    return static_cast<float>(lit) / tap_count;
  }

private:
  static constexpr int side = 1536;
  static constexpr float softness = 9.0F;  // pixels of its own picture
  static constexpr std::size_t tap_count = 6;
  Taps<tap_count> taps_;
  Raster depth_;
  Viewer viewer_;
  Vector3f direction_ = Vector3f::UnitZ();
  float bias_ = 0.0F;
};

/// What a pixel shows.
struct Spot {
  Vector3f point;
  Vector3f normal;  ///< unit, towards the camera
};

class Shader {
public:
  Shader(const PictureScene& scene, const Viewer& camera, const Raster& raster, bool edges)
      : scene_(scene), camera_(camera), raster_(raster), light_(scene, camera), edges_(edges) {
    // What shows nothing is far away.
    constexpr float nearest = 1e-9F;
    away_.reserve(raster.nearness.size());
    for (const float nearness : raster.nearness)
      away_.push_back(1.0F / std::max(nearness, nearest));
  }

  /// Without edges.
  Colour lit(int x, int y) const {
    const std::uint32_t index = raster_.triangle[raster_.at(x, y)];
    if (index == nothing) return background;
    const Spot spot = spot_at(x, y);
    const std::uint32_t hash = pixel_hash(x, y);
    if (index == ground) {
      const float far = (spot.point - scene_.middle).norm() / scene_.radius;
      constexpr float horizon = 2.4F;
      if (far >= horizon) return background;
      const float open = far > 1.0F + reach ? 1.0F : openness(x, y, spot, hash);
      const float light = open * (0.72F + 0.42F * light_.at(spot.point, hash));
      return mixed(scaled(ground_colour, light), background, smooth_step(1.0F, horizon, far));
    }
    return lit_surface(scene_.colours[index], spot, openness(x, y, spot, hash), hash);
  }

  Colour with_edge(const Colour& colour, int x, int y) const {
    const std::size_t i = raster_.at(x, y);
    const std::uint32_t index = raster_.triangle[i];
    if (!edges_ || index == nothing || index == ground) return colour;
    return scaled(colour, 1.0F - edge_strength(index, raster_.edge[i]));
  }

private:
  Spot spot_at(int x, int y) const {
    const std::size_t i = raster_.at(x, y);
    const Vector3f seen(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F,
                        raster_.nearness[i]);
    Spot spot;
    spot.point = camera_.unproject(seen);
    spot.normal = Vector3f::UnitZ();
    if (raster_.triangle[i] == ground) return spot;
    const std::array<Vector3f, 3>& t = scene_.triangles[raster_.triangle[i]];
    const Vector3f normal = (t[1] - t[0]).cross(t[2] - t[0]);
    const float length = normal.norm();
    if (length > 0.0F) spot.normal = normal / length;
    if (spot.normal.dot(camera_.eye - spot.point) < 0.0F) spot.normal = -spot.normal;
    return spot;
  }

  Colour lit_surface(const Colour& base, const Spot& spot, float open, std::uint32_t hash) const {
    const Vector3f to_eye = (camera_.eye - spot.point).normalized();
    const float facing = std::max(0.0F, spot.normal.dot(light_.direction()));
    const float lit = facing > 0.0F ? facing * light_.at(spot.point, hash) : 0.0F;
    const float sky = 0.5F + 0.5F * spot.normal.z();
    Colour colour = scaled(base, open * (0.30F + 0.42F * sky) + 0.85F * lit);
    const Vector3f half = (to_eye + light_.direction()).normalized();
    const float gloss = std::pow(std::max(0.0F, spot.normal.dot(half)), 40.0F);
    const float rim = std::pow(1.0F - std::clamp(spot.normal.dot(to_eye), 0.0F, 1.0F), 4.0F);
    const float shine = 0.22F * gloss * (lit > 0.0F ? 1.0F : 0.0F) + 0.18F * rim * open * sky;
    colour.red += shine;
    colour.green += shine;
    colour.blue += shine;
    return colour;
  }

  /// Right, up and back of what a pixel shows, from the eye.
  Vector3f seen_at(int x, int y) const {
    const float away = away_[raster_.at(x, y)];
    const float scale = away / camera_.pixels;
    return {(static_cast<float>(x) + 0.5F - camera_.middle_x) * scale,
            (camera_.middle_y - static_cast<float>(y) - 0.5F) * scale, -away};
  }

  static constexpr float reach = 0.10F;  ///< of what darkens a corner, in radii of the scene
  /// Share of the surroundings that is free, from the nearness of pixels around: 1 in the open.
  float openness(int x, int y, const Spot& spot, std::uint32_t hash) const {
    const float reach_m = reach * scene_.radius;
    const Vector3f here = seen_at(x, y);
    const Vector3f normal = camera_.axes * spot.normal;
    const float reach_px = reach_m * camera_.pixels / -here.z();
    float covered = 0.0F;
    for (const auto& tap : taps_.at(hash)) {
      const int u = x + static_cast<int>(reach_px * tap.x);
      const int v = y + static_cast<int>(reach_px * tap.y);
      if (u < 0 || v < 0 || u >= raster_.width || v >= raster_.height) continue;
      const Vector3f way = seen_at(u, v) - here;
      const float height_m = way.dot(normal);
      const float distance2 = way.squaredNorm();
      if (distance2 >= reach_m * reach_m || !(height_m > 0.0F)) continue;
      const float distance = std::sqrt(distance2);
      covered += std::max(0.0F, height_m / distance - 0.08F) * (1.0F - distance / reach_m);
    }
    return std::clamp(1.0F - 2.4F * covered / tap_count, 0.15F, 1.0F);
  }

  /// How dark an edge is drawn: nothing where the triangles are hardly larger than its line.
  float edge_strength(std::uint32_t index, float distance_px) const {
    constexpr float scale = samples;
    const float line = 1.0F - distance_px / (0.6F * scale);
    if (line <= 0.0F) return 0.0F;
    const std::array<Vector3f, 3>& t = scene_.triangles[index];
    std::array<Vector3f, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = camera_.project(t[i]);
    float around = 0.0F;
    for (std::size_t i = 0; i < 3; ++i) around += (p[(i + 1) % 3] - p[i]).head<2>().norm();
    const float doubled = std::abs((p[1].x() - p[0].x()) * (p[2].y() - p[0].y()) -
                                   (p[2].x() - p[0].x()) * (p[1].y() - p[0].y()));
    const float inner_radius = doubled / std::max(around, 1e-6F) / scale;
    return 0.45F * line * smooth_step(0.7F, 3.0F, inner_radius);
  }

  const PictureScene& scene_;
  const Viewer& camera_;
  const Raster& raster_;
  static constexpr std::size_t tap_count = 10;
  Taps<tap_count> taps_;
  KeyLight light_;
  bool edges_;
  std::vector<float> away_;  ///< along the view, by pixel, m
};

}  // namespace

void add_ground(const PictureScene& scene, const Viewer& camera, Raster& raster) {
  for (int y = 0; y < raster.height; ++y) {
    for (int x = 0; x < raster.width; ++x) {
      const Vector3f ray =
          camera.unproject({static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F, 1.0F}) -
          camera.eye;  // its length along the view is 1 m
      const float away = (scene.ground_z - camera.eye.z()) / ray.z();
      const std::size_t i = raster.at(x, y);
      if (!(away > 0.0F) || !(1.0F / away > raster.nearness[i])) continue;
      raster.nearness[i] = 1.0F / away;
      raster.triangle[i] = ground;
    }
  }
}

std::vector<Colour> shade(const PictureScene& scene, const Viewer& camera, const Raster& raster,
                          bool edges) {
  const Shader shader(scene, camera, raster, edges);
  std::vector<Colour> colours(raster.triangle.size());
  for (int y = 0; y < raster.height; ++y) {
    for (int x = y % 2; x < raster.width; x += 2) colours[raster.at(x, y)] = shader.lit(x, y);
    // Light hardly changes across a triangle's pixel: every other one takes its neighbour's.
    for (int x = 1 - y % 2; x < raster.width; x += 2) {
      const std::size_t neighbour = raster.at(x ^ 1, y);
      const bool is_alike = raster.triangle[neighbour] == raster.triangle[raster.at(x, y)];
      colours[raster.at(x, y)] = is_alike ? colours[neighbour] : shader.lit(x, y);
    }
    for (int x = 0; x < raster.width; ++x) {
      Colour& colour = colours[raster.at(x, y)];
      colour = shader.with_edge(colour, x, y);
    }
  }
  return colours;
}

Image averaged(const std::vector<Colour>& fine, int width, int height) {
  Image image;
  image.width = width;
  image.height = height;
  image.rgb.reserve(3 * fine.size() / samples / samples);
  const auto stride = static_cast<std::size_t>(width) * samples;
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
    for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
      Colour sum;
      for (std::size_t j = 0; j < samples; ++j) {
        for (std::size_t i = 0; i < samples; ++i) {
          const Colour& c = fine[(y * samples + j) * stride + x * samples + i];
          // Bright spots are clipped before averaging, or their borders would stay jagged.
          sum.red += std::min(c.red, 1.0F);
          sum.green += std::min(c.green, 1.0F);
          sum.blue += std::min(c.blue, 1.0F);
        }
      }
      constexpr float share = 1.0F / (samples * samples);
      for (const float channel : {sum.red, sum.green, sum.blue}) {
        image.rgb.push_back(srgb(channel * share));
      }
    }
  }
  return image;
}

}  // namespace crashrank::detail

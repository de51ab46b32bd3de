#include "crashrank/report/ranking.hpp"

#include "report/palette.hpp"
#include "report/raster.hpp"
#include "report/shading.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace crashrank {
namespace {

using detail::Colour;
using detail::samples;
using Eigen::Vector3f;

constexpr float radians = 3.14159265F / 180.0F;
constexpr Colour first_paint{0.10F, 0.22F, 0.42F};
constexpr Colour other_paint{0.46F, 0.40F, 0.31F};

Status check(const PictureOptions& options) {
  const auto sound_size = [](int pixels) { return pixels >= 16 && pixels <= 4096; };
  if (!sound_size(options.width_px) || !sound_size(options.height_px)) {
    return make_error(ErrorCode::usage, "a picture has to be 16 to 4096 pixels wide and high");
  }
  const bool sound_angles = std::isfinite(options.azimuth_deg) &&
                            std::abs(options.elevation_deg) <= 89.0 &&
                            options.field_of_view_deg >= 1.0 && options.field_of_view_deg <= 120.0;
  if (!sound_angles) {
    return make_error(ErrorCode::usage, "the camera's angles make no picture",
                      "elevation -89 to 89, field of view 1 to 120 degrees");
  }
  return Success{};
}

void add_body(detail::PictureScene& scene, const PictureBody& body, const Colour& paint) {
  const TriangleMesh& mesh = *body.mesh;
  const std::vector<bool> damaged = detail::damage_flags(mesh, body.damaged);
  std::vector<Colour> colours(mesh.size(), paint);
  for (const Part& part : mesh.parts) {
    const Colour colour = detail::part_colour(part.name, paint);
    std::fill_n(colours.begin() + part.first_triangle, part.triangle_count, colour);
  }
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const Triangle triangle = mesh.triangle(i);
    std::array<Vector3f, 3> world;
    bool finite = true;
    for (std::size_t k = 0; k < 3; ++k) {
      world[k] = carry(body.pose, triangle.corner[k]).cast<float>();
      finite = finite && world[k].allFinite();
    }
    if (!finite) continue;
    scene.triangles.push_back(world);
    scene.colours.push_back(damaged[i] ? detail::damaged_colour : colours[i]);
  }
}

void measure(detail::PictureScene& scene) {
  Box box;
  for (const auto& triangle : scene.triangles) {
    for (const Vector3f& point : triangle) box.grow(point);
  }
  scene.middle = box.center();
  scene.radius = std::max(0.5F * box.extent().norm(), 1e-6F);
  scene.ground_z = box.min.z();
}

Result<detail::PictureScene> scene_of(View<const PictureBody> bodies) {
  detail::PictureScene scene;
  for (const PictureBody& body : bodies) {
    add_body(scene, body, &body == bodies.begin() ? first_paint : other_paint);
  }
  if (scene.triangles.empty()) {
    return make_error(ErrorCode::usage, "there is no triangle to draw");
  }
  measure(scene);
  return scene;
}

/// A camera that looks at the scene from the side asked for, near enough to fill the picture.
detail::Viewer aim(const detail::PictureScene& scene, const PictureOptions& options, int width,
                   int height) {
  const float azimuth = static_cast<float>(std::remainder(options.azimuth_deg, 360.0)) * radians;
  const float elevation = static_cast<float>(options.elevation_deg) * radians;
  const Vector3f back(std::cos(elevation) * std::cos(azimuth),
                      std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  const Vector3f right(-std::sin(azimuth), std::cos(azimuth), 0.0F);
  detail::Viewer camera;
  camera.axes.row(0) = right;
  camera.axes.row(1) = back.cross(right);
  camera.axes.row(2) = back;

  constexpr float filled = 0.90F;
  const float tan_x = std::tan(0.5F * static_cast<float>(options.field_of_view_deg) * radians);
  const float tan_y = tan_x * static_cast<float>(height) / static_cast<float>(width);
  Vector3f middle = scene.middle;
  constexpr int rounds = 4;  // each brings the middle of the picture nearer to that of the scene
  for (int round = 0; round < rounds; ++round) {
    float distance = 0.0F;
    for (const auto& triangle : scene.triangles) {
      for (const Vector3f& point : triangle) {
        const Vector3f seen = camera.axes * (point - middle);
        distance = std::max({distance, seen.z() + std::abs(seen.x()) / (filled * tan_x),
                             seen.z() + std::abs(seen.y()) / (filled * tan_y)});
      }
    }
    camera.eye = middle + distance * back;
    Box tangents;
    for (const auto& triangle : scene.triangles) {
      for (const Vector3f& point : triangle) {
        const Vector3f seen = camera.axes * (point - camera.eye);
        tangents.grow(Vector3f(seen.x() / -seen.z(), seen.y() / -seen.z(), 0.0F));
      }
    }
    const Vector3f shift = distance * tangents.center();
    if (round + 1 < rounds) middle += camera.axes.transpose() * shift;
  }
  camera.pixels = 0.5F * static_cast<float>(width) / tan_x;
  camera.middle_x = 0.5F * static_cast<float>(width);
  camera.middle_y = 0.5F * static_cast<float>(height);
  return camera;
}

}  // namespace

Result<Image> draw_picture(View<const PictureBody> bodies, const PictureOptions& options) {
  if (const Status sound = check(options); !sound) return sound.error();
  Result<detail::PictureScene> bodies_seen = scene_of(bodies);
  if (!bodies_seen) return bodies_seen.error();
  const detail::PictureScene& scene = *bodies_seen;
  const int width = options.width_px * samples;
  const int height = options.height_px * samples;
  const detail::Viewer camera = aim(scene, options, width, height);
  detail::Raster raster(width, height);
  detail::rasterise(scene.triangles, camera, raster);
  detail::add_ground(scene, camera, raster);
  return detail::averaged(detail::shade(scene, camera, raster, options.edges), options.width_px,
                          options.height_px);
}

double azimuth_of_damage_deg(const PictureBody& body) {
  if (body.damaged.empty()) return 0.0;
  const TriangleMesh& mesh = *body.mesh;
  const Eigen::Vector3d middle = carry(body.pose, mesh.bounds().center());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const std::uint32_t index : body.damaged) {
    for (const Vector3f& corner : mesh.triangle(index).corner) {
      sum += carry(body.pose, corner) - middle;
    }
  }
  return std::atan2(sum.y(), sum.x()) / static_cast<double>(radians);
}

Result<double> azimuth_of_most_damage_deg(View<const PictureBody> bodies) {
  Result<detail::PictureScene> scene = scene_of(bodies);
  if (!scene) return scene.error();
  PictureOptions options;
  options.width_px = 240;
  options.height_px = 150;
  const double start_deg = azimuth_of_damage_deg(*bodies.begin());
  double best_deg = start_deg;
  double most = -1.0;
  for (const double turn_deg : {35.0, -35.0, 70.0, -70.0, 110.0, -110.0, 150.0, -150.0}) {
    options.azimuth_deg = start_deg + turn_deg;
    detail::Raster raster(options.width_px, options.height_px);
    detail::rasterise(scene->triangles, aim(*scene, options, options.width_px, options.height_px),
                      raster);
    const auto seen =
        std::count_if(raster.triangle.begin(), raster.triangle.end(), [&](std::uint32_t triangle) {
          return triangle != detail::nothing && scene->colours[triangle] == detail::damaged_colour;
        });
    if (static_cast<double>(seen) > 1.1 * most) {
      most = static_cast<double>(seen);
      best_deg = options.azimuth_deg;
    }
  }
  return best_deg;
}

}  // namespace crashrank

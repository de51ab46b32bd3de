#include "crashrank/report/ranking.hpp"

#include "report/palette.hpp"
#include "report/raster.hpp"
#include "report/shading.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

namespace crashrank {
namespace {

using detail::Colour;
using detail::samples;
using Eigen::Vector3f;

constexpr Colour black{0.0F, 0.0F, 0.0F};
constexpr Colour axle_colour{0.35F, 0.02F, 0.30F};
constexpr Colour ground_colour{0.20F, 0.11F, 0.03F};
constexpr std::array<Colour, 3> axis_colours{
    {{0.60F, 0.01F, 0.01F}, {0.01F, 0.27F, 0.02F}, {0.01F, 0.04F, 0.65F}}};
// By part, again from the first: told apart beside tyres, glass and lamps, which have their own.
constexpr std::array<Colour, 7> paints{{{0.10F, 0.22F, 0.42F},
                                        {0.46F, 0.40F, 0.31F},
                                        {0.12F, 0.35F, 0.16F},
                                        {0.50F, 0.18F, 0.10F},
                                        {0.30F, 0.16F, 0.42F},
                                        {0.52F, 0.42F, 0.08F},
                                        {0.08F, 0.38F, 0.40F}}};

constexpr int letter_width = 5;
constexpr int letter_height = 7;
// Rows of five bits from the top, the highest bit first.
constexpr std::array<std::pair<char, std::uint64_t>, 40> letters{
    {{'0', 0x3a33ae62eULL}, {'1', 0x11842108eULL}, {'2', 0x3a213221fULL}, {'3', 0x78217043eULL},
     {'4', 0x08ca97c42ULL}, {'5', 0x7e1e0862eULL}, {'6', 0x1910f462eULL}, {'7', 0x7c2222108ULL},
     {'8', 0x3a317462eULL}, {'9', 0x3a317844cULL}, {'.', 0x00000018cULL}, {'-', 0x0000f8000ULL},
     {'=', 0x001f07c00ULL}, {'a', 0x000e0be2fULL}, {'d', 0x042d9c62fULL}, {'e', 0x000e8fe0eULL},
     {'f', 0x1928e2108ULL}, {'g', 0x01f18bc2eULL}, {'h', 0x4216cc631ULL}, {'i', 0x100c2108eULL},
     {'l', 0x30842108eULL}, {'m', 0x001aad6b5ULL}, {'n', 0x0016cc631ULL}, {'o', 0x000e8c62eULL},
     {'p', 0x001e8fa10ULL}, {'r', 0x0016cc210ULL}, {'s', 0x000e8383eULL}, {'t', 0x211c42126ULL},
     {'u', 0x00118c66dULL}, {'w', 0x00118d6aaULL}, {'x', 0x001151151ULL}, {'y', 0x00118bc2eULL},
     {'z', 0x001f1111fULL}, {'b', 0x4216cc736ULL}, {'c', 0x000e8c22eULL}, {'k', 0x4212a6292ULL},
     {'v', 0x00118c544ULL}, {'+', 0x0084f9080ULL}, {',', 0x000003088ULL}, {':', 0x018c03180ULL}}};

constexpr int letter_px = 2;  // picture pixels across and down a letter's pixel
constexpr int text_px = letter_px * letter_height;

int width_of(const std::string& text) {
  return letter_px * (letter_width + 1) * static_cast<int>(text.size());
}

/// An image to draw flat marks on; what lies outside is cut off.
class Sheet {
public:
  Sheet(int width, int height) {
    image_ = {width, height,
              std::vector<std::uint8_t>(3UL * static_cast<std::size_t>(width) *
                                        static_cast<std::size_t>(height))};
    fill(0, 0, width, height, detail::background);
  }

  void fill(int x0, int y0, int width, int height, const Colour& colour) {
    const std::array<std::uint8_t, 3> rgb{detail::srgb(colour.red), detail::srgb(colour.green),
                                          detail::srgb(colour.blue)};
    for (int y = std::max(y0, 0); y < std::min(y0 + height, image_.height); ++y) {
      for (int x = std::max(x0, 0); x < std::min(x0 + width, image_.width); ++x) {
        std::copy(rgb.begin(), rgb.end(), image_.rgb.begin() + at(x, y));
      }
    }
  }

  void text(int x, int y, const std::string& text, const Colour& colour) {
    for (const char c : text) {
      const auto* const letter = std::find_if(letters.begin(), letters.end(),
                                              [c](const auto& known) { return known.first == c; });
      for (int bit = 0; letter != letters.end() && bit < letter_width * letter_height; ++bit) {
        if ((letter->second >> (letter_width * letter_height - 1 - bit) & 1U) == 0) continue;
        fill(x + letter_px * (bit % letter_width), y + letter_px * (bit / letter_width), letter_px,
             letter_px, colour);
      }
      x += letter_px * (letter_width + 1);
    }
  }

  void paste(const Image& from, int x0, int y0) {
    for (int y = 0; y < from.height; ++y) {
      const auto row = from.rgb.begin() + std::ptrdiff_t{3} * y * from.width;
      std::copy(row, row + std::ptrdiff_t{3} * from.width, image_.rgb.begin() + at(x0, y0 + y));
    }
  }

  Image take() { return std::move(image_); }

private:
  std::ptrdiff_t at(int x, int y) const {
    return 3 * (static_cast<std::ptrdiff_t>(y) * image_.width + x);
  }

  Image image_;
};

/// One of the views: the body axes that lie to the right and upwards in it, and its picture.
struct Panel {
  const char* name;
  int right;
  int up;
  Vector3f back;  ///< towards the viewer
  int x = 0;      ///< pixels from the sheet's left to the panel's left
  int y = 0;
  int width = 0;
  int height = 0;
};

constexpr int margin_px = 80;  // room for axes that begin at the edge of a panel
constexpr int gap_px = 60;
constexpr int edge_px = 2;  // around what a panel shows

/// Three views of a scene to one scale, the top view above the side view and the front view right
/// of it (third-angle projection, ISO 5456-2).
class Views {
public:
  Views(const detail::PictureScene& scene, const Box& bounds, const ThreeViewOptions& options)
      : scene_(scene), shown_(bounds), sheet_(options.width_px, options.height_px) {
    // The origin and the ground are shown where they do not make the body small.
    const float near_m = 0.5F * bounds.extent().maxCoeff();
    const Vector3f to_origin = bounds.min.cwiseMax(0.0F).cwiseMin(bounds.max);
    if (to_origin.maxCoeff() <= near_m && to_origin.minCoeff() >= -near_m) {
      shown_.grow(Vector3f::Zero());
    } else if (std::abs(to_origin.z()) <= near_m) {
      shown_.min.z() = std::min(shown_.min.z(), 0.0F);
      shown_.max.z() = std::max(shown_.max.z(), 0.0F);
    }
    const Vector3f size = shown_.extent();
    const auto room = [](int pixels) {
      return static_cast<float>(pixels - 2 * margin_px - gap_px - 4 * edge_px);
    };
    px_per_m_ = std::min(room(options.width_px) / std::max(size.x() + size.y(), 1e-6F),
                         room(options.height_px) / std::max(size.y() + size.z(), 1e-6F));
    for (Panel& panel : panels_) {
      panel.width = static_cast<int>(std::ceil(px_per_m_ * size[panel.right])) + 2 * edge_px;
      panel.height = static_cast<int>(std::ceil(px_per_m_ * size[panel.up])) + 2 * edge_px;
    }
    auto& [top, side, front] = panels_;
    top.x = side.x = (options.width_px - side.width - gap_px - front.width) / 2;
    front.x = side.x + side.width + gap_px;
    top.y = (options.height_px - top.height - gap_px - side.height) / 2;
    side.y = front.y = top.y + top.height + gap_px;
  }

  void draw_body() {
    for (const Panel& panel : panels_) {
      detail::Viewer camera;
      camera.axes.row(0) = Vector3f::Unit(panel.right);
      camera.axes.row(1) = Vector3f::Unit(panel.up);
      camera.axes.row(2) = panel.back;
      // From so far away that perspective moves nothing by half a pixel.
      const float away_m = 3000.0F * scene_.radius;
      camera.eye = shown_.center() + away_m * panel.back;
      camera.pixels = samples * px_per_m_ * away_m;
      camera.middle_x = 0.5F * samples * static_cast<float>(panel.width);
      camera.middle_y = 0.5F * samples * static_cast<float>(panel.height);
      detail::Raster raster(samples * panel.width, samples * panel.height);
      detail::rasterise(scene_.triangles, camera, raster);
      sheet_.paste(
          detail::averaged(detail::shade(scene_, camera, raster, true), panel.width, panel.height),
          panel.x, panel.y);
    }
  }

  void draw_marks(const Vector3f& extent, const ThreeViewOptions& options) {
    for (const Panel& panel : panels_) {
      const std::string name = panel.name;
      sheet_.text(panel.x + panel.width - width_of(name), panel.y - 2 * text_px, name, black);
      if (panel.up == 2) draw_ground(panel);
      if (panel.right == 0 && options.rear_axle_x_m) {
        draw_axle(panel, static_cast<float>(*options.rear_axle_x_m));
      }
      if (shows(Vector3f::Zero())) draw_axes(panel);
    }
    sheet_.text(margin_px, text_px,
                fmt::format("{:.3g} x {:.3g} x {:.3g} m", extent.x(), extent.y(), extent.z()),
                black);
    sheet_.text(margin_px, 3 * text_px, options.caption, black);
    const float scale_m = std::pow(10.0F, std::floor(std::log10(extent.maxCoeff())));
    const int length = static_cast<int>(std::lround(px_per_m_ * scale_m));
    const int y = options.height_px - 2 * text_px;
    sheet_.fill(margin_px, y + letter_height, length, letter_px, black);
    sheet_.text(margin_px + length + letter_height, y, fmt::format("{:g} m", scale_m), black);
    if (!shows(Vector3f::Zero())) {
      sheet_.text(options.width_px / 2, y, "origin is outside the sheet", black);
    }
  }

  Image take() { return sheet_.take(); }

private:
  bool shows(const Vector3f& point) const {
    return (point.array() >= shown_.min.array()).all() &&
           (point.array() <= shown_.max.array()).all();
  }
  int x_of(const Panel& panel, float right_m) const {
    const float middle = static_cast<float>(panel.x) + 0.5F * static_cast<float>(panel.width);
    return static_cast<int>(
        std::lround(middle + px_per_m_ * (right_m - shown_.center()[panel.right])));
  }
  int y_of(const Panel& panel, float up_m) const {
    const float middle = static_cast<float>(panel.y) + 0.5F * static_cast<float>(panel.height);
    return static_cast<int>(std::lround(middle - px_per_m_ * (up_m - shown_.center()[panel.up])));
  }

  void draw_ground(const Panel& panel) {
    if (shown_.min.z() > 0.0F || shown_.max.z() < 0.0F) return;
    const int y = y_of(panel, 0.0F);
    sheet_.fill(panel.x - gap_px / 3, y, panel.width + 2 * gap_px / 3, letter_px, ground_colour);
    const std::string words = "ground";
    sheet_.text(panel.x + panel.width - width_of(words), y + text_px / 2, words, ground_colour);
  }

  void draw_axle(const Panel& panel, float x_m) {
    if (x_m < shown_.min.x() || x_m > shown_.max.x()) return;
    const int x = x_of(panel, x_m);
    for (int y = panel.y - text_px / 2; y < panel.y + panel.height; y += text_px) {
      sheet_.fill(x, y, letter_px, text_px / 2, axle_colour);
    }
    if (panel.up != 1) return;
    sheet_.text(x, panel.y + panel.height + text_px / 2, fmt::format("rear axle x={:.2f} m", x_m),
                axle_colour);
  }

  /// Arrows from the origin of the body's axes.
  void draw_axes(const Panel& panel) {
    const int x = x_of(panel, 0.0F);
    const int y = y_of(panel, 0.0F);
    const auto& right = axis_colours[static_cast<std::size_t>(panel.right)];
    const auto& up = axis_colours[static_cast<std::size_t>(panel.up)];
    constexpr int arrow_px = 56;
    constexpr int head_px = 6;
    sheet_.fill(x, y, arrow_px, letter_px, right);
    sheet_.fill(x, y - arrow_px, letter_px, arrow_px, up);
    for (int i = 0; i < head_px; ++i) {
      sheet_.fill(x + arrow_px - i, y - i, letter_px, 2 * i + letter_px, right);
      sheet_.fill(x - i, y - arrow_px + i, 2 * i + letter_px, letter_px, up);
    }
    sheet_.text(x + arrow_px - head_px, y - 2 * text_px, std::string(1, "xyz"[panel.right]), right);
    sheet_.text(x + text_px, y - arrow_px - head_px, std::string(1, "xyz"[panel.up]), up);
  }

  const detail::PictureScene& scene_;
  Box shown_;
  float px_per_m_ = 1.0F;
  std::array<Panel, 3> panels_{{{"top", 0, 1, Vector3f::UnitZ()},
                                {"side", 0, 2, -Vector3f::UnitY()},
                                {"front", 1, 2, Vector3f::UnitX()}}};
  Sheet sheet_;
};

}  // namespace

Result<Image> draw_three_views(const TriangleMesh& mesh, const ThreeViewOptions& options) {
  const auto sound_size = [](int pixels) { return pixels >= 400 && pixels <= 4096; };
  if (!sound_size(options.width_px) || !sound_size(options.height_px)) {
    return make_error(ErrorCode::usage, "three views need 400 to 4096 pixels across and down");
  }
  detail::PictureScene scene;
  std::vector<Colour> colours(mesh.size(), paints.front());
  std::size_t painted = 0;
  for (const Part& part : mesh.parts) {
    const Colour colour = detail::part_colour(part.name, paints[painted++ % paints.size()]);
    std::fill_n(colours.begin() + part.first_triangle, part.triangle_count, colour);
  }
  Box bounds;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const std::array<Vector3f, 3> corners = mesh.triangle(i).corner;
    if (!corners[0].allFinite() || !corners[1].allFinite() || !corners[2].allFinite()) continue;
    scene.triangles.push_back(corners);
    scene.colours.push_back(colours[i]);
    for (const Vector3f& corner : corners) bounds.grow(corner);
  }
  if (scene.triangles.empty()) {
    return make_error(ErrorCode::usage, "there is no triangle to draw");
  }
  scene.middle = bounds.center();
  scene.radius = std::max(0.5F * bounds.extent().norm(), 1e-6F);
  scene.ground_z = bounds.min.z();
  Views views(scene, bounds, options);
  views.draw_body();
  if (options.marks) views.draw_marks(bounds.extent(), options);
  return views.take();
}

}  // namespace crashrank

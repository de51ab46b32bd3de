#include "profile_picture.hpp"

#include "crashrank/internal/report/escape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace crashrank::cli {
namespace {

constexpr double panel_px = 360.0;
constexpr double gap_px = 16.0;
constexpr double label_px = 40.0;
constexpr double head_px = 56.0;
constexpr std::size_t columns = 3;

struct Bounds {
  double min_x = 1e9;
  double max_x = -1e9;
  double min_y = 1e9;
  double max_y = -1e9;
};

Bounds bounds_of(const Profile& profile) {
  Bounds b;
  for (const OutlinePiece& piece : profile.pieces) {
    const double half = 0.5 * static_cast<double>(piece.length_m);
    b.min_x = std::min(b.min_x, static_cast<double>(piece.x) - half);
    b.max_x = std::max(b.max_x, static_cast<double>(piece.x) + half);
    b.min_y = std::min(b.min_y, static_cast<double>(piece.y) - half);
    b.max_y = std::max(b.max_y, static_cast<double>(piece.y) + half);
  }
  return b;
}

/// Pieces as one path: they follow each other around each outline.
std::string path_of(const Profile& profile, std::uint32_t first, std::uint32_t last,
                    const Bounds& bounds, double px_per_m) {
  std::string path;
  double end_x = 1e18;
  double end_y = 1e18;
  for (std::uint32_t i = first; i < last; ++i) {
    const OutlinePiece& piece = profile.pieces[i];
    const double half = 0.5 * static_cast<double>(piece.length_m);
    const double dx = -half * static_cast<double>(piece.normal_y);
    const double dy = half * static_cast<double>(piece.normal_x);
    const auto x = static_cast<double>(piece.x);
    const auto y = static_cast<double>(piece.y);
    const auto point = [&](double at_x, double at_y) {
      return fmt::format("{:.2f} {:.2f}", px_per_m * (at_x - bounds.min_x),
                         px_per_m * (bounds.max_y - at_y));
    };
    constexpr double joined_m = 1e-3;
    if (std::abs(x - dx - end_x) + std::abs(y - dy - end_y) > joined_m) {
      if (!path.empty()) path += 'Z';
      path += 'M';
      path += point(x - dx, y - dy);
    }
    path += 'L';
    path += point(x + dx, y + dy);
    end_x = x + dx;
    end_y = y + dy;
  }
  if (!path.empty()) path += 'Z';
  return path;
}

std::string panel(const Profile& profile, std::size_t band, const Bounds& bounds, double px_per_m) {
  HeightRange heights;
  for (std::uint32_t i = profile.first[band]; i < profile.first_inner[band]; ++i) {
    heights.grow(profile.pieces[i].behind);
  }
  std::string text =
      fmt::format("{:g} to {:g} m", profile_edges_m[band], profile_edges_m[band + 1]);
  if (band < lowest_pressing_band) {
    text += ": driven over, does not press";
  } else if (!heights.empty()) {
    text += fmt::format(": body from {:.2f} to {:.2f} m, {:.3g} m³", heights.low_m, heights.high_m,
                        static_cast<double>(profile.area_m2[band]) * band_height_m(band));
  }
  // Free space inside is cut out of the body by the even-odd rule.
  return fmt::format(
      "<text y=\"-8\">{}</text>\n"
      "<path d=\"{}{}\" fill=\"#9db8d9\" fill-rule=\"evenodd\" stroke=\"#1f3a5f\"/>\n"
      "<path d=\"{}\" fill=\"none\" stroke=\"#990000\" stroke-dasharray=\"4 2\"/>\n",
      text, path_of(profile, profile.first[band], profile.first_inner[band], bounds, px_per_m),
      path_of(profile, profile.first_inner[band], profile.first[band + 1], bounds, px_per_m),
      path_of(profile, profile.first_inner[band], profile.first[band + 1], bounds, px_per_m));
}

}  // namespace

std::string profile_picture(const Profile& profile, const std::string& title) {
  const Bounds bounds = bounds_of(profile);
  const double length_m = std::max(bounds.max_x - bounds.min_x, 1e-3);
  const double width_m = std::max(bounds.max_y - bounds.min_y, 1e-3);
  const double px_per_m = panel_px / std::max(length_m, width_m);
  const double cell_px = label_px + px_per_m * width_m;
  std::string panels;
  std::size_t count = 0;
  for (std::size_t band = 0; band < profile_bands; ++band) {
    if (profile.first[band] == profile.first[band + 1]) continue;
    const std::size_t row = count / columns;
    panels += fmt::format("<g transform=\"translate({:.1f} {:.1f})\">\n{}</g>\n",
                          gap_px + static_cast<double>(count % columns) * (panel_px + gap_px),
                          head_px + label_px + static_cast<double>(row) * cell_px,
                          panel(profile, band, bounds, px_per_m));
    ++count;
  }
  const double rows = std::ceil(static_cast<double>(count) / static_cast<double>(columns));
  const double width_px = gap_px + static_cast<double>(columns) * (panel_px + gap_px);
  const double height_px = head_px + gap_px + std::max(1.0, rows) * cell_px;
  // A scale of 1, 10, ... m that fits a panel, where there is one.
  const double scale_m = std::pow(10.0, std::floor(std::log10(0.5 * std::max(length_m, width_m))));
  const std::string scale =
      count == 0 ? std::string()
                 : fmt::format(
                       "<path d=\"M{0:.0f} 44h{1:.2f}\" stroke=\"#000000\" "
                       "stroke-width=\"2\"/>\n"
                       "<text x=\"{2:.2f}\" y=\"48\">{3:g} m, forward to the right</text>\n",
                       gap_px, px_per_m * scale_m, gap_px + px_per_m * scale_m + 8.0, scale_m);
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
      "height=\"{1:.0f}\" font-family=\"sans-serif\" font-size=\"12\" stroke-width=\"1\">\n"
      "<title>{2}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
      "<text x=\"{3:.0f}\" y=\"24\" font-size=\"15\">{2}: {4}</text>\n"
      "{5}{6}</svg>\n",
      width_px, height_px, escape_xml(title), gap_px,
      count > 0 ? "outlines by height over the ground, free space inside dashed"
                : "nothing between 0 and 4 m over the ground",
      scale, panels);
}

std::string profile_warning(const Profile& profile, const TriangleMesh& mesh) {
  const Eigen::Vector3f extent = mesh.bounds().extent();
  std::string flat;
  for (const auto& [axis, name] : {std::pair(0, "x"), std::pair(1, "y"), std::pair(2, "z")}) {
    if (!(extent[axis] > 0.0F))
      flat = fmt::format("the mesh is flat, without extent along {}", name);
  }
  if (profile.presses()) return flat.empty() ? flat : flat + ": as a body it encloses nothing";
  return (flat.empty() ? flat : flat + ": ") +
         "no material between 0.1 and 4 m over the ground, so that in a crash nothing presses on "
         "it; "
         "check scale, up axis and origin";
}

}  // namespace crashrank::cli

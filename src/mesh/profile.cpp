#include "crashrank/mesh/profile.hpp"

#include "mesh/outline.hpp"

#include "crashrank/internal/base/guarded.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace crashrank {
namespace {

using Eigen::Vector2d;

/// Of the raster and of the line: finer for small bodies, so that a pole stays round. No round
/// numbers, on whose grid the corners of drawn bodies lie.
constexpr double coarsest_cell_m = 0.0199;
constexpr double finest_cell_m = 0.00199;
constexpr double cells_along = 251.3;
constexpr double tolerance_cells = 0.25;
/// Two across a motorcycle's tyre: pieces act at their middles.
constexpr double usual_piece_m = 0.5 * longest_piece_m;
constexpr double most_pieces_along = 20000.0;

/// Outlines that enclose less than this times the square of their length enclose nothing: they run
/// along a sheet and back, and the area is what rounding leaves.
constexpr double least_area_per_length2 = 1e-9;

/// The box around the vertices that triangles use. Errors: bad_input.
Result<Box> surface_bounds(const TriangleMesh& mesh) {
  Box box;
  for (const std::array<std::uint32_t, 3>& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) {
      if (index >= mesh.vertices.size()) {
        return make_error(ErrorCode::bad_input, "has a triangle with a vertex that is not there",
                          "make the mesh again");
      }
      const Eigen::Vector3f& vertex = mesh.vertices[index];
      // Not finite: neither.
      if (!(vertex.cwiseAbs().cast<double>().array() <= max_profile_coordinate_m).all()) {
        return make_error(ErrorCode::bad_input,
                          "has a vertex more than 1e6 m from its origin, or not finite",
                          "check its scale and its origin");
      }
      box.grow(vertex);
    }
  }
  if (box.empty()) {
    return make_error(ErrorCode::bad_input, "has no triangle to take an outline from",
                      "give it a mesh with a surface");
  }
  return box;
}

/// Triangles that reach into each band, in their order.
std::array<std::vector<std::uint32_t>, profile_bands> triangles_by_band(const TriangleMesh& mesh,
                                                                        double ground_m) {
  // What reaches less far into a band is rounding of single precision.
  constexpr double least_m = 1e-4;
  std::array<std::vector<std::uint32_t>, profile_bands> by_band;
  for (std::uint32_t i = 0; i < mesh.size(); ++i) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const std::uint32_t index : mesh.triangles[i]) {
      const double z = static_cast<double>(mesh.vertices[index].z()) - ground_m;
      low = std::min(low, z);
      high = std::max(high, z);
    }
    for (std::size_t band = 0; band < profile_bands; ++band) {
      if (low < profile_edges_m[band + 1] - least_m && high > profile_edges_m[band] + least_m) {
        by_band[band].push_back(i);
      }
    }
  }
  return by_band;
}

/// Area that a loop encloses, m²; 0 where that is rounding.
double enclosed_m2(const detail::OutlineLoop& loop) {
  double length = 0.0;
  for (std::size_t i = 0; i < loop.points.size(); ++i) {
    length += (loop.points[(i + 1) % loop.points.size()] - loop.points[i]).norm();
  }
  const double area = loop.area_m2();
  return area > least_area_per_length2 * length * length ? area : 0.0;
}

void add_pieces(const detail::BandOutline& outline, const detail::OutlineLoop& loop,
                std::size_t band, double longest_m, std::vector<OutlinePiece>& pieces) {
  // Where a gap was closed there is no surface.
  const HeightRange all{static_cast<float>(profile_edges_m[band]),
                        static_cast<float>(profile_edges_m[band + 1])};
  for (std::size_t i = 0; i < loop.points.size(); ++i) {
    const Vector2d& from = loop.points[i];
    const Vector2d& to = loop.points[(i + 1) % loop.points.size()];
    const Vector2d along = to - from;
    const double length = along.norm();
    if (!(length > 1e-6)) continue;
    const int count = std::max(1, static_cast<int>(std::ceil(length / longest_m - 1e-6)));
    const Vector2d normal(along.y() / length, -along.x() / length);
    for (int k = 0; k < count; ++k) {
      // From the middle: the same bits whichever way the line runs.
      const Vector2d middle = 0.5 * (from + to) + ((2 * k + 1 - count) / (2.0 * count)) * along;
      const Vector2d half = (0.5 / count) * along;
      OutlinePiece piece{static_cast<float>(middle.x()),
                         static_cast<float>(middle.y()),
                         static_cast<float>(normal.x()),
                         static_cast<float>(normal.y()),
                         static_cast<float>(length / count),
                         {},
                         {},
                         {},
                         {}};
      const auto heights = outline.heights(middle - half, middle + half, profile_depth_m);
      piece.behind = heights.behind.empty() ? all : heights.behind;
      piece.at_edge = heights.at_edge.empty() ? piece.behind : heights.at_edge;
      piece.along_x = heights.along_x.empty() ? piece.behind : heights.along_x;
      piece.along_y = heights.along_y.empty() ? piece.behind : heights.along_y;
      pieces.push_back(piece);
    }
  }
}

/// Share of the height of a band that the surface behind the pieces takes up, by their lengths.
double occupied_share(const OutlinePiece* first, const OutlinePiece* last, double height_m) {
  double length = 0.0;
  double occupied = 0.0;
  for (const OutlinePiece* piece = first; piece != last; ++piece) {
    const auto piece_m = static_cast<double>(piece->length_m);
    length += piece_m;
    occupied += piece_m * static_cast<double>(piece->behind.high_m - piece->behind.low_m);
  }
  return length > 0.0 ? std::min(1.0, occupied / (length * height_m)) : 0.0;
}

Result<Profile> profile_of(const TriangleMesh& mesh) {
  // A body that reaches below z = 0 stands on its lowest point, as one whose origin is its middle.
  // What reaches deeper than any vehicle's middle lies has a foundation: of it the uppermost metre
  // counts.
  constexpr double below_ground_m = 0.3;
  constexpr double foundation_m = 2.5;
  constexpr double seen_below_m = 1.0;
  Profile profile;
  const Result<Box> box = surface_bounds(mesh);
  if (!box) return box.error();
  const auto lowest_m = static_cast<double>(box->min.z());
  const bool stands_above =
      static_cast<double>(box->max.z()) > profile_edges_m[lowest_pressing_band];
  const bool has_foundation = lowest_m < -foundation_m && stands_above;
  if (lowest_m < -below_ground_m) profile.ground_m = has_foundation ? -seen_below_m : lowest_m;
  const double longest = static_cast<double>(std::max(box->extent().x(), box->extent().y()));
  const double cell_m = std::clamp(longest / cells_along, finest_cell_m, coarsest_cell_m);
  const double piece_m =
      std::max(std::min(usual_piece_m, longest / 16.0), longest / most_pieces_along);
  const auto triangles = triangles_by_band(mesh, profile.ground_m);
  std::optional<detail::SkyMap> sky;
  for (std::size_t band = 0; band < profile_bands; ++band) {
    profile.first[band] = profile.first_inner[band] =
        static_cast<std::uint32_t>(profile.pieces.size());
    if (triangles[band].empty()) continue;
    const detail::BandSurface surface{&mesh,
                                      &triangles[band],
                                      *box,
                                      profile.ground_m,
                                      profile_edges_m[band],
                                      profile_edges_m[band + 1]};
    const detail::BandOutline outline(surface, cell_m, tolerance_cells, sky);
    double area = 0.0;
    for (const detail::OutlineLoop& loop : outline.loops()) {
      add_pieces(outline, loop, band, piece_m, profile.pieces);
      if (!loop.inner) {
        area += enclosed_m2(loop);
        profile.first_inner[band] = static_cast<std::uint32_t>(profile.pieces.size());
      }
      if (profile.pieces.size() > max_profile_pieces) {
        return make_error(ErrorCode::limit_exceeded,
                          "has outlines of more than 2 million pieces between 0 and 4 m",
                          "simplify it, or check its scale");
      }
    }
    profile.area_m2[band] =
        static_cast<float>(area * occupied_share(profile.pieces.data() + profile.first[band],
                                                 profile.pieces.data() + profile.first_inner[band],
                                                 band_height_m(band)));
  }
  profile.first[profile_bands] = static_cast<std::uint32_t>(profile.pieces.size());
  return profile;
}

}  // namespace

double Profile::volume_m3() const {
  double volume = 0.0;
  for (std::size_t band = 0; band < profile_bands; ++band) {
    volume += static_cast<double>(area_m2[band]) * band_height_m(band);
  }
  return volume;
}

bool Profile::has_inner() const noexcept {
  return !std::equal(first_inner.begin(), first_inner.end(), first.begin() + 1);
}

Profile Profile::filled() const {
  Profile profile = *this;
  profile.pieces.clear();
  for (std::size_t band = 0; band < profile_bands; ++band) {
    profile.first[band] = static_cast<std::uint32_t>(profile.pieces.size());
    profile.pieces.insert(profile.pieces.end(), pieces.begin() + first[band],
                          pieces.begin() + first_inner[band]);
    profile.first_inner[band] = static_cast<std::uint32_t>(profile.pieces.size());
  }
  profile.first[profile_bands] = static_cast<std::uint32_t>(profile.pieces.size());
  return profile;
}

Result<Profile> make_profile(const TriangleMesh& mesh) {
  return detail::guarded([&] { return profile_of(mesh); });
}

}  // namespace crashrank

#include "crashrank/mesh/profile.hpp"

#include "mesh/outline.hpp"

#include "crashrank/internal/base/guarded.hpp"

#include <algorithm>
#include <cmath>

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

/// Section of the mesh by a horizontal plane, body coordinates.
void cut(const TriangleMesh& mesh, double height, std::vector<detail::SectionSegment>& segments) {
  segments.clear();
  for (const auto& triangle : mesh.triangles) {
    std::array<Vector2d, 3> point;
    std::size_t count = 0;
    for (std::size_t e = 0; e < 3; ++e) {
      const Eigen::Vector3d p = mesh.vertices[triangle[e]].cast<double>();
      const Eigen::Vector3d q = mesh.vertices[triangle[(e + 1) % 3]].cast<double>();
      if ((p.z() < height) == (q.z() < height)) continue;
      // From the lower end, whichever way the edge runs: neighbours meet at the same point.
      const Eigen::Vector3d& low = p.z() < q.z() ? p : q;
      const Eigen::Vector3d& high = p.z() < q.z() ? q : p;
      const double t = (height - low.z()) / (high.z() - low.z());
      point[count++] = low.head<2>() + t * (high.head<2>() - low.head<2>());
    }
    if (count == 2) segments.push_back({point[0], point[1]});
  }
}

/// Area that a loop encloses, m²; 0 where that is rounding.
double enclosed_m2(const detail::OutlineLoop& loop) {
  double length = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    length += (loop[(i + 1) % loop.size()] - loop[i]).norm();
  }
  const double area = detail::loop_area_m2(loop);
  return area > least_area_per_length2 * length * length ? area : 0.0;
}

void add_pieces(const detail::OutlineLoop& loop, double longest_m,
                std::vector<OutlinePiece>& pieces) {
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vector2d& from = loop[i];
    const Vector2d along = loop[(i + 1) % loop.size()] - from;
    const double length = along.norm();
    if (!(length > 1e-6)) continue;
    const int count = std::max(1, static_cast<int>(std::ceil(length / longest_m - 1e-6)));
    const Vector2d normal(along.y() / length, -along.x() / length);
    const Vector2d half_sum = 0.5 * (from + loop[(i + 1) % loop.size()]);
    for (int k = 0; k < count; ++k) {
      // From the middle: the same bits whichever way the line runs.
      const Vector2d middle = half_sum + ((2 * k + 1 - count) / (2.0 * count)) * along;
      pieces.push_back({static_cast<float>(middle.x()), static_cast<float>(middle.y()),
                        static_cast<float>(normal.x()), static_cast<float>(normal.y()),
                        static_cast<float>(length / count)});
    }
  }
}

Result<Profile> profile_of(const TriangleMesh& mesh) {
  constexpr double below_ground_m = 0.3;
  constexpr double beside_vertices_m = 1.3e-6;
  Profile profile;
  const Result<Box> box = surface_bounds(mesh);
  if (!box) return box.error();
  if (static_cast<double>(box->min.z()) < -below_ground_m) {
    profile.ground_m = static_cast<double>(box->min.z());
  }
  const double longest = static_cast<double>(std::max(box->extent().x(), box->extent().y()));
  const double cell_m = std::clamp(longest / cells_along, finest_cell_m, coarsest_cell_m);
  const double piece_m =
      std::max(std::min(usual_piece_m, longest / 16.0), longest / most_pieces_along);
  std::vector<detail::SectionSegment> segments;
  for (std::size_t band = 0; band < profile_bands; ++band) {
    profile.first[band] = static_cast<std::uint32_t>(profile.pieces.size());
    const double middle = 0.5 * (profile_edges_m[band] + profile_edges_m[band + 1]);
    cut(mesh, profile.ground_m + middle + beside_vertices_m, segments);
    double area = 0.0;
    for (const detail::OutlineLoop& loop :
         detail::trace_outlines(segments, cell_m, tolerance_cells * cell_m)) {
      add_pieces(loop, piece_m, profile.pieces);
      area += enclosed_m2(loop);
      if (profile.pieces.size() > max_profile_pieces) {
        return make_error(ErrorCode::limit_exceeded,
                          "has outlines of more than 2 million pieces between 0 and 4 m",
                          "simplify it, or check its scale");
      }
    }
    profile.area_m2[band] = static_cast<float>(area);
  }
  profile.first[profile_bands] = static_cast<std::uint32_t>(profile.pieces.size());
  if (profile.volume_m3() > 0.0) return profile;
  Profile without_outline;
  without_outline.ground_m = profile.ground_m;
  return without_outline;
}

}  // namespace

double Profile::volume_m3() const {
  double volume = 0.0;
  for (std::size_t band = 0; band < profile_bands; ++band) {
    volume +=
        static_cast<double>(area_m2[band]) * (profile_edges_m[band + 1] - profile_edges_m[band]);
  }
  return volume;
}

Result<Profile> make_profile(const TriangleMesh& mesh) {
  return detail::guarded([&] { return profile_of(mesh); });
}

}  // namespace crashrank

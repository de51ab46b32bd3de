#include "crashrank/mesh/properties.hpp"

#include "mesh/degenerate.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <numeric>

namespace crashrank {
namespace {

using CornerIndices = std::array<std::uint32_t, 3>;

// Number of the position of each vertex: equal positions share one, −0 equals 0.
std::vector<std::uint32_t> weld(View<const Eigen::Vector3f> vertices) {
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0U);
  // A total order over all bit patterns, so that vertices that are not finite sort as well.
  const auto key = [&](std::uint32_t i) {
    std::array<std::uint32_t, 3> bits{};
    for (int axis = 0; axis < 3; ++axis) {
      const float value = vertices[i][axis] == 0.0F ? 0.0F : vertices[i][axis];
      std::memcpy(&bits[static_cast<std::size_t>(axis)], &value, sizeof value);
    }
    return bits;
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  std::vector<std::uint32_t> position(vertices.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && key(order[i]) == key(order[i - 1]);
    position[order[i]] = same ? position[order[i - 1]] : order[i];
  }
  return position;
}

struct Edge {
  std::uint32_t low;
  std::uint32_t high;
  bool forward;  // from low to high
};

void count_edges(std::vector<Edge>& edges, MeshQuality& quality) {
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.low != b.low ? a.low < b.low : a.high < b.high;
  });
  for (std::size_t first = 0; first < edges.size();) {
    std::size_t end = first + 1;
    while (end < edges.size() && edges[end].low == edges[first].low &&
           edges[end].high == edges[first].high) {
      ++end;
    }
    const std::size_t sharing = end - first;
    if (sharing == 1) ++quality.open_edges;
    if (sharing > 2) ++quality.crowded_edges;
    if (sharing == 2 && edges[first].forward == edges[first + 1].forward) ++quality.reversed_edges;
    first = end;
  }
}

std::size_t count_duplicates(std::vector<CornerIndices>& sorted_corners) {
  std::sort(sorted_corners.begin(), sorted_corners.end());
  std::size_t duplicates = 0;
  for (std::size_t i = 1; i < sorted_corners.size(); ++i) {
    if (sorted_corners[i] == sorted_corners[i - 1]) ++duplicates;
  }
  return duplicates;
}

std::string metres(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g m", value);
  return text.data();
}

std::string count(std::size_t number, const char* thing) {
  return std::to_string(number) + " " + thing + (number == 1 ? "" : "s");
}

void warn(MeshQuality& quality, const TriangleMesh& mesh, double farthest) {
  std::vector<std::string>& out = quality.warnings;
  if (mesh.triangles.empty()) out.emplace_back("the mesh has no triangles");
  if (quality.non_finite_vertices > 0) {
    out.push_back(count(quality.non_finite_vertices, "vertex position") + " not finite");
  }
  if (quality.degenerate_triangles > 0) {
    out.push_back(count(quality.degenerate_triangles, "degenerate triangle") +
                  " (no area; kept, they collide as segments or points)");
  }
  if (quality.duplicate_triangles > 0) {
    out.push_back(count(quality.duplicate_triangles, "duplicate triangle") +
                  " (kept; each is a polygon of its own in every count)");
  }
  if (quality.reversed_edges > 0) {
    out.push_back(count(quality.reversed_edges, "edge") +
                  " between triangles that disagree about which side is out");
  }
  const double largest = quality.extent_m.maxCoeff();
  if (largest > 0.0 && largest < min_plausible_extent_m) {
    out.push_back("largest extent " + metres(largest) +
                  " is small for a road user; if the file is not in metres, give the scale");
  }
  if (largest > max_plausible_extent_m) {
    out.push_back("largest extent " + metres(largest) +
                  " is large for a road vehicle; if the file is not in metres, give the scale");
  }
  // float32 has 24 bits: beyond this distance neighbouring coordinates are 1 mm apart.
  constexpr double coarse_m = 1e-3 * 8388608.0;
  if (farthest > coarse_m && farthest > 10.0 * largest) {
    out.push_back(
        "vertices lie up to " + metres(farthest) +
        " from the origin, where single precision resolves no millimetre; give an origin");
  }
}

}  // namespace

MeshQuality assess(const TriangleMesh& mesh) {
  MeshQuality quality;
  std::vector<bool> finite(mesh.vertices.size());
  for (std::size_t i = 0; i < finite.size(); ++i) {
    finite[i] = mesh.vertices[i].allFinite();
    if (!finite[i]) ++quality.non_finite_vertices;
  }

  const std::vector<std::uint32_t> position = weld(mesh.vertices);
  std::vector<Edge> edges;
  std::vector<CornerIndices> corners;
  edges.reserve(3 * mesh.size());
  corners.reserve(mesh.size());
  Box bounds;
  for (const CornerIndices& v : mesh.triangles) {
    if (!finite[v[0]] || !finite[v[1]] || !finite[v[2]]) continue;
    const Triangle triangle{{mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]}};
    for (const Eigen::Vector3f& corner : triangle.corner) bounds.grow(corner);
    CornerIndices p{position[v[0]], position[v[1]], position[v[2]]};
    if (degenerate(triangle)) {
      ++quality.degenerate_triangles;
    } else {
      const Eigen::Vector3d a = triangle.corner[0].cast<double>();
      const Eigen::Vector3d b = triangle.corner[1].cast<double>() - a;
      const Eigen::Vector3d c = triangle.corner[2].cast<double>() - a;
      quality.area_m2 += 0.5 * b.cross(c).norm();
    }
    if (p[0] != p[1] && p[1] != p[2] && p[2] != p[0]) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t from = p[i];
        const std::uint32_t to = p[(i + 1) % 3];
        edges.push_back({std::min(from, to), std::max(from, to), from < to});
      }
    }
    std::sort(p.begin(), p.end());
    corners.push_back(p);
  }
  quality.duplicate_triangles = count_duplicates(corners);
  count_edges(edges, quality);
  quality.watertight = !edges.empty() && quality.non_finite_vertices == 0 &&
                       quality.open_edges == 0 && quality.crowded_edges == 0;
  double farthest = 0.0;
  if (!bounds.empty()) {
    quality.extent_m = bounds.max.cast<double>() - bounds.min.cast<double>();
    farthest = std::max(bounds.max.cwiseAbs().maxCoeff(), bounds.min.cwiseAbs().maxCoeff());
  }
  warn(quality, mesh, farthest);
  return quality;
}

}  // namespace crashrank

#include "report/page_mesh.hpp"

#include "crashrank/base/box.hpp"
#include "report/base64.hpp"
#include "report/palette.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

namespace crashrank::detail {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
constexpr float steps = 65535.0F;

std::string hex(const Colour& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", srgb(colour.red), srgb(colour.green),
                     srgb(colour.blue));
}

double area_m2(const TriangleMesh& mesh) {
  double area = 0.0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const Triangle t = mesh.triangle(i);
    const Eigen::Vector3d a = t.corner[0].cast<double>();
    area += 0.5 * (t.corner[1].cast<double>() - a).cross(t.corner[2].cast<double>() - a).norm();
  }
  return area;
}

struct CornersHash {
  std::size_t operator()(const std::array<std::uint32_t, 3>& corners) const {
    std::uint64_t hash = 0;
    for (const std::uint32_t corner : corners) hash = (hash ^ corner) * 0x9e3779b97f4a7c15U;
    return hash ^ hash >> 29U;
  }
};

void append_run(std::string& bytes, std::uint32_t length) {
  for (; length >= 0x80U; length >>= 7U) bytes += static_cast<char>((length & 0x7fU) | 0x80U);
  bytes += static_cast<char>(length);
}

}  // namespace

PageMesh::PageMesh(const TriangleMesh& mesh, std::size_t most_triangles) {
  for (const Part& part : mesh.parts) parts_.push_back(part.name);
  // A cell's number along an axis has 21 bits.
  constexpr double least_m = 1e-4;
  const Box box = mesh.bounds();
  const double finest_m =
      box.empty() ? least_m
                  : std::max(least_m, 1e-6 * static_cast<double>(box.extent().maxCoeff()));
  join_corners(mesh, finest_m);
  constexpr double growth = 1.15;
  const double budget = static_cast<double>(std::max<std::size_t>(1, most_triangles));
  double cell_m = std::max(finest_m, std::sqrt(0.8 * area_m2(mesh) / budget));
  // Three corners a triangle is all that 16 bits can number for certain.
  while (triangles_.size() > most_triangles && std::isfinite(cell_m)) {
    join_corners(mesh, cell_m);
    cell_m *= growth;
  }
}

void PageMesh::join_corners(const TriangleMesh& mesh, double cell_m) {
  corners_.clear();
  triangles_.clear();
  part_of_.clear();
  kept_of_.assign(mesh.size(), none);
  const Eigen::Vector3f origin = mesh.bounds().min;
  std::unordered_map<std::uint64_t, std::uint32_t> cells;
  std::vector<std::uint32_t> cell_of(mesh.vertices.size());
  std::vector<float> joined;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3f& vertex = mesh.vertices[i];
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double at = static_cast<double>(vertex[axis] - origin[axis]) / cell_m;
      key = key << 21U | std::min<std::uint64_t>(static_cast<std::uint64_t>(at), 0x1fffffU);
    }
    const auto [cell, is_new] = cells.try_emplace(key, static_cast<std::uint32_t>(corners_.size()));
    cell_of[i] = cell->second;
    if (is_new) {
      corners_.push_back(vertex);
      joined.push_back(1.0F);
    } else {
      joined[cell_of[i]] += 1.0F;
      corners_[cell_of[i]] += (vertex - corners_[cell_of[i]]) / joined[cell_of[i]];
    }
  }
  std::unordered_map<std::array<std::uint32_t, 3>, std::uint32_t, CornersHash> known;
  for (std::uint32_t part = 0; part < mesh.parts.size(); ++part) {
    const std::uint32_t first = mesh.parts[part].first_triangle;
    for (std::uint32_t i = first; i < first + mesh.parts[part].triangle_count; ++i) {
      std::array<std::uint32_t, 3> corners = mesh.triangles[i];
      for (std::uint32_t& corner : corners) corner = cell_of[corner];
      if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) {
        continue;
      }
      std::array<std::uint32_t, 3> key = corners;
      std::sort(key.begin(), key.end());
      const auto [same, is_new] =
          known.try_emplace(key, static_cast<std::uint32_t>(triangles_.size()));
      kept_of_[i] = same->second;
      if (!is_new) continue;
      triangles_.push_back(corners);
      part_of_.push_back(part);
    }
  }
  fill_gaps(cell_of, mesh);
}

/// A triangle that became a line or a point is stood for by one at its place.
void PageMesh::fill_gaps(const std::vector<std::uint32_t>& cell_of, const TriangleMesh& mesh) {
  std::vector<std::uint32_t> at_corner(corners_.size(), none);
  for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
    for (const std::uint32_t corner : triangles_[i]) at_corner[corner] = i;
  }
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    for (const std::uint32_t corner : mesh.triangles[i]) {
      if (kept_of_[i] == none) kept_of_[i] = at_corner[cell_of[corner]];
    }
  }
}

Json PageMesh::json() const {
  Box box;
  for (const Eigen::Vector3f& corner : corners_) box.grow(corner);
  if (box.empty()) box.grow(Eigen::Vector3f::Zero());
  const Eigen::Vector3f step = (box.extent() / steps).cwiseMax(1e-9F);
  std::vector<std::uint16_t> positions;
  for (const Eigen::Vector3f& corner : corners_) {
    for (int axis = 0; axis < 3; ++axis) {
      const float at = std::round((corner[axis] - box.min[axis]) / step[axis]);
      positions.push_back(static_cast<std::uint16_t>(std::clamp(at, 0.0F, steps)));
    }
  }
  std::vector<std::uint16_t> indices;
  for (const auto& triangle : triangles_) {
    for (const std::uint32_t corner : triangle) {
      indices.push_back(static_cast<std::uint16_t>(corner));
    }
  }
  Json parts = Json::array();
  for (std::size_t i = 0; i < triangles_.size();) {
    std::size_t end = i;
    while (end < triangles_.size() && part_of_[end] == part_of_[i]) ++end;
    const std::string& name = parts_[part_of_[i]];
    parts.push_back(
        {i, end - i, hex(part_colour(name, ego_paint)), hex(part_colour(name, other_paint))});
    i = end;
  }
  return {{"triangles", triangles_.size()},
          {"of", kept_of_.size()},
          {"origin", {box.min.x(), box.min.y(), box.min.z()}},
          {"step", {step.x(), step.y(), step.z()}},
          {"positions", base64(positions.data(), positions.size() * sizeof positions[0])},
          {"indices", base64(indices.data(), indices.size() * sizeof indices[0])},
          {"parts", std::move(parts)}};
}

std::string PageMesh::damage(View<const std::uint32_t> damaged) const {
  std::vector<bool> flags(triangles_.size(), false);
  for (const std::uint32_t triangle : damaged) {
    if (kept_of_[triangle] != none) flags[kept_of_[triangle]] = true;
  }
  std::string bytes;
  std::uint32_t length = 0;
  bool value = false;
  for (const bool flag : flags) {
    if (flag != value) {
      append_run(bytes, std::exchange(length, 0U));
      value = flag;
    }
    ++length;
  }
  if (value) append_run(bytes, length);
  return base64(bytes.data(), bytes.size());
}

}  // namespace crashrank::detail

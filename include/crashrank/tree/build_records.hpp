#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/tree/projection.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace crashrank::detail {

/// What the splitting of one triangle needs: its box along the tree's axes and its index. 32 bytes,
/// moved as a whole, so that every pass over a node reads memory in order.
struct BuildRecord {
  float min[3];
  std::uint32_t index;
  float max[3];
  std::uint32_t unused;
};

/// Four lanes for three axes; the fourth is never looked at.
using Lanes = Eigen::Array4f;

/// Box of a set of records in lanes.
struct LaneBox {
  Lanes min = Lanes::Constant(std::numeric_limits<float>::infinity());
  Lanes max = Lanes::Constant(-std::numeric_limits<float>::infinity());

  void grow(const LaneBox& other) {
    min = min.min(other.min);
    max = max.max(other.max);
  }
  Box box() const { return {min.head<3>(), max.head<3>()}; }
};

inline Lanes low(const BuildRecord& record) {
  return {record.min[0], record.min[1], record.min[2], 0};
}
inline Lanes high(const BuildRecord& record) {
  return {record.max[0], record.max[1], record.max[2], 0};
}

/// Centre of a record's box on one axis. Halved before the sum: finite for every finite box.
inline float middle(const BuildRecord& record, int axis) {
  return 0.5F * record.min[axis] + 0.5F * record.max[axis];
}

inline Box bounds(View<const BuildRecord> records) {
  LaneBox box;
  for (const BuildRecord& record : records) box.grow({low(record), high(record)});
  return box.box();
}

/// Refuses meshes no tree can be built over.
inline Status check_mesh(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) {
    return make_error(ErrorCode::bad_input, "the mesh has no triangle");
  }
  if (mesh.triangles.size() > max_triangles) {
    return make_error(ErrorCode::limit_exceeded,
                      "the mesh has more than " + std::to_string(max_triangles) + " triangles");
  }
  const std::size_t vertices = mesh.vertices.size();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t vertex : mesh.triangles[i]) {
      if (vertex >= vertices) {
        Error error = make_error(ErrorCode::bad_input, "vertex " + std::to_string(vertex) +
                                                           " does not exist (the mesh has " +
                                                           std::to_string(vertices) + ")");
        error.place = "triangle " + std::to_string(i);
        return error;
      }
    }
  }
  for (std::size_t i = 0; i < vertices; ++i) {
    if (!mesh.vertices[i].allFinite()) {
      Error error = make_error(ErrorCode::bad_input, "a coordinate is not a finite number");
      error.place = "vertex " + std::to_string(i);
      return error;
    }
  }
  return Success{};
}

/// Records along the body's own axes: minima and maxima of float32 coordinates, nothing rounded.
inline std::vector<BuildRecord> world_records(const TriangleMesh& mesh) {
  std::vector<BuildRecord> records(mesh.triangles.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    const std::array<std::uint32_t, 3>& t = mesh.triangles[i];
    const Eigen::Vector3f& a = mesh.vertices[t[0]];
    const Eigen::Vector3f& b = mesh.vertices[t[1]];
    const Eigen::Vector3f& c = mesh.vertices[t[2]];
    BuildRecord& record = records[i];
    for (int k = 0; k < 3; ++k) {
      record.min[k] = std::min(std::min(a[k], b[k]), c[k]);
      record.max[k] = std::max(std::max(a[k], b[k]), c[k]);
    }
    record.index = static_cast<std::uint32_t>(i);
    record.unused = 0;
  }
  return records;
}

/// Records along other axes, from projections that are rounded outward: each box encloses its
/// triangle, which is the convex hull of three points that it encloses.
inline Result<std::vector<BuildRecord>> projected_records(const TriangleMesh& mesh,
                                                          const Eigen::Matrix3d& axes) {
  std::vector<BuildRecord> records(mesh.triangles.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    BuildRecord& record = records[i];
    for (int k = 0; k < 3; ++k) {
      record.min[k] = std::numeric_limits<float>::infinity();
      record.max[k] = -std::numeric_limits<float>::infinity();
      for (const std::uint32_t vertex : mesh.triangles[i]) {
        const FloatInterval p = project(axes, k, mesh.vertices[vertex]);
        record.min[k] = std::min(record.min[k], p.low);
        record.max[k] = std::max(record.max[k], p.high);
      }
      if (!std::isfinite(record.min[k]) || !std::isfinite(record.max[k])) {
        Error error =
            make_error(ErrorCode::bad_input, "coordinates too large to turn into another frame",
                       "check the unit of the file, or keep the boxes along world axes");
        error.place = "triangle " + std::to_string(i);
        return error;
      }
    }
    record.index = static_cast<std::uint32_t>(i);
    record.unused = 0;
  }
  return records;
}

}  // namespace crashrank::detail

#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/internal/base/huge_pages.hpp"
#include "crashrank/internal/tree/lanes.hpp"
#include "crashrank/internal/tree/projection.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <string>

namespace crashrank::detail {

/// What the splitting of one triangle needs: its box along the tree's axes and its index. 32 bytes,
/// moved as a whole, so that every pass over a node reads memory in order.
struct alignas(16) BuildRecord {
  float min[3];
  std::uint32_t index;
  float max[3];
  std::uint32_t unused;
};

/// The box of a record; the fourth lane holds what lies beside it, as whatever float it makes.
inline LaneBox lanes(const BuildRecord& record) {
  LaneBox box;
  std::memcpy(&box.min, record.min, sizeof box.min);
  std::memcpy(&box.max, record.max, sizeof box.max);
  return box;
}

/// A whole record in two vectors, to be moved.
struct RecordBits {
  IntLanes low;
  IntLanes high;
};

inline RecordBits load(const BuildRecord& record) {
  RecordBits bits;
  std::memcpy(&bits.low, record.min, sizeof bits.low);
  std::memcpy(&bits.high, record.max, sizeof bits.high);
  return bits;
}

inline void store(const RecordBits& bits, BuildRecord& record) {
  std::memcpy(record.min, &bits.low, sizeof bits.low);
  std::memcpy(record.max, &bits.high, sizeof bits.high);
}

/// Twice the centre of a record's box.
inline Lanes middle(const LaneBox& record_box) { return three(record_box.min + record_box.max); }

inline LaneBox bounds(View<const BuildRecord> records) {
  LaneBox box = LaneBox::empty();
  for (const BuildRecord& record : records) box.grow(lanes(record));
  return box;
}

/// Memory that begins without values: arrays that are written before they are read, and large
/// enough that writing them twice would take noticeable time.
template <class T> class RawArray {
public:
  explicit RawArray(std::size_t size) : items_(new T[size]), size_(size) {
    prefer_huge_pages_early(items_.get(), size * sizeof(T));
  }

  std::size_t size() const { return size_; }
  T* data() const { return items_.get(); }
  T& operator[](std::size_t i) const { return items_[i]; }

private:
  std::unique_ptr<T[]> items_;
  std::size_t size_;
};

/// Refuses what no tree can be built over in some triangles of a mesh and in some of its vertices.
inline Status check_part(const TriangleMesh& mesh, std::size_t triangle, std::size_t triangles_end,
                         std::size_t vertex, std::size_t vertices_end) {
  const std::size_t vertices = mesh.vertices.size();
  for (std::size_t i = triangle; i < triangles_end; ++i) {
    for (const std::uint32_t corner : mesh.triangles[i]) {
      if (corner >= vertices) {
        Error error = make_error(ErrorCode::bad_input, "vertex " + std::to_string(corner) +
                                                           " does not exist (the mesh has " +
                                                           std::to_string(vertices) + ")");
        error.place = "triangle " + std::to_string(i);
        return error;
      }
    }
  }
  for (std::size_t i = vertex; i < vertices_end; ++i) {
    if (!mesh.vertices[i].allFinite()) {
      Error error = make_error(ErrorCode::bad_input, "a coordinate is not a finite number");
      error.place = "vertex " + std::to_string(i);
      return error;
    }
  }
  return Success{};
}

/// Refuses meshes with no triangle or too many.
inline Status check_size(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) {
    return make_error(ErrorCode::bad_input, "the mesh has no triangle");
  }
  if (mesh.triangles.size() > max_triangles) {
    return make_error(ErrorCode::limit_exceeded,
                      "the mesh has more than " + std::to_string(max_triangles) + " triangles");
  }
  return Success{};
}

/// Writes records along the body's own axes for some triangles: minima and maxima of float32
/// coordinates, nothing rounded.
inline void write_world_records(const TriangleMesh& mesh, std::size_t first, std::size_t last,
                                View<BuildRecord> records) {
  for (std::size_t i = first; i < last; ++i) {
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
}

/// The same along other axes, from projections that are rounded outward: each box encloses its
/// triangle, which is the convex hull of three points that it encloses.
inline Status write_projected_records(const TriangleMesh& mesh, const Eigen::Matrix3d& axes,
                                      View<BuildRecord> records) {
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
  return Success{};
}

}  // namespace crashrank::detail

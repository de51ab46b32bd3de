#pragma once

#include "crashrank/mesh/triangle_mesh.hpp"
#include "mesh/importer/request.hpp"
#include "mesh/importer/vertex_pool.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace crashrank::importer {

/// Collects parts into one mesh in body coordinates, rounded to float32 once.
class MeshBuilder {
public:
  /// `metres_per_unit` is the file's own unit.
  MeshBuilder(const Request& request, double metres_per_unit)
      : transform_(request.transform), max_vertices_(request.vertices) {
    transform_.scale *= metres_per_unit;
  }

  /// `mirrored` turns the triangles over: a rotation and a positive scale follow.
  void begin_part(const std::string& name, std::size_t vertices, bool mirrored) {
    part_.name = name;
    part_.first_triangle = static_cast<std::uint32_t>(mesh_.triangles.size());
    mirrored_ = mirrored;
    place_.assign(vertices, unseen);
    bad_vertex_ = unseen;
  }

  /// `position(i)` is vertex i in file coordinates; it is called once for each vertex in use.
  /// Corners must be less than the number of vertices.
  template <class Position>
  void add(std::array<std::uint32_t, 3> corners, const Position& position) {
    for (std::uint32_t& corner : corners) {
      std::uint32_t& place = place_[corner];
      if (place == unseen) {
        const Eigen::Vector3f body = apply(transform_, position(corner)).template cast<float>();
        if (!body.allFinite()) {
          bad_vertex_ = corner;
          return;
        }
        place = pool_.index_of(body);
      }
      corner = place;
    }
    if (mirrored_) std::swap(corners[1], corners[2]);
    mesh_.triangles.push_back(corners);
  }

  /// Errors: bad_input for a vertex that is not finite, limit_exceeded.
  Status end_part() {
    if (bad_vertex_ != unseen) {
      Error error = make_error(ErrorCode::bad_input,
                               "its coordinates are not finite numbers of single precision",
                               "export the file again");
      error.place = "part '" + part_.name + "', vertex " + std::to_string(bad_vertex_);
      return error;
    }
    if (pool_.vertices().size() > max_vertices_) {
      return make_error(ErrorCode::limit_exceeded,
                        "more than " + std::to_string(max_vertices_) + " vertices",
                        "simplify the mesh or raise the limit");
    }
    part_.triangle_count =
        static_cast<std::uint32_t>(mesh_.triangles.size()) - part_.first_triangle;
    if (part_.triangle_count > 0) mesh_.parts.push_back(part_);
    return Success{};
  }

  TriangleMesh take() {
    mesh_.vertices = pool_.take();
    return std::move(mesh_);
  }

private:
  static constexpr std::uint32_t unseen = std::numeric_limits<std::uint32_t>::max();

  ImportTransform transform_;
  std::size_t max_vertices_;
  TriangleMesh mesh_;
  VertexPool pool_;
  Part part_;
  bool mirrored_ = false;
  std::vector<std::uint32_t> place_;  // of each vertex of the part in the pool
  std::uint32_t bad_vertex_ = unseen;
};

}  // namespace crashrank::importer

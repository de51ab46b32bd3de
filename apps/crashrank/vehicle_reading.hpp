#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/vehicle/vehicle.hpp"
#include "report/orientation.hpp"

#include <Eigen/Core>

#include <string>

namespace crashrank::cli {

/// Kind of a body by words in the stem of its file's name, else by wheels and size in the file's
/// axes.
BodyKind guess_kind(const std::string& stem, const Eigen::Vector3d& extent_m, bool has_wheels);

/// Whether a body of that kind moves along its own axis.
bool drives(BodyKind kind);

/// Axles of a body in its own axes, m.
struct SeenAxles {
  double rear_x_m = 0.0;
  double wheelbase_m = 0.0;  ///< 0: of a kind without axles
  bool by_wheels = false;    ///< else where its kind usually has them
};

SeenAxles find_axles(const TriangleMesh& mesh, BodyKind kind);

/// The point of a body in its own axes that should become its origin: on the ground, of vehicles
/// below the rear axle, of others below the middle. What is nearer than 0.3 m to 0 stays there.
Eigen::Vector3d guess_origin(const TriangleMesh& mesh, const SeenAxles& axles);

/// Scales and turns the mesh of a body that drives as `reading` suggests. Returns that and its
/// guessed origin, which the mesh is not moved to; `axles` become those of the turned mesh.
Result<ImportTransform> guess_transform(TriangleMesh& mesh, BodyKind kind,
                                        const detail::MeshReading& reading, SeenAxles& axles);

/// "--scale 0.0254 --up +z --forward -y --origin -1.3,0,0".
std::string options_text(const ImportTransform& transform);

}  // namespace crashrank::cli

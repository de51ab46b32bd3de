#pragma once

#include "crashrank/mesh/triangle_mesh.hpp"

#include <Eigen/Core>

#include <string>

namespace crashrank::detail {

/// How a mesh would have to be read to be a vehicle that stands on its wheels.
struct MeshReading {
  double scale = 1.0;                 ///< metres per unit of the file
  Axis up = Axis::plus_z;             ///< the file's axis
  Axis forward = Axis::plus_x;        ///< the file's axis
  bool front_known = false;           ///< otherwise the opposite of `forward` may be meant
  const char* shown_by = "its size";  ///< or "its parts", "its shape", ...: what shows the axes
  /// Of a body with wheels on both sides that is shorter than cars are: the scales, metres per unit
  /// of the file, that would make its length, width and wheels those of a car. 0 for others.
  double least_car_scale = 0.0;
  double most_car_scale = 0.0;
  double length_m = 0.0;  ///< with `scale`, along `forward`

  /// Whether a mesh that was read with `transform` has these axes. Without knowledge of the front
  /// the opposite of `forward` counts, too.
  bool has_axes_of(const ImportTransform& transform) const;
  bool has_scale_of(const ImportTransform& transform) const;
  /// "--scale 0.0254 --up +z --forward -y".
  std::string options() const;
  /// That the body is small for a car, and the scales that would make it one; empty for others.
  std::string size_doubt() const;
};

/// Guesses the reading of a vehicle's mesh, which `transform` led to: from the places of parts that
/// are named after wheels, front and rear, else from what the format says (glTF 2.0, section 3.4:
/// +y up, +z forward), else from length, width, height and `front_by_shape`. O(triangles).
MeshReading guess_reading(const TriangleMesh& mesh, const ImportTransform& transform, bool is_gltf);

/// Whether a file is glTF or GLB, by its name.
bool is_gltf_file(const std::string& path);

/// Whether parts are named after wheels.
bool has_wheels(const TriangleMesh& mesh);

/// Whether some vehicle is of that size, whichever way it is turned; the longest are trams.
bool has_vehicle_size(const Eigen::Vector3d& extent_m);

}  // namespace crashrank::detail

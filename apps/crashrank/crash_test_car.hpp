#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <optional>
#include <string>

namespace crashrank::cli {

/// Car mesh that is stretched to the size of each test's car.
struct RigCar {
  TriangleMesh mesh;  ///< origin on the ground under the rear axle
  double wheelbase_m = 0.0;
  double width_m = 0.0;  ///< without mirrors
};

/// Outer size of a car, m.
struct CarSize {
  double length_m = 0.0;
  double width_m = 0.0;  ///< without mirrors
  double height_m = 0.0;
  double wheelbase_m = 0.0;
  std::optional<double> rear_overhang_m;  ///< absent: both overhangs are scaled alike
};

/// Mesh to simulate a test with.
enum class RigShape {
  meshes,
  boxes,  ///< bounding boxes of both bodies, for comparison
};

/// The shipped saloon: beside the program's data when installed, in a folder above the program or
/// the working folder otherwise. Errors: not_found.
Result<std::string> find_rig_car();

/// Reads a car mesh and its size from models.json beside it. Errors: bad_input where models.json
/// has no wheelbase and width of it; as `import_mesh`.
Result<RigCar> load_rig_car(const std::string& path);

/// The car scaled piecewise along x (rear overhang, wheelbase, front overhang) and uniformly in
/// width and height. The origin stays on the ground under the rear axle.
TriangleMesh stretched_car(const RigCar& car, const CarSize& size);

/// Bounding box of the stretched car, as wide as the car without mirrors.
TriangleMesh car_box(const TriangleMesh& car, double width_m);

}  // namespace crashrank::cli

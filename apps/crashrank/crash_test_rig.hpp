#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/crash/pulse.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <string>

namespace crashrank::cli {

/// What a car is driven into. All are rigid but the honeycomb.
enum class Barrier {
  wall,        ///< steel face; the overlap is counted to the outermost point of its rounded corner
  flat,        ///< the overlap is counted on the flat face, the rounded corner comes on top
  pole,        ///< upright cylinder
  deformable,  ///< aluminium honeycomb before a rigid block
};

Result<Barrier> barrier_from_name(const std::string& name);

/// One crash test: a car, and how it meets a barrier on its left. SI units.
struct CrashTest {
  std::string id;
  double length_m = 0.0;
  double width_m = 0.0;
  double height_m = 0.0;
  double wheelbase_m = 0.0;
  double mass_kg = 0.0;
  double izz_kgm2 = 0.0;
  Barrier barrier = Barrier::wall;
  double radius_m = 0.0;
  double overlap = 0.0;  ///< share of the width that the barrier covers
  double speed_mps = 0.0;
};

/// Yaw inertia where none is given: the radius of gyration is 0.29 of the length, as published for
/// a mid-size saloon of 4.84 m, 1,621 kg and 3,167 kg·m².
double guess_izz_kgm2(double mass_kg, double length_m);

/// The car that is stretched to each test's measures.
struct RigCar {
  TriangleMesh mesh;  ///< origin on the ground under the rear axle
  double wheelbase_m = 0.0;
  double width_m = 0.0;         ///< without mirrors
  double center_of_mass = 0.0;  ///< before the rear axle, in wheelbases
  double center_height_m = 0.0;
};

enum class RigShape {
  meshes,
  boxes,  ///< car and barrier are replaced by their bounding boxes, for comparison
};

/// Drives the car into the barrier: first contact of the meshes, then the pulse. Friction is 0.1 on
/// steel, what sheet metal does on steel at high pressure and speed (0.1 to 0.2), and 0.5 on the
/// honeycomb, which folds around what enters it; nobody brakes. Errors: as `make_model`.
Result<PulseResult> run_crash_test(const RigCar& car, const CrashTest& test, RigShape shape);

}  // namespace crashrank::cli

#pragma once

#include "crash_test_car.hpp"
#include "crash_test_rank.hpp"

#include "crashrank/base/result.hpp"

#include <optional>
#include <string>

namespace crashrank::cli {

/// Obstacle of a crash test. All are rigid but the honeycomb.
enum class Barrier {
  wall,        ///< steel face; the overlap is counted to the outermost point of its rounded corner
  flat,        ///< the overlap is counted on the flat face, the rounded corner comes on top
  pole,        ///< upright cylinder
  deformable,  ///< aluminium honeycomb before a rigid block
  full,        ///< steel wall over the full width; radius and overlap have no effect
};

Result<Barrier> barrier_from_name(const std::string& name);

/// Crash test of a car into a barrier on its left. SI units.
struct CrashTest {
  std::string id;
  CarSize size;
  double mass_kg = 0.0;
  std::optional<double> izz_kgm2;  ///< absent: derived as for a ranking
  Barrier barrier = Barrier::wall;
  double radius_m = 0.0;
  double overlap = 0.0;  ///< share of the width that the barrier covers
  double speed_mps = 0.0;
};

/// Ranks the crash of the car, the ego, into the barrier. The barrier is steel; its honeycomb folds
/// around what enters it. Errors: as `make_model` and `rank`.
Result<Crash> run_crash_test(const RigCar& car, const CrashTest& test, RigShape shape);

}  // namespace crashrank::cli

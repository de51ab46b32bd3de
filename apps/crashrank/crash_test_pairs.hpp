#pragma once

#include "crash_test_car.hpp"
#include "crash_test_rank.hpp"
#include "crash_test_table.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace crashrank::cli {

/// One of two cars that drive into each other.
struct PairedCar {
  CarSize size;
  double mass_kg = 0.0;
  std::optional<double> izz_kgm2;  ///< absent: derived as for a ranking
  double cg_ahead_of_rear_axle_m = 0.0;
  double x_m = 0.0;  ///< of the centre of mass, at first contact or before
  double y_m = 0.0;
  double heading_deg = 0.0;  ///< counter-clockwise from x
  double speed_mps = 0.0;
  std::optional<double> measured_delta_v_mps;
  std::optional<double> measured_yaw_rate_dps;  ///< change, left positive
};

/// A crash between two cars.
struct PairTest {
  std::string id;
  std::array<PairedCar, 2> cars;
};

/// What such a crash came to.
struct PairOutcome {
  Crash crash;  ///< with the first car as the ego
  /// The ranking with the second car as the ego has the same bits.
  bool roles_agree = false;
};

/// True for tables with the columns of two cars.
bool is_pair_table(const TestTable& table);

/// Reads the rows of a table of crashes between cars. Errors: bad_input with line and column.
Result<std::vector<PairTest>> read_pair_rows(const TestTable& table);

/// Moves both cars back by 0.3 s, drives them straight on until first contact within 5 s, and ranks
/// the crash with either car as the ego. Without contact nothing acts. Errors: bad_input where the
/// cars overlap at the start; as `make_model` and `rank`.
Result<PairOutcome> run_pair_test(const RigCar& car, const PairTest& test, RigShape shape);

}  // namespace crashrank::cli

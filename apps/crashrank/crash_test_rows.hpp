#pragma once

#include "crash_test_rig.hpp"
#include "crash_test_table.hpp"

#include <optional>
#include <vector>

namespace crashrank::cli {

/// A crash of a car into a barrier, with what was measured where the table says so.
struct CrashTestRow {
  CrashTest test;
  std::optional<double> measured_delta_v_mps;
  std::optional<double> measured_yaw_rate_dps;
};

/// Reads the rows of a table of crashes into barriers. Errors: bad_input with line and column for
/// what is missing, not a number or out of range.
Result<std::vector<CrashTestRow>> read_barrier_rows(const TestTable& table);

}  // namespace crashrank::cli

#pragma once

#include "crash_test_rig.hpp"

#include <optional>
#include <string>
#include <vector>

namespace crashrank::cli {

/// A row of a table of crash tests, with what was measured where the table says so.
struct CrashTestRow {
  CrashTest test;
  std::optional<double> measured_delta_v_mps;
  std::optional<double> measured_yaw_rate_dps;
};

/// Reads comma-separated rows under a header line that names their columns, in any order; columns
/// not known are passed over. Lines that are empty or begin with # are comments. Errors: bad_input
/// with line and column for what is missing, not a number or out of range; limit_exceeded beyond
/// 10,000 rows.
Result<std::vector<CrashTestRow>> parse_crash_tests(const std::string& text);

}  // namespace crashrank::cli

#include "crash_test_rows.hpp"

#include <string>
#include <utility>

namespace crashrank::cli {
namespace {

Result<CrashTestRow> read_row(TestLine line) {
  constexpr double longest = 30.0;
  constexpr double fastest = 150.0;
  CrashTestRow row;
  CrashTest& test = row.test;
  test.id = line.text("id");
  test.size.length_m = line.number("length_m", 0.5, longest);
  test.size.width_m = line.number("width_m", 0.3, longest);
  test.size.height_m = line.number("height_m", 0.3, longest);
  test.size.wheelbase_m = line.number("wheelbase_m", 0.3, longest);
  test.mass_kg = line.number("mass_kg", 1.0, 1e6);
  test.izz_kgm2 = line.optional_number("izz_kgm2", 0.1, 1e8);
  const Result<Barrier> barrier = barrier_from_name(line.text("barrier"));
  if (barrier) {
    test.barrier = *barrier;
  } else {
    line.refuse("barrier", "is unknown: " + barrier.error().reason, barrier.error().remedy);
  }
  test.radius_m = line.optional_number("radius_m", 0.0, 5.0).value_or(0.0);
  if (test.barrier == Barrier::pole && !(test.radius_m > 0.0)) {
    line.refuse("radius_m", "of a pole is not above 0", "write the pole's radius");
  }
  if (test.barrier == Barrier::full) {
    test.overlap = line.optional_number("overlap", 0.0, 1.0).value_or(1.0);
  } else {
    test.overlap = line.number("overlap", 0.0, 1.0);
  }
  test.speed_mps = line.number("speed_mps", 0.1, fastest);
  row.measured_delta_v_mps = line.optional_number("measured_delta_v_mps", 0.0, fastest);
  row.measured_yaw_rate_dps = line.optional_number("measured_yaw_rate_dps", -1e4, 1e4);
  if (!(test.size.wheelbase_m < test.size.length_m)) {
    line.refuse("wheelbase_m", "is not below length_m", "check both");
  }
  if (!line.status()) return line.status().error();
  return row;
}

}  // namespace

Result<std::vector<CrashTestRow>> read_barrier_rows(const TestTable& table) {
  const Status complete = table.require({"id", "length_m", "width_m", "height_m", "wheelbase_m",
                                         "mass_kg", "barrier", "overlap", "speed_mps"});
  if (!complete) return complete.error();
  std::vector<CrashTestRow> rows;
  for (TestLine& line : table.lines()) {
    Result<CrashTestRow> row = read_row(std::move(line));
    if (!row) return row.error();
    rows.push_back(std::move(*row));
  }
  return rows;
}

}  // namespace crashrank::cli

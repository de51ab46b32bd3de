#include "cli/program.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace {

using cli_test::Json;
using cli_test::Outcome;
using cli_test::Workplace;

const std::string data = CRASHRANK_SOURCE_DATA;
const std::string car = data + "/models/sedan.obj";

Json validated(const Workplace& place, const std::string& rows,
               const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{"validate", rows, "--json", "--car", car};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Outcome run = place.crashrank(arguments);
  EXPECT_EQ(run.code, 0) << run.err;
  return run.json();
}

// The stated bound on the shipped measured crashes: |delta-v| within 6 % in the mean and 16 % for
// every row that kept more than a fifth of its speed (under 50 km/h), yaw rate within 25 % in the
// mean; and boxes in place of the meshes are worse by a factor of two at least.
TEST(Validate, TheShippedCrashesStayWithinTheStatedBound) {
  const Workplace place;
  const std::string rows = data + "/validation/small_overlap.csv";
  const Json meshes = validated(place, rows);
  ASSERT_EQ(meshes.at("rows").size(), 11U);
  EXPECT_LE(meshes.at("mean_delta_v_error").get<double>(), 0.06);
  EXPECT_LE(meshes.at("mean_yaw_rate_error").get<double>(), 0.25);
  int slow = 0;
  for (const Json& row : meshes.at("rows")) {
    const double measured = row.at("measured_delta_v_mps").get<double>();
    const double simulated = row.at("delta_v_mps").get<double>();
    EXPECT_NEAR(
        simulated,
        std::hypot(row.at("delta_v_x_mps").get<double>(), row.at("delta_v_y_mps").get<double>()),
        1e-9);
    if (measured >= 50 / 3.6) continue;
    ++slow;
    EXPECT_NEAR(simulated / measured, 1.0, 0.16) << row.at("id");
    EXPECT_EQ(row.at("slides"), true) << row.at("id");
  }
  EXPECT_EQ(slow, 3);
  const Json boxes = validated(place, rows, {"--boxes"});
  EXPECT_GE(boxes.at("mean_delta_v_error").get<double>(),
            2 * meshes.at("mean_delta_v_error").get<double>());
  EXPECT_GE(boxes.at("mean_yaw_rate_error").get<double>(),
            2 * meshes.at("mean_yaw_rate_error").get<double>());
}

constexpr const char* header =
    "id,length_m,width_m,height_m,wheelbase_m,mass_kg,izz_kgm2,barrier,radius_m,overlap,speed_"
    "mps\n";

TEST(Validate, LimitsAreSane) {
  const Workplace place;
  place.write("rows.csv", std::string(header) +
                              "full,4.8,1.8,1.45,2.7,1600,,wall,0.05,1,15\n"
                              "none,4.8,1.8,1.45,2.7,1600,,wall,0.05,0,15\n"
                              "heavy,9.5,2.5,3.6,5.5,14000,,wall,0.05,1,15\n"
                              "pole,4.8,1.8,1.45,2.7,1600,3000,pole,0.127,0.57,15\n");
  const Json rows = validated(place, "rows.csv").at("rows");
  ASSERT_EQ(rows.size(), 4U);
  // A wall over the full width takes all of the speed and hardly turns the car.
  EXPECT_NEAR(rows[0].at("delta_v_mps").get<double>(), 15.0, 0.5);
  EXPECT_LT(std::abs(rows[0].at("yaw_rate_dps").get<double>()), 20.0);
  EXPECT_LT(rows[1].at("delta_v_mps").get<double>(), 1.0);
  EXPECT_NEAR(rows[2].at("delta_v_mps").get<double>(), 15.0, 0.5);
  // In the middle a pole stops the car, too.
  EXPECT_GT(rows[3].at("delta_v_mps").get<double>(), 13.0);
  EXPECT_LT(std::abs(rows[3].at("yaw_rate_dps").get<double>()), 30.0);
}

TEST(Validate, BadRowsAreNamed) {
  const Workplace place;
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "header"},
      {"id,length_m\n", "width_m"},
      {std::string(header) + "x,4.8,1.8,1.45,2.7,many,,wall,0,0.25,15\n", "mass_kg"},
      {std::string(header) + "x,4.8,1.8,1.45,2.7,1600,,hedge,0,0.25,15\n", "hedge"},
      {std::string(header) + "x,4.8,1.8,1.45,2.7,1600,,pole,,0.25,15\n", "radius_m"},
      {std::string(header) + "x,4.8,1.8,1.45,2.7,1600,,wall,0,1.25,15\n", "overlap"},
      {std::string(header) + "x,2.8,1.8,1.45,2.9,1600,,wall,0,0.25,15\n", "wheelbase_m"},
      {std::string(header) + "x,4.8,1.8,1.45,2.7,1600,,wall,0,0.25,nan\n", "speed_mps"},
  };
  for (const auto& [text, named] : cases) {
    place.write("bad.csv", text);
    const Outcome run = place.crashrank({"validate", "bad.csv", "--json", "--car", car});
    EXPECT_EQ(run.code, 3) << text;
    EXPECT_TRUE(cli_test::is_one_message(run.err)) << run.err;
    EXPECT_NE(run.err.find(named), std::string::npos) << run.err;
  }
  EXPECT_EQ(place.crashrank({"validate", "absent.csv"}).code, 3);
}

}  // namespace

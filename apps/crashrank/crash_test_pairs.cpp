#include "crash_test_pairs.hpp"

#include "crashrank/model/make_model.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

namespace crashrank::cli {
namespace {

using Eigen::Vector3d;

constexpr double run_up_s = 0.3;
constexpr double longest_s = 5.0;

const std::vector<std::string>& needed_columns() {
  static const std::vector<std::string> columns{
      "length", "width", "height",  "wheelbase", "rear_overhang", "mass", "cg_ahead_of_rear_axle",
      "x",      "y",     "heading", "speed"};
  return columns;
}

std::string column(const std::string& quantity, int number) {
  std::string unit = "_m";
  if (quantity == "mass") unit = "_kg";
  if (quantity == "izz") unit = "_kgm2";
  if (quantity == "heading") unit = "_deg";
  if (quantity == "speed" || quantity == "measured_delta_v") unit = "_mps";
  if (quantity == "measured_yaw_rate") unit = "_dps";
  return quantity + std::to_string(number) + unit;
}

PairedCar read_car(TestLine& line, int number) {
  constexpr double longest = 30.0;
  constexpr double fastest = 150.0;
  constexpr double furthest = 1e4;
  const auto of = [&](const char* quantity) { return column(quantity, number); };
  PairedCar car;
  car.size.length_m = line.number(of("length"), 0.5, longest);
  car.size.width_m = line.number(of("width"), 0.3, longest);
  car.size.height_m = line.number(of("height"), 0.3, longest);
  car.size.wheelbase_m = line.number(of("wheelbase"), 0.3, longest);
  car.size.rear_overhang_m = line.number(of("rear_overhang"), 0.05, longest);
  car.mass_kg = line.number(of("mass"), 1.0, 1e6);
  car.izz_kgm2 = line.optional_number(of("izz"), 0.1, 1e8);
  car.cg_ahead_of_rear_axle_m = line.number(of("cg_ahead_of_rear_axle"), 0.0, longest);
  car.x_m = line.number(of("x"), -furthest, furthest);
  car.y_m = line.number(of("y"), -furthest, furthest);
  car.heading_deg = line.number(of("heading"), -360.0, 360.0);
  car.speed_mps = line.number(of("speed"), 0.0, fastest);
  car.measured_delta_v_mps = line.optional_number(of("measured_delta_v"), 0.0, fastest);
  car.measured_yaw_rate_dps = line.optional_number(of("measured_yaw_rate"), -1e4, 1e4);
  if (!(car.size.wheelbase_m + *car.size.rear_overhang_m < car.size.length_m)) {
    line.refuse(of("length"), "leaves no front overhang",
                "check " + of("wheelbase") + " and " + of("rear_overhang"));
  }
  if (!(car.cg_ahead_of_rear_axle_m < car.size.wheelbase_m)) {
    line.refuse(of("cg_ahead_of_rear_axle"), "is not between the axles",
                "write a number below " + of("wheelbase"));
  }
  return car;
}

Result<CrashBody> crash_body(const RigCar& rig, const PairedCar& car, int number, RigShape shape) {
  TriangleMesh mesh = stretched_car(rig, car.size);
  if (shape == RigShape::boxes) mesh = car_box(mesh, car.size.width_m);
  Result<Model> model = make_model(std::move(mesh));
  if (!model) return model.error();
  CrashBody body;
  body.model = std::move(*model);
  body.facts.name = "car" + std::to_string(number);
  body.facts.mass_kg = car.mass_kg;
  body.facts.yaw_inertia_kgm2 = car.izz_kgm2;
  // The height of the centre of mass has no effect in the plane.
  body.facts.center_of_mass_m = Vector3d(car.cg_ahead_of_rear_axle_m, 0.0, 0.5 * car.size.height_m);
  const double heading = car.heading_deg * (std::numbers::pi / 180.0);
  const Vector3d ahead(std::cos(heading), std::sin(heading), 0.0);
  const Vector3d origin = Vector3d(car.x_m, car.y_m, 0.0) -
                          (car.cg_ahead_of_rear_axle_m + run_up_s * car.speed_mps) * ahead;
  body.start = pose_from_angles(origin, heading, 0.0, 0.0);
  body.speed_mps = car.speed_mps;
  return body;
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

std::array<double, 9> numbers_of(const BodyOutcome& o) {
  return {o.delta_v_mps, o.delta_v_x_mps,  o.delta_v_y_mps, o.yaw_rate_change_radps,
          o.pdof_deg,    o.crush_energy_j, o.ees_mps,       o.crush_m,
          o.intrusion_m};
}

bool same_bits(const BodyOutcome& a, const BodyOutcome& b) {
  const std::array<double, 9> p = numbers_of(a);
  const std::array<double, 9> q = numbers_of(b);
  return std::equal(p.begin(), p.end(), q.begin(),
                    [](double x, double y) { return same_bits(x, y); });
}

}  // namespace

bool is_pair_table(const TestTable& table) {
  for (const std::string& quantity : needed_columns()) {
    if (table.has(column(quantity, 1)) || table.has(column(quantity, 2))) return true;
  }
  return false;
}

Result<std::vector<PairTest>> read_pair_rows(const TestTable& table) {
  std::vector<std::string> needed{"id"};
  for (const int number : {1, 2}) {
    for (const std::string& quantity : needed_columns()) {
      needed.push_back(column(quantity, number));
    }
  }
  const Status complete = table.require(needed);
  if (!complete) return complete.error();
  std::vector<PairTest> tests;
  for (TestLine& line : table.lines()) {
    PairTest test;
    test.id = line.text("id");
    test.cars = {read_car(line, 1), read_car(line, 2)};
    if (!line.status()) return line.status().error();
    tests.push_back(std::move(test));
  }
  return tests;
}

Result<PairOutcome> run_pair_test(const RigCar& car, const PairTest& test, RigShape shape) {
  const Result<CrashBody> one = crash_body(car, test.cars[0], 1, shape);
  if (!one) return one.error();
  const Result<CrashBody> two = crash_body(car, test.cars[1], 2, shape);
  if (!two) return two.error();
  const Result<Crash> crash = rank_crash(*one, *two, run_up_s + longest_s);
  if (!crash) return crash.error();
  if (crash->state != ImpactState::none && crash->state != ImpactState::contact) {
    return make_error(ErrorCode::bad_input,
                      "test " + test.id + ": the cars overlap 0.3 s before the stated positions",
                      "state positions at first contact or before");
  }
  const Result<Crash> exchanged = rank_crash(*two, *one, run_up_s + longest_s);
  if (!exchanged) return exchanged.error();
  const ContactSeverity& p = crash->severity;
  const ContactSeverity& q = exchanged->severity;
  PairOutcome outcome;
  outcome.crash = *crash;
  outcome.roles_agree = same_bits(p.ego, q.other) && same_bits(p.other, q.ego) &&
                        same_bits(p.dissipated_j, q.dissipated_j) &&
                        same_bits(p.duration_s, q.duration_s);
  return outcome;
}

}  // namespace crashrank::cli

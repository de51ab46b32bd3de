#include "crash_test_pairs.hpp"

#include "crashrank/model/make_model.hpp"
#include "crashrank/motion/time_of_impact.hpp"
#include "crashrank/tree/model.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <cstring>
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

/// A car of a test, ready to be driven.
struct Driven {
  Model model;
  Vehicle vehicle;
  Motion motion;
};

Result<Driven> drive(const RigCar& rig, const PairedCar& car, RigShape shape) {
  TriangleMesh mesh = stretched_car(rig, car.size);
  if (shape == RigShape::boxes) mesh = car_box(mesh, car.size.width_m);
  Result<Model> model = make_model(std::move(mesh));
  if (!model) return model.error();
  VehicleFacts facts;
  facts.mass_kg = car.mass_kg;
  facts.yaw_inertia_kgm2 = car.izz_kgm2;
  // The height of the centre of mass has no effect in the plane.
  facts.center_of_mass_m = Vector3d(car.cg_ahead_of_rear_axle_m, 0.0, 0.5 * car.size.height_m);
  Result<Vehicle> vehicle = describe_vehicle(model->mesh, facts);
  if (!vehicle) return vehicle.error();
  const double heading = car.heading_deg * (std::numbers::pi / 180.0);
  const Vector3d ahead(std::cos(heading), std::sin(heading), 0.0);
  FreeMotion free;
  free.start.rotation = Eigen::AngleAxisd(heading, Vector3d::UnitZ()).toRotationMatrix();
  free.velocity.linear_mps = car.speed_mps * ahead;
  free.start.translation = Vector3d(car.x_m, car.y_m, 0.0) -
                           (car.cg_ahead_of_rear_axle_m + run_up_s * car.speed_mps) * ahead;
  return Driven{std::move(*model), std::move(*vehicle), Motion(free)};
}

ContactBody body_at(const Driven& driven, double time_s) {
  ContactBody body;
  body.vehicle = &driven.vehicle;
  driven.motion.state_at(time_s, body.pose, body.velocity);
  return body;
}

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

bool same_bits(const Vector3d& a, const Vector3d& b) {
  return same_bits(a.x(), b.x()) && same_bits(a.y(), b.y()) && same_bits(a.z(), b.z());
}

bool same_bits(const BodyContact& a, const BodyContact& b) {
  return same_bits(a.impulse_ns, b.impulse_ns) && same_bits(a.delta_v_mps, b.delta_v_mps) &&
         same_bits(a.delta_yaw_rate_radps, b.delta_yaw_rate_radps) &&
         same_bits(a.moved_m, b.moved_m) && same_bits(a.turned_rad, b.turned_rad) &&
         same_bits(a.crush_depth_m, b.crush_depth_m) &&
         same_bits(a.crush_energy_j, b.crush_energy_j) && same_bits(a.intrusion_m, b.intrusion_m);
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
  const Result<Driven> one = drive(car, test.cars[0], shape);
  if (!one) return one.error();
  const Result<Driven> two = drive(car, test.cars[1], shape);
  if (!two) return two.error();
  ImpactWorkspace workspace;
  const Impact impact = time_of_impact(one->model.tree, one->motion, two->model.tree, two->motion,
                                       0.0, run_up_s + longest_s, workspace);
  PairOutcome outcome;
  if (!impact.hit()) {
    outcome.roles_agree = true;
    return outcome;
  }
  if (impact.state != ImpactState::contact) {
    return make_error(ErrorCode::bad_input,
                      "test " + test.id + ": the cars overlap 0.3 s before the stated positions",
                      "state positions at first contact or before");
  }
  const ContactBody a = body_at(*one, impact.time_s);
  const ContactBody b = body_at(*two, impact.time_s);
  const Vector3d point = 0.5 * (impact.point_a_m + impact.point_b_m);
  ContactWorkspace memory;
  outcome.contact = simulate_contact(a, b, {}, point, {}, memory);
  const ContactOutcome exchanged = simulate_contact(b, a, {}, point, {}, memory);
  outcome.roles_agree = same_bits(outcome.contact.a, exchanged.b) &&
                        same_bits(outcome.contact.b, exchanged.a) &&
                        same_bits(outcome.contact.dissipated_j, exchanged.dissipated_j) &&
                        same_bits(outcome.contact.duration_s, exchanged.duration_s);
  return outcome;
}

}  // namespace crashrank::cli

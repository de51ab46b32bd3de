#include "crash_test_rig.hpp"

#include "crash_test_prism.hpp"

#include "crashrank/model/make_model.hpp"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace crashrank::cli {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double wall_width_m = 1.5;
constexpr double wall_height_m = 1.524;
constexpr double wall_depth_m = 2.5;
// A wall that is wider and higher than any car.
constexpr double full_half_width_m = 5.0;
constexpr double full_height_m = 4.0;
// The plate of the small overlap barrier ends in an arc of 115 degrees: behind the corner the
// barrier draws back by 25.
constexpr double arc_deg = 115.0;

// EEVC honeycomb: 0.342 MPa, 0.54 m deep, 0.65 m high, 0.2 m above the road.
constexpr double honeycomb_pa = 0.342e6;
constexpr double honeycomb_depth_m = 0.54;
constexpr double honeycomb_low_m = 0.2;
constexpr double honeycomb_high_m = 0.85;

double radians(double degrees) { return degrees * (std::numbers::pi / 180.0); }

void add_arc(const Vector2d& center, double radius, double from_deg, double to_deg, int pieces,
             Outline& outline) {
  for (int i = 0; i <= pieces; ++i) {
    const double angle = radians(from_deg + (to_deg - from_deg) * i / pieces);
    outline.emplace_back(center + radius * Vector2d(std::cos(angle), std::sin(angle)));
  }
}

/// The barrier with its face at x = 0 towards -x. `inner_y` is where its overlap begins.
TriangleMesh barrier_mesh(const CrashTest& test, double inner_y) {
  constexpr int arc_pieces = 48;
  const double r = test.radius_m;
  if (test.barrier == Barrier::full) {
    return box_prism({0.0, -full_half_width_m, 0.0},
                     {wall_depth_m, full_half_width_m, full_height_m});
  }
  Outline outline;
  if (test.barrier == Barrier::pole) {
    const double last = 360.0 - 360.0 / (2 * arc_pieces);
    add_arc({r, inner_y + r}, r, 0.0, last, 2 * arc_pieces - 1, outline);
    return prism(outline, 0.0, 2.0 * wall_height_m);
  }
  const double draws_back = std::tan(radians(arc_deg - 90.0));
  const auto close = [&] {
    const Vector2d last = outline.back();
    outline.emplace_back(wall_depth_m, last.y() + draws_back * (wall_depth_m - last.x()));
    outline.emplace_back(wall_depth_m, inner_y + wall_width_m);
  };
  outline.emplace_back(0.0, inner_y + wall_width_m);
  if (test.barrier == Barrier::deformable) {
    outline.emplace_back(0.0, inner_y);
    outline.emplace_back(honeycomb_depth_m, inner_y);
    close();
    return prism(outline, honeycomb_low_m, honeycomb_high_m);
  }
  const double low_y = test.barrier == Barrier::flat ? inner_y - r : inner_y;
  add_arc({r, low_y + r}, r, 180.0, 180.0 + arc_deg, arc_pieces, outline);
  close();
  return prism(outline, 0.0, wall_height_m);
}

ScenarioModel barrier_facts(Barrier barrier) {
  ScenarioModel facts;
  facts.name = "barrier";
  facts.kind = BodyKind::building;
  facts.surface = Surface::steel;
  if (barrier != Barrier::deformable) return facts;
  facts.surface = Surface::rubber;
  facts.honeycomb = Honeycomb{honeycomb_pa, honeycomb_depth_m, honeycomb_low_m, honeycomb_high_m};
  return facts;
}

}  // namespace

Result<Barrier> barrier_from_name(const std::string& name) {
  if (name == "wall") return Barrier::wall;
  if (name == "flat") return Barrier::flat;
  if (name == "pole") return Barrier::pole;
  if (name == "deformable") return Barrier::deformable;
  if (name == "full") return Barrier::full;
  return make_error(ErrorCode::bad_input, "there is no barrier \"" + name + "\"",
                    "choose one of wall, flat, pole, deformable, full");
}

Result<Crash> run_crash_test(const RigCar& car, const CrashTest& test, RigShape shape) {
  constexpr double run_up_m = 0.5;
  TriangleMesh body = stretched_car(car, test.size);
  TriangleMesh obstacle = barrier_mesh(test, test.size.width_m * (0.5 - test.overlap));
  if (shape == RigShape::boxes) {
    body = car_box(body, test.size.width_m);
    const Box box = obstacle.bounds();
    obstacle = box_prism(box.min.cast<double>(), box.max.cast<double>());
  }
  Result<Model> a = make_model(std::move(body));
  if (!a) return a.error();
  Result<Model> b = make_model(std::move(obstacle));
  if (!b) return b.error();
  CrashBody ego;
  ego.facts.name = "car";
  ego.facts.mass_kg = test.mass_kg;
  ego.facts.yaw_inertia_kgm2 = test.izz_kgm2;
  ego.start.translation.x() = -run_up_m - static_cast<double>(a->mesh.bounds().max.x());
  ego.speed_mps = test.speed_mps;
  ego.model = std::move(*a);
  CrashBody other;
  other.facts = barrier_facts(test.barrier);
  other.model = std::move(*b);
  return rank_crash(ego, other, (2.0 * run_up_m + test.size.length_m) / test.speed_mps);
}

}  // namespace crashrank::cli

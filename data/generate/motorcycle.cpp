#include "motorcycle.hpp"

#include "field.hpp"
#include "human.hpp"
#include "solids.hpp"
#include "surface.hpp"
#include "wheel.hpp"

namespace generate {
namespace {

constexpr double wheelbase = 1.42;
constexpr double wheel_radius = 0.305;

Posture rider_posture() {
  Posture s;
  s.pelvis = {0.42, 0.0, 0.92};
  s.neck = {0.66, 0.0, 1.38};
  s.head = {0.76, 0.0, 1.55};
  s.helmet = true;
  s.shoulder = both_sides({0.65, 0.17, 1.325});
  s.elbow = both_sides({0.83, 0.31, 1.12});
  s.wrist = both_sides({1.03, 0.30, 1.03});
  s.fingers = both_sides({1.11, 0.30, 1.02});
  s.hip = both_sides({0.46, 0.11, 0.88});
  s.knee = both_sides({0.82, 0.21, 0.75});
  s.ankle = both_sides({0.50, 0.21, 0.41});
  s.toe = both_sides({0.68, 0.22, 0.33});
  return s;
}

// A strip bent about an axle: from `from` to `to` turns, counter-clockwise seen from the right.
Mesh mudguard(const Vec3& axle, double radius, double half_width, double from, double to,
              double edge) {
  const int along = steps(6.2832 * (to - from) * radius, edge, 4);
  std::vector<std::vector<Vec3>> outer(3);
  std::vector<std::vector<Vec3>> inner(3);
  for (int i = 0; i <= along; ++i) {
    const Vec2 turn = unit_circle(from + (to - from) * i / along);
    for (std::size_t k = 0; k < 3; ++k) {
      const double y = half_width * (1.0 - static_cast<double>(k));
      const double r = radius - (k == 1 ? 0.0 : 0.025);
      outer[k].push_back(axle + Vec3(r * turn.x(), y, r * turn.y()));
      inner[2 - k].push_back(axle + Vec3((r - 0.008) * turn.x(), y, (r - 0.008) * turn.y()));
    }
  }
  Mesh mesh = sheet(outer);
  mesh.append(sheet(inner));
  return mesh;
}

void add_running_gear(double edge, Model* model) {
  const Vec3 front_axle(wheelbase, 0, wheel_radius);
  const Vec3 rear_axle(0, 0, wheel_radius);
  add_round_wheel("front", front_axle, wheel_radius, 0.215, 0.12, edge, model);
  add_round_wheel("rear", rear_axle, wheel_radius, 0.215, 0.17, edge, model);
  const Vec3 crown(1.13, 0, 0.98);
  const Vec3 side(0, 0.095, 0);
  model->add("fork", bar(front_axle + side, crown + side, 0.030, 0.024, edge));
  model->add("fork", bar(front_axle - side, crown - side, 0.030, 0.024, edge));
  model->add("fork", bar(front_axle - side, front_axle + side, 0.014, 0.014, edge));
  model->add("fork", box(crown - Vec3(0.01, 0, 0.02), Vec3(0.04, 0.125, 0.02), 0.015, edge));
  model->add("handlebar", bar({1.11, -0.37, 1.03}, {1.11, 0.37, 1.03}, 0.016, 0.016, edge));
  const Vec3 pivot(0.50, 0, 0.42);
  model->add("swing_arm", bar(pivot + side, rear_axle + 1.2 * side, 0.030, 0.022, edge));
  model->add("swing_arm", bar(pivot - side, rear_axle - 1.2 * side, 0.030, 0.022, edge));
  model->add("swing_arm", bar(rear_axle - 1.2 * side, rear_axle + 1.2 * side, 0.014, 0.014, edge));
  model->add("mudguard_front", mudguard(front_axle, wheel_radius + 0.035, 0.075, 0.10, 0.45, edge));
  model->add("mudguard_rear", mudguard(rear_axle, wheel_radius + 0.055, 0.09, 0.30, 0.52, edge));
}

void add_body(double edge, Model* model) {
  const Field tank = [](const Vec3& p) {
    const double upper = ellipsoid(p, {0.84, 0, 0.88}, {0.27, 0.155, 0.13});
    return smooth_min(upper, ellipsoid(p, {0.66, 0, 0.84}, {0.18, 0.115, 0.10}), 0.06);
  };
  model->add("tank", extract_surface(tank, {0.3, -0.3, 0.6}, {1.3, 0.3, 1.2}, edge));
  const Field saddle = [](const Vec3& p) {
    const double seat = round_box(p, {0.36, 0, 0.80}, {0.22, 0.14, 0.05}, 0.045);
    const double pillion = round_box(p, {0.07, 0, 0.86}, {0.17, 0.11, 0.045}, 0.04);
    return smooth_min(seat, pillion, 0.06);
  };
  model->add("seat", extract_surface(saddle, {-0.3, -0.3, 0.6}, {0.8, 0.3, 1.1}, edge));
  const Field tail = [](const Vec3& p) {
    return round_cone(p, {0.22, 0, 0.76}, {-0.22, 0, 0.85}, 0.085, 0.04);
  };
  model->add("tail", extract_surface(tail, {-0.5, -0.3, 0.5}, {0.5, 0.3, 1.1}, edge));
  model->add("tail_lamp", box({-0.255, 0, 0.86}, {0.02, 0.05, 0.025}, 0.012, edge));
  const Field lamp = [](const Vec3& p) {
    return smooth_max(ellipsoid(p, {1.20, 0, 0.93}, {0.13, 0.10, 0.11}), p.x() - 1.30, 0.03);
  };
  model->add("headlamp", extract_surface(lamp, {1.0, -0.2, 0.7}, {1.5, 0.2, 1.2}, edge));
  model->add("engine", box({0.70, 0, 0.42}, {0.22, 0.17, 0.13}, 0.06, edge));
  model->add("engine", bar({0.78, 0, 0.50}, {0.88, 0, 0.74}, 0.14, 0.12, edge, 10));
  model->add("radiator", box({1.00, 0, 0.60}, {0.02, 0.15, 0.13}, 0.01, edge));
  const Vec3 head(1.10, 0, 0.90);
  for (const double y : {-0.10, 0.10}) {
    model->add("frame", bar(head, {0.50, y, 0.70}, 0.028, 0.028, edge));
    model->add("frame", bar({0.50, y, 0.70}, {0.50, y, 0.38}, 0.028, 0.028, edge));
    model->add("frame", bar(head, {0.88, y, 0.36}, 0.022, 0.022, edge));
    model->add("frame", bar({0.50, y, 0.66}, {0.02, 0.6 * y, 0.78}, 0.018, 0.018, edge));
  }
  model->add("exhaust", bar({0.86, -0.08, 0.52}, {0.92, -0.12, 0.28}, 0.024, 0.024, edge));
  model->add("exhaust", bar({0.92, -0.12, 0.28}, {0.40, -0.17, 0.26}, 0.024, 0.024, edge));
  model->add("exhaust", bar({0.40, -0.17, 0.26}, {-0.12, -0.20, 0.44}, 0.045, 0.055, edge, 8));
  for (const double y : {-0.17, 0.17}) {
    model->add("foot_peg", bar({0.54, 0.5 * y, 0.36}, {0.54, 1.6 * y, 0.36}, 0.016, 0.016, edge));
  }
  for (const double side : {-1.0, 1.0}) {
    model->add("mirror",
               bar({1.11, 0.26 * side, 1.04}, {1.10, 0.33 * side, 1.20}, 0.010, 0.010, edge));
    model->add("mirror", box({1.10, 0.36 * side, 1.22}, {0.02, 0.065, 0.04}, 0.018, edge));
  }
}

}  // namespace

Model build_motorcycle(double edge) {
  Model model;
  add_running_gear(edge, &model);
  add_body(edge, &model);
  model.append(build_person(rider_posture(), "rider_", 0.7 * edge));
  return model;
}

}  // namespace generate

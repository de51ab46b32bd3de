#include "bicycle.hpp"

#include "human.hpp"
#include "solids.hpp"
#include "wheel.hpp"

namespace generate {
namespace {

constexpr double wheelbase = 1.06;
constexpr double wheel_radius = 0.345;

Posture rider_posture() {
  Posture s;
  s.pelvis = {0.20, 0.0, 1.04};
  s.neck = {0.40, 0.0, 1.52};
  s.head = {0.47, 0.0, 1.69};
  s.helmet = true;
  s.shoulder = {Vec3(0.38, 0.165, 1.465), Vec3(0.38, -0.165, 1.465)};
  s.elbow = {Vec3(0.55, 0.26, 1.26), Vec3(0.55, -0.26, 1.26)};
  s.wrist = {Vec3(0.73, 0.27, 1.10), Vec3(0.73, -0.27, 1.10)};
  s.fingers = {Vec3(0.82, 0.27, 1.07), Vec3(0.82, -0.27, 1.07)};
  s.hip = {Vec3(0.22, 0.09, 1.00), Vec3(0.22, -0.09, 1.00)};
  s.knee = {Vec3(0.60, 0.10, 0.86), Vec3(0.50, -0.10, 0.66)};
  s.ankle = {Vec3(0.42, 0.11, 0.50), Vec3(0.36, -0.11, 0.22)};
  s.toe = {Vec3(0.58, 0.12, 0.45), Vec3(0.52, -0.12, 0.17)};
  return s;
}

}  // namespace

Model build_bicycle(double edge) {
  Model model;
  const Vec3 rear(0, 0, wheel_radius);
  const Vec3 front(wheelbase, 0, wheel_radius);
  add_round_wheel("rear", rear, wheel_radius, 0.315, 0.042, edge, &model);
  add_round_wheel("front", front, wheel_radius, 0.315, 0.042, edge, &model);
  const Vec3 crank(0.44, 0, 0.29);
  const Vec3 saddle(0.24, 0, 0.90);
  const Vec3 head(0.84, 0, 0.88);
  const Vec3 crown(0.89, 0, 0.72);
  const Vec3 side(0, 0.055, 0);
  model.add("frame", bar(crank, saddle, 0.017, 0.017, edge));
  model.add("frame", bar(crank, crown, 0.020, 0.020, edge));
  model.add("frame", bar(saddle - Vec3(0, 0, 0.10), head, 0.017, 0.017, edge));
  for (const double y : {-1.0, 1.0}) {
    model.add("frame", bar(rear + y * side, crank, 0.011, 0.011, edge));
    model.add("frame", bar(rear + y * side, saddle - Vec3(0, 0, 0.10), 0.009, 0.009, edge));
    model.add("fork", bar(front + y * side, crown + y * side, 0.013, 0.015, edge));
  }
  model.add("fork", bar(crown - 1.2 * side, crown + 1.2 * side, 0.018, 0.018, edge));
  model.add("fork", bar(crown, {0.79, 0, 1.05}, 0.018, 0.018, edge));
  model.add("handlebar", bar({0.79, -0.31, 1.05}, {0.79, 0.31, 1.05}, 0.013, 0.013, edge));
  model.add("saddle", box(saddle + Vec3(0, 0, 0.03), {0.13, 0.075, 0.03}, 0.025, edge));
  model.add("cranks", bar({0.44, 0.07, 0.29}, {0.46, 0.08, 0.45}, 0.012, 0.012, edge));
  model.add("cranks", bar({0.44, -0.07, 0.29}, {0.42, -0.08, 0.13}, 0.012, 0.012, edge));
  model.append(build_person(rider_posture(), "rider_", edge));
  return model;
}

}  // namespace generate

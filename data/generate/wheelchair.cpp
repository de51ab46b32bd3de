#include "wheelchair.hpp"

#include "human.hpp"
#include "solids.hpp"
#include "wheel.hpp"

namespace generate {
namespace {

constexpr double wheel_radius = 0.305;
constexpr double caster_radius = 0.10;
constexpr double caster_x = 0.42;
constexpr double frame_y = 0.22;

Posture sitting_posture() {
  Posture s;
  s.pelvis = {0.03, 0.0, 0.61};
  s.neck = {-0.03, 0.0, 1.11};
  s.head = {0.0, 0.0, 1.28};
  s.shoulder = both_sides({-0.03, 0.165, 1.055});
  s.elbow = both_sides({-0.06, 0.24, 0.80});
  s.wrist = both_sides({0.15, 0.26, 0.70});
  s.fingers = both_sides({0.24, 0.25, 0.66});
  s.hip = both_sides({0.06, 0.09, 0.59});
  s.knee = both_sides({0.48, 0.10, 0.60});
  s.ankle = both_sides({0.58, 0.09, 0.25});
  s.toe = both_sides({0.76, 0.10, 0.205});
  return s;
}

}  // namespace

Model build_wheelchair(double edge) {
  Model model;
  const Wheel wheel = round_wheel({0, 0.29, wheel_radius}, wheel_radius, 0.275, 0.030, 6, edge);
  model.add_both_sides("wheel_rear", wheel.tyre);
  model.add_both_sides("rim_rear", wheel.rim);
  const double ring = 0.255;
  const Mesh push_rim = turned({{ring - 0.01, -0.01},
                                {ring + 0.01, -0.01},
                                {ring + 0.01, 0.01},
                                {ring - 0.01, 0.01},
                                {ring - 0.01, -0.01}},
                               {0, 0.325, wheel_radius}, edge, 24);
  model.add_both_sides("push_rim", push_rim);
  const Vec3 caster(caster_x, frame_y, caster_radius);
  model.add_both_sides("wheel_front", bar(caster - Vec3(0, 0.015, 0), caster + Vec3(0, 0.015, 0),
                                          caster_radius, caster_radius, edge, 16));
  const Vec3 across(0, frame_y, 0);
  const auto tube = [&](const char* name, const Vec3& from, const Vec3& to) {
    model.add_both_sides(name, bar(from + across, to + across, 0.012, 0.012, edge));
  };
  tube("fork", {caster_x, 0, 0.21}, {caster_x, 0, 0.32});
  tube("frame", {-0.08, 0, 0.48}, {0.42, 0, 0.49});
  tube("frame", {0.42, 0, 0.49}, {0.60, 0, 0.17});
  tube("frame", {-0.06, 0, 0.20}, {0.46, 0, 0.32});
  tube("frame", {-0.06, 0, 0.20}, {-0.14, 0, 0.93});
  tube("handle", {-0.14, 0, 0.93}, {-0.26, 0, 0.93});
  tube("arm_rest", {-0.10, 0, 0.70}, {0.22, 0, 0.70});
  model.add("axle", bar({0, -0.28, wheel_radius}, {0, 0.28, wheel_radius}, 0.012, 0.012, edge));
  model.add("frame_cross", bar({0.10, -frame_y, 0.23}, {0.10, frame_y, 0.47}, 0.012, 0.012, edge));
  model.add("frame_cross", bar({0.14, frame_y, 0.23}, {0.14, -frame_y, 0.47}, 0.012, 0.012, edge));
  model.add("seat", box({0.16, 0, 0.49}, {0.24, 0.21, 0.015}, 0.0, edge));
  Mesh back = box({0, 0, 0}, {0.012, 0.21, 0.20}, 0.0, edge);
  for (Vec3& p : back.vertices) p.x() -= 0.10 * p.z();
  model.add("back_rest", moved(back, {-0.12, 0, 0.72}));
  model.add_both_sides("foot_rest", box({0.68, 0.11, 0.155}, {0.09, 0.075, 0.01}, 0.0, edge));
  model.append(build_person(sitting_posture(), "person_", edge));
  return model;
}

}  // namespace generate

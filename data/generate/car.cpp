#include "car.hpp"

#include "solids.hpp"
#include "surface.hpp"
#include "wheel.hpp"

#include <cmath>

namespace generate {
namespace {

constexpr double far = 1e9;

// x as the side view sees it: nose and tail are drawn back towards the sides.
double bowed_x(const CarDesign& d, const Vec3& p) {
  const double y = p.y() / 0.8;
  const double bow = p.x() > d.middle_x ? d.nose_bow : d.tail_bow;
  return d.middle_x + (p.x() - d.middle_x) * (1.0 + bow * (0.35 * y * y + 0.65 * y * y * y * y));
}

// Swells the side a little around the wheel arches.
double arch_swell(const CarDesign& d, const Vec3& p) {
  double swell = 0.0;
  for (const double x : {0.0, d.wheelbase}) {
    const double dx = p.x() - x;
    const double dz = p.z() - d.wheel_radius;
    const double off = std::abs(std::sqrt(dx * dx + dz * dz) - d.arch_radius) / 0.16;
    if (off < 1.0) swell = std::max(swell, (1.0 - off * off) * (1.0 - off * off));
  }
  return 0.018 * swell;
}

void add_wheels(const CarDesign& d, const Field& body, double edge, Model* model) {
  for (const auto& [where, x] : {std::pair<const char*, double>{"front", d.wheelbase},
                                 std::pair<const char*, double>{"rear", 0.0}}) {
    const std::string place = where;
    const double inner = 0.5 * d.track - 0.75 * d.tyre_width;
    const Wheel w = wheel(Vec3(x, 0.5 * d.track, d.wheel_radius), d.wheel_radius, d.rim_radius,
                          d.tyre_width, d.spokes, edge);
    model->add_both_sides("wheel_" + place, w.tyre);
    model->add_both_sides("rim_" + place, w.rim);
    model->add_both_sides(
        "wheel_housing_" + place,
        wheel_housing(body, Vec3(x, inner, d.wheel_radius), d.arch_radius, d.floor_z, edge));
    const double half = 0.5 * d.track - 0.35 * d.tyre_width;
    model->add("axle_" + place, bar(Vec3(x, -half, d.wheel_radius), Vec3(x, half, d.wheel_radius),
                                    0.035, 0.035, 1.6 * edge));
  }
}

void add_seat(const Vec3& hip, double half_width, double edge, Mesh* mesh) {
  mesh->append(box(hip + Vec3(0.18, 0, -0.10), Vec3(0.27, half_width, 0.09), 0.05, edge));
  Mesh back = box(Vec3(0, 0, 0.30), Vec3(0.07, half_width * 0.95, 0.32), 0.05, edge);
  back.append(box(Vec3(0, 0, 0.70), Vec3(0.05, 0.12, 0.08), 0.04, edge));
  for (Vec3& p : back.vertices) p.x() -= 0.38 * p.z();
  mesh->append(moved(back, hip + Vec3(-0.08, 0, 0)));
}

// What a crash meets behind the skin: engine, cooler, firewall, dashboard, seats, tank.
void add_inside(const CarDesign& d, double edge, Model* model) {
  const double e = 2.2 * edge;
  const double nose = d.wheelbase + 0.45;
  model->add("radiator", box(Vec3(nose, 0, 0.50), Vec3(0.03, 0.34, 0.20), 0.01, e));
  model->add("engine", box(Vec3(d.wheelbase + 0.10, 0.06, 0.50), Vec3(0.24, 0.36, 0.22), 0.05, e));
  model->add("gearbox",
             box(Vec3(d.wheelbase + 0.08, -0.38, 0.42), Vec3(0.17, 0.08, 0.14), 0.05, e));
  model->add("firewall",
             box(Vec3(d.cowl_x - 0.06, 0, 0.53 + d.inside_lift), Vec3(0.02, 0.66, 0.30), 0.008, e));
  model->add("dashboard",
             box(Vec3(d.cowl_x - 0.30, 0, 0.80 + d.inside_lift), Vec3(0.20, 0.66, 0.09), 0.06, e));
  model->add("fuel_tank", box(Vec3(0.42, 0, 0.30), Vec3(0.20, 0.42, 0.09), 0.05, e));
  Mesh front;
  add_seat(Vec3(d.seat_x, 0.36, 0.50 + d.inside_lift), 0.24, e, &front);
  model->add_both_sides("seat_front", front);
  if (d.rear_seat) {
    Mesh rear;
    add_seat(Vec3(d.rear_seat_x, 0, 0.52), 0.60, e, &rear);
    model->add("seat_rear", rear);
  }
  // Steering wheel: a ring about an axis that leans back.
  Mesh ring =
      turned({{0.165, -0.014}, {0.195, -0.014}, {0.195, 0.014}, {0.165, 0.014}, {0.165, -0.014}},
             Vec3::Zero(), e, 12);
  ring.append(bar(Vec3(0, -0.02, 0), Vec3(0, 0.35, 0), 0.03, 0.03, e));
  for (Vec3& p : ring.vertices) {
    const Vec3 q = p;
    p = Vec3(d.seat_x + 0.48 + 0.90 * q.y() + 0.43 * q.z(), 0.36 - q.x(),
             0.84 + d.inside_lift - 0.43 * q.y() + 0.90 * q.z());
  }
  model->add("steering_wheel", ring);
}

void add_mirrors(const CarDesign& d, double edge, Model* model) {
  const Vec3 center(d.mirror_x, d.mirror_y, d.mirror_z);
  Mesh mirror = box(center, Vec3(0.06, 0.105, 0.065), 0.05, 0.6 * edge);
  mirror.append(bar(center + Vec3(0.02, -0.16, -0.06), center + Vec3(0, -0.04, -0.03), 0.022, 0.022,
                    0.6 * edge));
  model->add_both_sides("mirror", mirror);
}

}  // namespace

Field car_body(const CarDesign& d) {
  return [&d](const Vec3& p) {
    const double y = std::abs(p.y());
    const double x = bowed_x(d, p);
    const double crown = 0.055 * (y / 0.7) * (y / 0.7);
    // Below the bumper line the crown would lift the floor: it fades out there.
    const double lift = crown * std::clamp((p.z() - 0.45) / 0.3, 0.0, 1.0);
    const double side = y - d.lower_half(p.x()) + d.lower_inset(p.z()) - arch_swell(d, p);
    // Blends end where one side is beyond the other by their width: no more need be known there.
    constexpr double edge_blend = 0.11;
    constexpr double roof_blend = 0.13;
    constexpr double belt_blend = 0.035;
    const double lower = smooth_max(
        d.lower.distance_within({x, p.z() + lift}, side - edge_blend, far), side, edge_blend);
    const double above = p.z() - d.belt_z;
    const double glass = 0.92 * (y - d.cabin_half(p.x()) + d.cabin_inset(above));
    if (glass > lower + belt_blend) return lower;
    const double roof =
        d.cabin.distance_within({x, p.z() + 0.8 * crown}, glass - roof_blend, lower + belt_blend);
    return smooth_min(lower, smooth_max(roof, glass, roof_blend), belt_blend);
  };
}

Model build_car(const CarDesign& d, double edge) {
  const Field body = car_body(d);
  Model model;
  const Vec3 high(d.wheelbase + d.high_beyond.x(), -d.low.y(), d.high_beyond.y());
  const Mesh skin = extract_surface(body, d.low, high, edge);
  add_panels(&model, body, skin, d.panels, "body", edge);
  add_wheels(d, body, edge, &model);
  add_mirrors(d, edge, &model);
  add_inside(d, edge, &model);
  return model;
}

}  // namespace generate

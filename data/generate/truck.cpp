#include "truck.hpp"

#include "curve.hpp"
#include "field.hpp"
#include "seam.hpp"
#include "solids.hpp"
#include "surface.hpp"
#include "wheel.hpp"

namespace generate {
namespace {

constexpr double wheelbase = 5.50;
constexpr double wheel_radius = 0.50;
constexpr double arch_radius = 0.58;
constexpr double tail_x = -2.50;
constexpr double far = 20.0;
constexpr double across = -0.5;

Field cab_body() {
  const Outline profile({{6.70, 0.40}, {6.90, 0.42}, {6.97, 0.62}, {6.97, 1.00}, {6.94, 1.55},
                         {6.86, 2.10}, {6.74, 2.70}, {6.62, 2.93}, {6.40, 3.00}, {6.10, 3.08},
                         {5.60, 3.36}, {5.15, 3.60}, {4.98, 3.66}, {4.94, 3.55}, {4.94, 2.80},
                         {4.94, 1.60}, {4.94, 1.00}, {4.94, 0.72}, {5.10, 0.66}, {5.60, 0.62},
                         {6.30, 0.42}});
  const Ramp half = {{4.9, 1.22}, {6.2, 1.24}, {6.7, 1.22}, {7.0, 1.16}};
  const Ramp inset = {{0.3, 0.02}, {0.8, 0.0}, {1.7, 0.01}, {2.9, 0.09}, {3.7, 0.22}};
  return [=](const Vec3& p) {
    const double y = p.y() / 1.2;
    const double bowed = p.x() + 0.09 * y * y * y * y + 0.03 * y * y;
    const double front = profile.distance({bowed, p.z() + 0.03 * y * y});
    return smooth_max(front, std::abs(p.y()) - half(p.x()) + inset(p.z()), 0.16);
  };
}

std::vector<Panel> cab_panels() {
  std::vector<Vec2> arch;
  for (int i = 0; i < 16; ++i) {
    arch.push_back(Vec2(wheelbase, wheel_radius) + arch_radius * 1.0263 * unit_circle(i / 16.0));
  }
  const auto front = [](const char* name, const std::vector<Vec2>& corners, bool paired) {
    return Panel{name,           View::front,     rounded_polygon(corners),
                 {6.3, -far, 0}, {far, far, far}, paired};
  };
  const auto side = [](const char* name, const std::vector<Vec2>& corners, double y_low,
                       bool paired) {
    return Panel{name,  View::side, rounded_polygon(corners), {-far, y_low, 0}, {far, far, far},
                 paired};
  };
  return {
      {"", View::side, Outline(arch), {-far, 0.75, 0}, {far, far, far}, false},
      front("windshield", {{across, 1.62}, {1.06, 1.66}, {1.00, 2.62}, {across, 2.68}}, false),
      front("headlamp", {{0.72, 0.62}, {1.3, 0.62}, {1.3, 0.84}, {0.72, 0.80}}, true),
      front("grille", {{across, 0.95}, {0.72, 0.95}, {0.86, 1.42}, {across, 1.42}}, false),
      front("plate_front", {{across, 0.52}, {0.26, 0.52}, {0.26, 0.63}, {across, 0.63}}, false),
      side("cab_window", {{6.60, 1.70}, {5.52, 1.72}, {5.52, 2.52}, {6.48, 2.52}}, 0.8, true),
      side("front_bumper", {{6.06, 0.0}, {6.10, 0.86}, {8.0, 0.88}, {8.0, 0.0}}, -far, false),
      side("door",
           {{6.70, 0.90},
            {6.72, 1.60},
            {6.54, 2.66},
            {5.42, 2.66},
            {5.42, 1.22},
            {6.0, 1.10},
            {6.10, 0.88}},
           0.8, true),
      side("cab_side", {{4.0, 0.0}, {6.75, 0.0}, {6.75, 2.95}, {5.9, 3.1}, {4.0, 3.75}}, 0.75,
           true),
      {"deflector",
       View::top,
       polygon({{6.35, across}, {6.35, 2}, {5.0, 2}, {5.0, across}}),
       {-far, -far, 2.9},
       {far, far, far},
       false},
  };
}

void add_chassis(double edge, Model* model) {
  for (const double y : {-0.40, 0.40}) {
    model->add("frame", box({2.0, y, 0.88}, {4.40, 0.04, 0.13}, 0.0, edge));
  }
  for (const double x : {-2.2, -0.9, 0.9, 2.6, 4.3}) {
    model->add("frame", box({x, 0, 0.90}, {0.04, 0.36, 0.08}, 0.0, edge));
  }
  add_tail(tail_x, edge, model);
  Mesh guard = box({2.70, 1.22, 0.60}, {1.75, 0.015, 0.06}, 0.0, edge);
  guard.append(box({2.70, 1.22, 0.88}, {1.75, 0.015, 0.06}, 0.0, edge));
  for (const double x : {1.1, 2.7, 4.3}) {
    guard.append(box({x, 1.19, 0.78}, {0.03, 0.015, 0.26}, 0.0, edge));
  }
  model->add_both_sides("side_guard", guard);
  model->add("fuel_tank", box({3.30, 0.82, 0.72}, {0.60, 0.30, 0.28}, 0.10, edge));
  model->add("battery_box", box({3.60, -0.82, 0.74}, {0.35, 0.26, 0.24}, 0.04, edge));
  model->add("drive_shaft", bar({0.3, 0, 0.62}, {5.2, 0, 0.80}, 0.06, 0.06, edge));
}

}  // namespace

void add_cab(double edge, Model* model) {
  const Field body = cab_body();
  const Mesh skin = extract_surface(body, {4.6, -1.5, 0.2}, {7.3, 1.5, 3.9}, edge);
  add_panels(model, body, skin, cab_panels(), "cab", edge);
  model->add_both_sides("wheel_housing_front", wheel_housing(body, {wheelbase, 0.78, wheel_radius},
                                                             arch_radius, 0.55, edge));
  Mesh mirror = box({6.72, 1.40, 2.05}, {0.05, 0.10, 0.24}, 0.045, edge);
  mirror.append(bar({6.62, 1.14, 2.34}, {6.70, 1.36, 2.26}, 0.02, 0.02, edge));
  mirror.append(bar({6.62, 1.16, 1.78}, {6.70, 1.36, 1.84}, 0.02, 0.02, edge));
  model->add_both_sides("mirror", mirror);
  model->add("engine", box({5.90, 0, 0.90}, {0.60, 0.40, 0.32}, 0.06, 1.5 * edge));
  Mesh seat = box({5.55, 0.55, 1.45}, {0.25, 0.25, 0.08}, 0.05, edge);
  seat.append(box({5.30, 0.55, 1.85}, {0.07, 0.24, 0.36}, 0.05, edge));
  model->add_both_sides("seat", seat);
}

void add_load_box(const Vec3& center, const Vec3& half, double edge, Model* model) {
  const Mesh whole = box(center, half, 0.0, edge);
  const char* const names[3][2] = {
      {"box_doors", "box_front"}, {"box_right", "box_left"}, {"box_floor", "box_roof"}};
  for (int axis = 0; axis < 3; ++axis) {
    for (int high = 0; high < 2; ++high) {
      Mesh face;
      face.vertices = whole.vertices;
      const double at = center[axis] + (high == 0 ? -half[axis] : half[axis]);
      for (const std::array<int, 3>& t : whole.triangles) {
        bool on = true;
        for (const int v : t) {
          on = on && std::abs(whole.vertices[static_cast<std::size_t>(v)][axis] - at) < 1e-9;
        }
        if (on) face.triangles.push_back(t);
      }
      model->add(names[axis][high], face);
    }
  }
}

void add_tail(double tail, double edge, Model* model) {
  model->add("underrun_bar", box({tail + 0.12, 0, 0.50}, {0.05, 1.20, 0.06}, 0.01, edge));
  for (const double y : {-0.40, 0.40}) {
    model->add("underrun_bar", box({tail + 0.16, y, 0.66}, {0.04, 0.04, 0.10}, 0.0, edge));
  }
  const Mesh lamp = box({tail + 0.05, 1.02, 0.88}, {0.04, 0.20, 0.07}, 0.01, edge);
  model->add_both_sides("tail_lamp", lamp);
}

void add_front_wheels(double edge, Model* model) {
  const Wheel front = wheel({wheelbase, 1.03, wheel_radius}, wheel_radius, 0.30, 0.30, 8, edge);
  model->add_both_sides("wheel_front", front.tyre);
  model->add_both_sides("rim_front", front.rim);
}

void add_twin_wheels(double x, const std::string& place, double edge, Model* model) {
  const Wheel outer = wheel({x, 1.09, wheel_radius}, wheel_radius, 0.30, 0.27, 8, edge);
  const Wheel inner = wheel({x, 0.76, wheel_radius}, wheel_radius, 0.30, 0.27, 8, edge);
  Mesh tyres = outer.tyre;
  tyres.append(inner.tyre);
  model->add_both_sides("wheel_" + place, tyres);
  model->add_both_sides("rim_" + place, outer.rim);
}

void add_axle(double x, double z, const std::string& place, double edge, Model* model) {
  model->add("axle_" + place, bar({x, -0.95, z}, {x, 0.95, z}, 0.07, 0.07, edge));
}

void add_mudguards(double axle_x, const std::string& place, Model* model) {
  std::vector<std::vector<Vec3>> strip(2);
  for (int i = 0; i <= 12; ++i) {
    const Vec2 turn = unit_circle(0.03 + 0.44 * i / 12.0);
    const Vec3 middle(axle_x + 0.56 * turn.x(), 0, wheel_radius + 0.53 * turn.y());
    strip[0].push_back(middle + Vec3(0, 1.25, 0));
    strip[1].push_back(middle + Vec3(0, 0.62, 0));
  }
  model->add_both_sides("mudguard_" + place, sheet(strip));
}

Model build_truck(double edge) {
  Model model;
  constexpr double box_front_x = 4.80;
  add_cab(edge, &model);
  add_load_box({0.5 * (tail_x + box_front_x), 0, 2.40}, {0.5 * (box_front_x - tail_x), 1.275, 1.35},
               edge, &model);
  add_chassis(edge, &model);
  add_front_wheels(edge, &model);
  add_twin_wheels(0.0, "rear", edge, &model);
  add_axle(0.0, wheel_radius, "rear", edge, &model);
  add_axle(wheelbase, wheel_radius, "front", edge, &model);
  add_mudguards(0.0, "rear", &model);
  return model;
}

}  // namespace generate

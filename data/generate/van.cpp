#include "car.hpp"
#include "solids.hpp"

namespace generate {
namespace {

constexpr double far = 9.0;
constexpr double across = -0.5;
constexpr double wheelbase = 3.64;
constexpr double wheel_radius = 0.345;
constexpr double arch_radius = 0.41;

std::vector<Panel> van_panels() {
  std::vector<Panel> panels;
  const auto side = [&](const char* name, const Outline& outline, double y_low, bool paired) {
    panels.push_back({name, View::side, outline, {-far, y_low, 0}, {far, far, far}, paired});
  };
  const auto front = [&](const char* name, const std::vector<Vec2>& corners, double x_low,
                         bool paired) {
    panels.push_back(
        {name, View::front, rounded_polygon(corners), {x_low, -far, 0}, {far, far, far}, paired});
  };
  const auto rear = [&](const char* name, const std::vector<Vec2>& corners) {
    panels.push_back(
        {name, View::front, rounded_polygon(corners), {-far, -far, 0}, {-1.0, far, far}, true});
  };
  const auto top = [&](const char* name, const std::vector<Vec2>& corners, double z_low) {
    panels.push_back(
        {name, View::top, rounded_polygon(corners), {-far, -far, z_low}, {far, far, far}, false});
  };
  for (const double x : {0.0, wheelbase}) {
    std::vector<Vec2> circle;
    for (int i = 0; i < 16; ++i) {
      circle.push_back(Vec2(x, wheel_radius) + arch_radius * 1.0263 * unit_circle(i / 16.0));
    }
    side("", Outline(circle), 0.6, false);
  }
  side("underbody", polygon({{-2, -1}, {6, -1}, {6, 0.29}, {-2, 0.29}}), -far, false);
  front("windshield", {{across, 1.40}, {0.80, 1.44}, {0.68, 2.24}, {across, 2.34}}, 2.6, false);
  side("window_front", rounded_polygon({{3.45, 1.44}, {2.15, 1.42}, {2.15, 2.08}, {3.00, 2.08}}),
       0.6, true);
  front("headlamp", {{0.60, 0.84}, {1.10, 0.88}, {1.10, 1.10}, {0.64, 1.02}}, 4.0, true);
  front("grille", {{across, 0.78}, {0.54, 0.78}, {0.57, 0.95}, {across, 0.95}}, 4.3, false);
  front("plate_front", {{across, 0.45}, {0.26, 0.45}, {0.26, 0.56}, {across, 0.56}}, 4.3, false);
  rear("tail_lamp", {{0.89, 0.80}, {1.3, 0.80}, {1.3, 1.30}, {0.89, 1.30}});
  rear("rear_door", {{across, 0.62}, {0.86, 0.62}, {0.86, 1.50}, {0.74, 2.38}, {across, 2.46}});
  top("hood", {{3.86, across}, {3.80, 0.78}, {4.22, 0.76}, {4.40, 0.60}, {4.50, across}}, 0.98);
  top("roof", {{3.02, across}, {2.72, 0.72}, {-1.20, 0.74}, {-1.28, across}}, 2.20);
  side("front_bumper", polygon({{4.06, 0}, {4.09, 0.62}, {4.30, 0.73}, {6.0, 0.76}, {6.0, 0}}),
       -far, false);
  side("rear_bumper", polygon({{-1.10, 0}, {-1.10, 0.56}, {-2, 0.59}, {-2, 0}}), -far, false);
  side("door_front",
       rounded_polygon({{3.16, 0.44},
                        {3.20, 0.78},
                        {3.48, 0.96},
                        {3.58, 1.42},
                        {3.06, 2.18},
                        {2.08, 2.20},
                        {2.06, 0.44}}),
       0.6, true);
  side("load_door", rounded_polygon({{1.99, 0.44}, {2.01, 2.20}, {0.76, 2.20}, {0.74, 0.44}}), 0.6,
       true);
  side("sill", polygon({{0.36, 0.1}, {3.26, 0.1}, {3.26, 0.42}, {0.36, 0.42}}), 0.5, true);
  side("fender", polygon({{3.1, 0.1}, {6, 0.1}, {6, 1.20}, {3.7, 1.36}, {3.1, 1.36}}), 0.4, true);
  side("side_panel", polygon({{-2, 0.1}, {6, 0.1}, {6, 3}, {-2, 3}}), 0.3, true);
  return panels;
}

CarDesign van_design() {
  return {
      .wheelbase = wheelbase,
      .wheel_radius = wheel_radius,
      .rim_radius = 0.215,
      .tyre_width = 0.235,
      .track = 1.74,
      .arch_radius = arch_radius,
      .spokes = 6,
      .lower = Outline({{4.30, 0.25},  {4.55, 0.28},  {4.63, 0.42},  {4.645, 0.62}, {4.63, 0.84},
                        {4.54, 1.04},  {4.25, 1.22},  {3.80, 1.38},  {3.00, 1.40},  {1.50, 1.40},
                        {0.00, 1.40},  {-1.10, 1.40}, {-1.33, 1.36}, {-1.35, 1.10}, {-1.36, 0.80},
                        {-1.36, 0.50}, {-1.28, 0.36}, {-1.00, 0.30}, {0.30, 0.26},  {1.50, 0.25},
                        {3.00, 0.25}}),
      .cabin = Outline({{4.10, 1.10},
                        {3.90, 1.34},
                        {3.45, 1.84},
                        {3.08, 2.25},
                        {2.80, 2.47},
                        {2.40, 2.58},
                        {1.80, 2.60},
                        {0.90, 2.60},
                        {0.00, 2.60},
                        {-0.90, 2.60},
                        {-1.22, 2.57},
                        {-1.31, 2.42},
                        {-1.34, 2.00},
                        {-1.35, 1.50},
                        {-1.35, 1.10},
                        {-1.30, 0.98},
                        {-1.00, 0.95},
                        {1.00, 1.05},
                        {3.00, 1.05}}),
      .lower_half =
          {{-1.35, 0.97}, {-0.80, 1.00}, {3.20, 1.00}, {3.90, 0.985}, {4.30, 0.92}, {4.62, 0.80}},
      .lower_inset = {{0.25, 0.08}, {0.45, 0.02}, {0.70, 0.0}, {1.10, 0.0}, {1.40, 0.015}},
      .cabin_half = {{-1.35, 0.96}, {-0.80, 0.985}, {2.40, 0.985}, {3.10, 0.94}, {3.80, 0.83}},
      .belt_z = 1.35,
      .cabin_inset = {{-0.30, -0.02}, {0.0, 0.0}, {0.50, 0.03}, {0.90, 0.09}, {1.25, 0.19}},
      .middle_x = 1.6,
      .nose_bow = 0.04,
      .tail_bow = 0.006,
      .panels = van_panels(),
      .cowl_x = 3.58,
      .seat_x = 2.25,
      .mirror_x = 3.12,
      .mirror_z = 1.55,
      .mirror_y = 1.11,
      .floor_z = 0.26,
      .inside_lift = 0.40,
      .rear_seat = false,
      .low = {-1.7, -1.25, 0.10},
      .high_beyond = {1.4, 2.90},
  };
}

}  // namespace

Model build_van(double edge) {
  Model model = build_car(van_design(), edge);
  const double e = 2.0 * edge;
  model.add("load_floor", box({0.30, 0, 0.60}, {1.55, 0.60, 0.02}, 0.0, e));
  model.add("bulkhead", box({1.93, 0, 1.50}, {0.02, 0.84, 0.85}, 0.0, e));
  return model;
}

}  // namespace generate

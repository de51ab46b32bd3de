#include "car.hpp"

namespace generate {
namespace {

constexpr double far = 9.0;

// |y| runs across the symmetry plane, so that outlines meet there without a corner.
constexpr double across = -0.5;

std::vector<Panel> hatch_panels(double wheelbase) {
  std::vector<Panel> panels;
  const auto side = [&](const std::string& name, const Outline& outline, double y_low, double z_low,
                        bool paired) {
    panels.push_back({name, View::side, outline, {-far, y_low, z_low}, {far, far, far}, paired});
  };
  const auto front = [&](const std::string& name, const Outline& outline, double x_low,
                         double x_high, bool paired) {
    panels.push_back({name, View::front, outline, {x_low, -far, 0}, {x_high, far, far}, paired});
  };
  const auto top = [&](const std::string& name, const Outline& outline, double z_low) {
    panels.push_back({name, View::top, outline, {-far, -far, z_low}, {far, far, far}, false});
  };
  for (const double x : {0.0, wheelbase}) {
    std::vector<Vec2> circle;
    for (int i = 0; i < 16; ++i) {
      circle.push_back(Vec2(x, 0.30) + 0.3495 * 1.0263 * unit_circle(i / 16.0));
    }
    side("", Outline(circle), 0.5, 0.0, false);
  }
  // The floor; the lower lips of the bumpers stay with the bumpers.
  side("underbody",
       polygon({{-2, -1},
                {5, -1},
                {5, 0.185},
                {3.00, 0.185},
                {2.90, 0.235},
                {-0.30, 0.235},
                {-0.40, 0.205},
                {-2, 0.205}}),
       -far, 0.0, false);
  front("windshield",
        rounded_polygon({{across, 0.965}, {0.68, 1.0}, {0.525, 1.36}, {across, 1.385}}), 1.40, 3.0,
        false);
  front("rear_window",
        rounded_polygon({{across, 1.06}, {0.58, 1.07}, {0.49, 1.30}, {across, 1.32}}), -far, -0.20,
        false);
  side("window_front",
       rounded_polygon({{2.10, 0.985}, {1.115, 1.00}, {1.115, 1.375}, {1.58, 1.335}}), 0.42, 0.9,
       true);
  side(
      "window_rear",
      rounded_polygon({{1.035, 1.00}, {0.02, 1.045}, {-0.10, 1.20}, {0.12, 1.355}, {1.035, 1.378}}),
      0.42, 0.9, true);
  front("headlamp",
        rounded_polygon({{0.44, 0.60}, {0.70, 0.61}, {0.95, 0.70}, {0.95, 0.80}, {0.60, 0.735}}),
        2.86, far, true);
  front("tail_lamp", rounded_polygon({{0.57, 0.74}, {0.95, 0.72}, {0.95, 0.99}, {0.62, 1.02}}),
        -far, -0.34, true);
  front("plate_front",
        rounded_polygon({{across, 0.41}, {0.26, 0.41}, {0.26, 0.52}, {across, 0.52}}), 3.0, far,
        false);
  front("grille", rounded_polygon({{across, 0.55}, {0.36, 0.55}, {0.42, 0.64}, {across, 0.64}}),
        3.0, far, false);
  front("air_intake", rounded_polygon({{across, 0.25}, {0.55, 0.25}, {0.44, 0.37}, {across, 0.37}}),
        3.0, far, false);
  front("plate_rear", rounded_polygon({{across, 0.42}, {0.26, 0.42}, {0.26, 0.53}, {across, 0.53}}),
        -far, -0.3, false);
  top("hood",
      rounded_polygon({{2.30, across}, {2.28, 0.70}, {3.00, 0.67}, {3.22, 0.50}, {3.31, across}}),
      0.66);
  top("roof", rounded_polygon({{1.80, across}, {1.72, 0.50}, {-0.24, 0.47}, {-0.30, across}}),
      1.30);
  front("front_bumper", polygon({{across, 0.2}, {0.46, 0.2}, {0.46, 0.80}, {across, 0.80}}), 3.0,
        far, false);
  side("front_bumper", polygon({{2.86, 0}, {2.90, 0.54}, {3.02, 0.63}, {4.0, 0.67}, {4.0, 0}}),
       -far, 0.0, false);
  side("rear_bumper", polygon({{-0.32, 0}, {-0.34, 0.50}, {-0.42, 0.61}, {-2, 0.63}, {-2, 0}}),
       -far, 0.0, false);
  front("tailgate",
        rounded_polygon({{across, 0.62}, {0.60, 0.62}, {0.64, 1.02}, {0.53, 1.36}, {across, 1.55}}),
        -far, -0.20, false);
  side("door_front",
       rounded_polygon({{2.06, 0.285},
                        {2.13, 0.6},
                        {2.20, 0.97},
                        {1.60, 1.405},
                        {1.075, 1.425},
                        {1.075, 0.95},
                        {1.05, 0.285}}),
       0.42, 0.0, true);
  side("door_rear",
       rounded_polygon({{1.05, 0.285},
                        {1.075, 0.95},
                        {1.075, 1.425},
                        {0.06, 1.40},
                        {-0.10, 1.04},
                        {0.14, 0.86},
                        {0.43, 0.52},
                        {0.45, 0.285}}),
       0.42, 0.0, true);
  side("sill", polygon({{0.30, 0.1}, {2.30, 0.1}, {2.30, 0.32}, {0.30, 0.32}}), 0.42, 0.0, true);
  side("fender", polygon({{1.95, 0.1}, {4.0, 0.1}, {4.0, 0.94}, {1.95, 0.975}}), 0.35, 0.0, true);
  side("quarter_panel", polygon({{-2, 0.1}, {1.1, 0.1}, {1.1, 1.0}, {-2, 1.09}}), 0.35, 0.0, true);
  side("pillars", polygon({{-2, 0.9}, {4, 0.9}, {4, 2}, {-2, 2}}), 0.30, 0.9, true);
  return panels;
}

}  // namespace

CarDesign hatch_design() {
  constexpr double wheelbase = 2.55;
  return {
      .wheelbase = wheelbase,
      .wheel_radius = 0.30,
      .rim_radius = 0.195,
      .tyre_width = 0.185,
      .track = 1.49,
      .arch_radius = 0.35,
      .spokes = 5,
      .lower = Outline({{3.18, 0.18},  {3.33, 0.22},  {3.41, 0.36},  {3.41, 0.50},  {3.38, 0.62},
                        {3.30, 0.72},  {3.12, 0.80},  {2.75, 0.89},  {2.35, 0.965}, {1.80, 0.96},
                        {1.00, 0.985}, {0.20, 1.02},  {-0.40, 1.04}, {-0.62, 1.00}, {-0.68, 0.85},
                        {-0.70, 0.66}, {-0.73, 0.56}, {-0.73, 0.38}, {-0.66, 0.24}, {-0.45, 0.20},
                        {0.30, 0.17},  {1.50, 0.17},  {2.60, 0.17}}),
      .cabin = Outline({{2.62, 0.80},
                        {2.48, 0.93},
                        {2.06, 1.17},
                        {1.66, 1.385},
                        {1.30, 1.462},
                        {0.70, 1.50},
                        {0.10, 1.478},
                        {-0.30, 1.415},
                        {-0.42, 1.385},
                        {-0.42, 1.365},
                        {-0.47, 1.25},
                        {-0.57, 1.03},
                        {-0.60, 0.90},
                        {-0.40, 0.75},
                        {0.50, 0.70},
                        {2.00, 0.70}}),
      .lower_half = {{-0.72, 0.74},
                     {-0.45, 0.82},
                     {0.0, 0.865},
                     {0.8, 0.88},
                     {2.0, 0.88},
                     {2.6, 0.87},
                     {3.0, 0.82},
                     {3.35, 0.74}},
      .lower_inset = {{0.15, 0.10},
                      {0.30, 0.045},
                      {0.45, 0.015},
                      {0.62, 0.0},
                      {0.75, 0.006},
                      {0.90, 0.035},
                      {1.05, 0.08}},
      .cabin_half = {{-0.65, 0.69}, {0.0, 0.775}, {0.8, 0.81}, {1.8, 0.81}, {2.6, 0.74}},
      .belt_z = 0.95,
      .cabin_inset = {{-0.30, -0.07}, {0.0, 0.0}, {0.20, 0.072}, {0.40, 0.175}, {0.55, 0.27}},
      .middle_x = 1.3,
      .nose_bow = 0.085,
      .tail_bow = 0.05,
      .panels = hatch_panels(wheelbase),
      .cowl_x = 2.40,
      .seat_x = 1.12,
      .rear_seat_x = 0.28,
      .mirror_x = 2.02,
      .mirror_z = 1.02,
      .mirror_y = 0.895,
      .floor_z = 0.175,
  };
}

}  // namespace generate

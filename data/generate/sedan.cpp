#include "car.hpp"

namespace generate {
namespace {

constexpr double far = 9.0;

// |y| runs across the symmetry plane, so that outlines meet there without a corner.
constexpr double across = -0.5;

std::vector<Panel> sedan_panels(double wheelbase) {
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
      circle.push_back(Vec2(x, 0.335) + 0.3845 * 1.0263 * unit_circle(i / 16.0));
    }
    side("", Outline(circle), 0.5, 0.0, false);
  }
  // The floor; the lower lips of the bumpers stay with the bumpers.
  side("underbody",
       polygon({{-2, -1},
                {5, -1},
                {5, 0.178},
                {3.25, 0.178},
                {3.15, 0.23},
                {-0.30, 0.23},
                {-0.40, 0.205},
                {-2, 0.205}}),
       -far, 0.0, false);
  front("windshield",
        rounded_polygon({{across, 0.955}, {0.70, 0.985}, {0.545, 1.345}, {across, 1.375}}), 1.50,
        3.4, false);
  front("rear_window",
        rounded_polygon({{across, 1.085}, {0.60, 1.09}, {0.50, 1.325}, {across, 1.345}}), -far,
        -0.05, false);
  panels.back().low.x() = -0.90;
  side("window_front",
       rounded_polygon({{2.32, 0.975}, {1.195, 0.985}, {1.195, 1.345}, {1.72, 1.31}}), 0.42, 0.9,
       true);
  side(
      "window_rear",
      rounded_polygon({{1.115, 0.985}, {0.20, 1.01}, {-0.02, 1.20}, {0.22, 1.315}, {1.115, 1.345}}),
      0.42, 0.9, true);
  side("quarter_window", rounded_polygon({{0.13, 1.02}, {-0.34, 1.055}, {-0.08, 1.17}}), 0.42, 0.9,
       true);
  front("headlamp",
        rounded_polygon({{0.50, 0.60}, {0.72, 0.60}, {0.99, 0.68}, {0.99, 0.78}, {0.58, 0.71}}),
        3.2, far, true);
  front("tail_lamp", rounded_polygon({{0.46, 0.80}, {0.99, 0.76}, {0.99, 0.95}, {0.46, 0.92}}),
        -far, -0.72, true);
  front("plate_front",
        rounded_polygon({{across, 0.34}, {0.26, 0.34}, {0.26, 0.45}, {across, 0.45}}), 3.3, far,
        false);
  front("grille", rounded_polygon({{across, 0.49}, {0.36, 0.49}, {0.46, 0.67}, {across, 0.68}}),
        3.3, far, false);
  front("air_intake", rounded_polygon({{across, 0.24}, {0.66, 0.24}, {0.60, 0.31}, {across, 0.31}}),
        3.2, far, false);
  front("plate_rear", rounded_polygon({{across, 0.70}, {0.26, 0.70}, {0.26, 0.81}, {across, 0.81}}),
        -far, -0.6, false);
  top("hood",
      rounded_polygon({{2.48, across}, {2.46, 0.73}, {3.20, 0.70}, {3.52, 0.54}, {3.66, across}}),
      0.66);
  top("roof", rounded_polygon({{1.92, across}, {1.84, 0.50}, {-0.26, 0.48}, {-0.32, across}}),
      1.25);
  top("trunk_lid",
      rounded_polygon({{-0.40, across}, {-0.42, 0.68}, {-1.40, 0.62}, {-1.40, across}}), 0.97);
  front("front_bumper", polygon({{across, 0.2}, {0.50, 0.2}, {0.50, 0.80}, {across, 0.80}}), 3.3,
        far, false);
  side("front_bumper", polygon({{3.13, 0}, {3.17, 0.54}, {3.30, 0.62}, {4.4, 0.66}, {4.4, 0}}),
       -far, 0.0, false);
  side("rear_bumper", polygon({{-0.345, 0}, {-0.37, 0.50}, {-0.50, 0.64}, {-2, 0.66}, {-2, 0}}),
       -far, 0.0, false);
  front("trunk_lid", rounded_polygon({{across, 0.63}, {0.60, 0.63}, {0.64, 1.2}, {across, 1.2}}),
        -far, -0.72, false);
  side("door_front",
       rounded_polygon({{2.30, 0.29},
                        {2.37, 0.6},
                        {2.44, 0.96},
                        {1.78, 1.375},
                        {1.155, 1.40},
                        {1.155, 0.95},
                        {1.13, 0.29}}),
       0.42, 0.0, true);
  side("door_rear",
       rounded_polygon({{1.13, 0.29},
                        {1.155, 0.95},
                        {1.155, 1.40},
                        {0.10, 1.36},
                        {-0.14, 1.16},
                        {0.06, 0.95},
                        {0.20, 0.80},
                        {0.44, 0.52},
                        {0.46, 0.29}}),
       0.42, 0.0, true);
  side("sill", polygon({{0.30, 0.1}, {2.55, 0.1}, {2.55, 0.36}, {0.30, 0.36}}), 0.42, 0.0, true);
  side("fender", polygon({{2.30, 0.1}, {4.4, 0.1}, {4.4, 0.93}, {2.30, 0.965}}), 0.35, 0.0, true);
  side("quarter_panel", polygon({{-2, 0.1}, {1.1, 0.1}, {1.1, 0.99}, {-0.5, 1.08}, {-2, 1.1}}),
       0.35, 0.0, true);
  side("pillars", polygon({{-2, 0.9}, {4, 0.9}, {4, 2}, {-2, 2}}), 0.30, 0.9, true);
  return panels;
}

}  // namespace

CarDesign sedan_design() {
  constexpr double wheelbase = 2.80;
  return {
      .wheelbase = wheelbase,
      .wheel_radius = 0.335,
      .rim_radius = 0.235,
      .tyre_width = 0.215,
      .track = 1.56,
      .arch_radius = 0.385,
      .spokes = 10,
      .lower =
          Outline({{3.52, 0.17},    {3.70, 0.20},  {3.785, 0.34},  {3.79, 0.48},  {3.77, 0.62},
                   {3.69, 0.71},    {3.46, 0.79},  {3.02, 0.875},  {2.58, 0.945}, {2.00, 0.95},
                   {1.00, 0.97},    {0.00, 1.00},  {-0.50, 1.035}, {-0.84, 1.06}, {-1.02, 1.075},
                   {-1.045, 1.045}, {-1.03, 0.90}, {-1.07, 0.70},  {-1.09, 0.58}, {-1.08, 0.38},
                   {-0.98, 0.23},   {-0.70, 0.20}, {0.00, 0.165},  {1.50, 0.165}, {3.00, 0.165}}),
      .cabin = Outline({{2.86, 0.80},
                        {2.70, 0.92},
                        {2.26, 1.15},
                        {1.80, 1.365},
                        {1.42, 1.44},
                        {0.80, 1.475},
                        {0.20, 1.455},
                        {-0.18, 1.37},
                        {-0.52, 1.215},
                        {-0.88, 1.045},
                        {-0.96, 0.90},
                        {-0.50, 0.75},
                        {0.50, 0.70},
                        {2.00, 0.70}}),
      .lower_half = {{-1.08, 0.76},
                     {-0.7, 0.85},
                     {0.0, 0.905},
                     {0.9, 0.918},
                     {2.2, 0.918},
                     {2.9, 0.905},
                     {3.4, 0.85},
                     {3.77, 0.76}},
      .lower_inset = {{0.15, 0.10},
                      {0.30, 0.04},
                      {0.45, 0.018},
                      {0.60, 0.006},
                      {0.72, 0.0},
                      {0.80, 0.012},
                      {0.95, 0.05},
                      {1.08, 0.09}},
      .cabin_half =
          {{-1.0, 0.66}, {-0.3, 0.76}, {0.3, 0.81}, {0.9, 0.835}, {1.9, 0.835}, {2.8, 0.77}},
      .belt_z = 0.94,
      .cabin_inset = {{-0.30, -0.07}, {0.0, 0.0}, {0.20, 0.085}, {0.40, 0.20}, {0.55, 0.30}},
      .middle_x = 1.35,
      .nose_bow = 0.095,
      .tail_bow = 0.045,
      .panels = sedan_panels(wheelbase),
      .cowl_x = 2.64,
      .seat_x = 1.22,
      .rear_seat_x = 0.30,
      .mirror_x = 2.22,
      .mirror_z = 1.00,
      .mirror_y = 0.935,
      .floor_z = 0.17,
  };
}

}  // namespace generate

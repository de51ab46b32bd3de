#include "semitrailer.hpp"

#include "solids.hpp"
#include "truck.hpp"
#include "wheel.hpp"

#include <array>
#include <utility>

namespace generate {
namespace {

// Before the trailer's middle axle.
constexpr double tail_x = -4.30;
constexpr double king_pin_x = 7.70;
constexpr double box_front_x = 9.28;
constexpr double front_x = 12.20;
constexpr double drive_axle_x = 7.03;
// Of the trailer's axles.
constexpr double spacing = 1.31;
constexpr double wheel_radius = 0.52;

// Coordinates of `add_cab`, whose front is at 6.97.
constexpr double cab_ahead = front_x - 6.97;

void add_tractor(double edge, Model* model) {
  Model tractor;
  constexpr double front_axle_x = 5.50;
  constexpr double rear_axle_x = drive_axle_x - cab_ahead;
  add_cab(edge, &tractor);
  for (const double y : {-0.40, 0.40}) {
    tractor.add("frame", box({3.50, y, 0.88}, {2.90, 0.04, 0.13}, 0.0, edge));
  }
  for (const double x : {1.0, 2.6, 4.3}) {
    tractor.add("frame", box({x, 0, 0.90}, {0.04, 0.36, 0.08}, 0.0, edge));
  }
  tractor.add_both_sides("fuel_tank", box({3.50, 0.86, 0.66}, {0.55, 0.32, 0.30}, 0.10, edge));
  tractor.add("drive_shaft", bar({rear_axle_x + 0.3, 0, 0.62}, {5.2, 0, 0.80}, 0.06, 0.06, edge));
  add_front_wheels(edge, &tractor);
  add_twin_wheels(rear_axle_x, "drive", edge, &tractor);
  add_axle(rear_axle_x, 0.50, "drive", edge, &tractor);
  add_axle(front_axle_x, 0.50, "front", edge, &tractor);
  add_mudguards(rear_axle_x, "drive", &tractor);
  model->append(tractor, {cab_ahead, 0, 0});
  model->add("fifth_wheel", box({king_pin_x, 0, 1.08}, {0.45, 0.45, 0.07}, 0.02, edge));
}

void add_trailer(double edge, Model* model) {
  const double middle_x = 0.5 * (tail_x + box_front_x);
  add_load_box({middle_x, 0, 2.61}, {box_front_x - middle_x, 1.275, 1.39}, edge, model);
  // Beams that are deep behind the tractor only.
  constexpr double neck_x = 5.90;
  for (const double y : {-0.65, 0.65}) {
    const double half = 0.5 * (neck_x - tail_x);
    model->add("trailer_frame", box({tail_x + half, y, 1.02}, {half, 0.06, 0.20}, 0.0, edge));
    model->add("trailer_frame", box({0.5 * (neck_x + box_front_x), y, 1.18},
                                    {0.5 * (box_front_x - neck_x), 0.06, 0.04}, 0.0, edge));
  }
  for (const double x : {-3.9, -2.0, 0.65, 2.6, 4.4, 5.6}) {
    model->add("trailer_frame", box({x, 0, 1.04}, {0.05, 0.59, 0.10}, 0.0, edge));
  }
  // Drawn in while the trailer is coupled.
  model->add_both_sides("landing_leg", box({5.20, 0.80, 0.75}, {0.07, 0.07, 0.35}, 0.0, edge));
  add_tail(tail_x, edge, model);
  for (const auto& [place, x] :
       {std::pair("rear", -spacing), std::pair("middle", 0.0), std::pair("fore", spacing)}) {
    const std::string name = std::string("trailer_") + place;
    const Wheel made = wheel({x, 1.04, wheel_radius}, wheel_radius, 0.29, 0.385, 8, edge);
    model->add_both_sides("wheel_" + name, made.tyre);
    model->add_both_sides("rim_" + name, made.rim);
    add_axle(x, wheel_radius, name, edge, model);
  }
}

}  // namespace

Model build_semitrailer(double edge) {
  Model model;
  add_tractor(edge, &model);
  add_trailer(edge, &model);
  return model;
}

}  // namespace generate

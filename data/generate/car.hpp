#pragma once

#include "curve.hpp"
#include "mesh.hpp"
#include "seam.hpp"

namespace generate {

/// The lines a car or van is drawn from. Coordinates as the model's: m, x forward from the rear
/// axle, y left, z up from the ground. Everything is symmetric about y = 0.
struct CarDesign {
  double wheelbase = 0.0;
  double wheel_radius = 0.0;
  double rim_radius = 0.0;
  double tyre_width = 0.0;
  double track = 0.0;  ///< between the middles of the tyres
  double arch_radius = 0.0;
  int spokes = 5;
  Outline lower;     ///< side view of the body up to the belt line, (x, z)
  Outline cabin;     ///< side view of what stands above it
  Ramp lower_half;   ///< half width of the lower body by x
  Ramp lower_inset;  ///< how far its side stands back from that, by z
  Ramp cabin_half;   ///< half width of the cabin at the belt line, by x
  double belt_z;     ///< height that cabin_half is meant at
  Ramp cabin_inset;  ///< how far the cabin's side leans in, by height above belt_z
  double middle_x;   ///< where the body is longest sideways: bow of nose and tail is about it
  double nose_bow;   ///< how far the nose draws back towards the sides, share of its length
  double tail_bow;
  std::vector<Panel> panels;
  double cowl_x = 0.0;  ///< foot of the windscreen
  double seat_x = 0.0;  ///< hip point of the driver
  double rear_seat_x = 0.0;
  double mirror_x = 0.0;
  double mirror_z = 0.0;
  double mirror_y = 0.0;
  double floor_z = 0.0;
  double inside_lift = 0.0;  ///< of seats, dashboard and firewall above those of a car
  bool rear_seat = true;
  Vec3 low = {-1.3, -1.05, 0.05};  ///< a box around the body, its skin alone
  Vec2 high_beyond = {1.2, 1.65};  ///< its other corner: x before the front axle, z
};

/// The outside of the body as a solid, wheel arches not cut.
Field car_body(const CarDesign& design);

/// Builds the car with triangles of about `edge` m a side.
Model build_car(const CarDesign& design, double edge);

CarDesign hatch_design();
CarDesign sedan_design();

/// A panel van: a high cabin, with load doors on both sides and a bulkhead behind the seats.
Model build_van(double edge);

}  // namespace generate

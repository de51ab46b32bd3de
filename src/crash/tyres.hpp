#pragma once

#include "crash/planar_body.hpp"
#include "crashrank/crash/contact_law.hpp"
#include "crashrank/vehicle/vehicle.hpp"

#include <Eigen/Core>

namespace crashrank::detail {

/// Contact points of a body with the road: the four corners of a rectangle; body axes, relative to
/// the centre of mass. Arrays hold left, right.
struct Footing {
  double front_m = 0.5;                   ///< x of the front points
  double rear_m = -0.5;                   ///< x of the rear points
  Eigen::Array2d y_m{0.5, -0.5};          ///< left positive
  Eigen::Array2d front_load{0.25, 0.25};  ///< static shares of the weight, sum 1
  Eigen::Array2d rear_load{0.25, 0.25};
  bool wheels = false;     ///< the points are wheels; otherwise patches that slide in any direction
  double cornering = 0.0;  ///< side force per load and slip angle, 1/rad; wheels only
};

/// Computes the footing of a vehicle. With a known wheelbase: wheels at the axles. Single-track
/// vehicles, people and bodies without known axles: sliding patches at the centres of the four
/// quarters of the outline's bounding box. The loads balance the centre of mass (vehicle at rest,
/// no load transfer); a centre of mass outside the points loads the nearest ones. O(pieces of the
/// outline).
Footing footing_of(const Vehicle& vehicle);

/// State of an axle's wheels: left, right.
struct AxleWheels {
  Eigen::Array2d brake{1.0, 1.0};   ///< longitudinal force over grip·load, [0, 1]; 1 where locked
  Eigen::Array2d side{1.0, 1.0};    ///< upper bound of side force over grip·load; 1 where locked
  Eigen::Array2d locked{1.0, 1.0};  ///< 1: slides in any direction; 0: turns
};

/// State of the four wheels, locked by default. `wheels_after` computes it.
struct Wheels {
  double cosine = 1.0;  ///< of the front wheels' steering angle
  double sine = 0.0;
  AxleWheels front;
  AxleWheels rear;
};

/// Returns the state of the wheels. `steering_rad` turns the front wheels, left positive; `brake`
/// in [0, 1] is the share of grip·load used for braking with `AfterContact::brakes`. 1 leaves no
/// side force; rolling resistance alone (0.01 to 0.015 of the load, Engineering ToolBox) is about
/// 0.02. Bits 0 to 3 of `damaged` lock front left, front right, rear left, rear right: a wheel in
/// crushed structure does not turn. Patches are always locked.
Wheels wheels_after(const Footing& footing, AfterContact after, double steering_rad, double brake,
                    unsigned damaged = 0);

/// Applies the road forces of a step to a body's velocity and yaw rate; the pose stays. For second
/// order in the step, move the body by half a step before and half a step after.
///
/// A turning wheel has a side force proportional to the tangent of its slip angle and a braking
/// force along the wheel, together at most `grip` times its load (friction circle); a locked wheel
/// has grip·load against its sliding velocity. `grip` is the friction coefficient of the points:
/// the scenario's for tyres, 0.45 to 0.58 for motorcycles on their side (Day and Smith 1984,
/// asphalt, 40 km/h). If `grip` or `seconds` is 0 or less, nothing changes.
///
/// For any state and step: kinetic energy does not grow (up to rounding), momentum changes by at
/// most grip·mass·9.80665·seconds, and a body at rest stays at rest. A locked or braking body comes
/// to rest in finite time. The mirrored state gives the mirrored result, bit for bit. Accurate for
/// steps up to 20 ms. Thread-safe, no allocation, O(1).
void apply_tyre_forces(const Footing& footing, const Wheels& wheels, double grip, double seconds,
                       PlanarBody& body);

}  // namespace crashrank::detail

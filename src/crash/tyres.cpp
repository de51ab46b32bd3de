#include "crash/tyres.hpp"

#include "crashrank/interop/frames.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace crashrank::detail {
namespace {

using Eigen::Array2d;

constexpr double road_gravity_mps2 = 9.80665;
constexpr double radian_deg = 180.0 / pi;
// Side force over load, per degree of slip angle: 16 to 17 % for car tyres (Tapia, "Extended tire
// testing", Calspan 1983, as recommended for SMAC; Gillespie 1992 gives 11 to 19 % for radials and
// up to 30 % for low profiles), 13 % for lorry tyres (M-SMAC, at 6.7 kN a tyre; less when laden).
constexpr double car_cornering = 0.165 * radian_deg;
constexpr double lorry_cornering = 0.13 * radian_deg;
// Track over body width without mirrors: 56 to 65 inches for the small car and 67 to 78 for the
// pick-up by which MASH (AASHTO 2016, table 4-1) selects test vehicles.
constexpr double track_over_width = 0.86;
// Height bands of the outline that hold the body's width but no mirrors: up to 0.6 m.
constexpr std::size_t low_bands = 4;

// Below this speed the direction of sliding is undefined, m/s.
constexpr double least_sliding_mps = 1e-9;
// Upper bound of the damping of one point over a step, as a multiple of the body's momentum: it
// removes 99.98 % of the speed in that direction. Limits the condition number of the equations.
constexpr double most_damping = 100.0;
// A body slower than this is at rest, m/s (yaw rate: times the radius of gyration).
constexpr double standing_mps = 1e-6;

struct OutlineBox {
  double low_x = std::numeric_limits<double>::infinity();
  double high_x = -std::numeric_limits<double>::infinity();
  double low_y = std::numeric_limits<double>::infinity();
  double high_y = -std::numeric_limits<double>::infinity();
};

OutlineBox outline_box(const Profile& profile, std::size_t bands) {
  OutlineBox box;
  for (std::uint32_t i = 0; i < profile.first[bands]; ++i) {
    const OutlinePiece& piece = profile.pieces[i];
    const auto x = static_cast<double>(piece.x);
    const auto y = static_cast<double>(piece.y);
    const double half = 0.5 * static_cast<double>(piece.length_m);
    const double half_x = half * std::abs(static_cast<double>(piece.normal_y));
    const double half_y = half * std::abs(static_cast<double>(piece.normal_x));
    box.low_x = std::min(box.low_x, x - half_x);
    box.high_x = std::max(box.high_x, x + half_x);
    box.low_y = std::min(box.low_y, y - half_y);
    box.high_y = std::max(box.high_y, y + half_y);
  }
  return box;
}

/// Velocity of the centre of mass in body axes, m/s, and yaw rate, rad/s.
struct BodyVelocity {
  double x = 0.0;
  double y = 0.0;
  double spin = 0.0;

  /// Twice the kinetic energy over the mass.
  double squared(double gyration2) const { return x * x + y * y + gyration2 * (spin * spin); }
};

/// A symmetric matrix over x, y, spin.
struct Symmetric3 {
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  double xs = 0.0;
  double ys = 0.0;
  double ss = 0.0;
};

/// Parameters of the tyre forces of an axle in a step, by wheel (left, right).
struct AxleStep {
  Array2d load;
  Array2d locked;
  bool any_locked;
  Array2d braking;    ///< braking share times friction·g·seconds, m/s
  Array2d side;       ///< upper bound of side force over load, times g·seconds, m/s
  Array2d cornering;  ///< side force over load and slip angle, times g·seconds, m/s
};

/// Velocities of an axle's contact points along its wheels and to their left, m/s.
struct AxleVelocity {
  Array2d along;
  Array2d across;
};

/// Damping of an axle's wheels: impulse of the step per mass of the body and per velocity.
struct AxleDamping {
  Array2d along;
  Array2d across;
};

/// Sum over an axle. With two terms, exchanging left and right changes no bit.
double both(const Array2d& a) { return a[0] + a[1]; }

inline AxleDamping axle_damping(const AxleStep& step, const AxleVelocity& v) {
  const Array2d along = v.along.abs().max(least_sliding_mps);
  const Array2d across = v.across.abs().max(least_sliding_mps);
  // The force of a locked wheel opposes its whole velocity; slip angle and braking force of a
  // turning wheel refer to the speed along the wheel.
  Array2d speed = along;
  if (step.any_locked) speed = (along * along + step.locked * (across * across)).sqrt();
  const Array2d per = 1.0 / (speed * across);
  const Array2d per_speed = per * across;
  return {
      step.load * (step.braking * per_speed).min(most_damping),
      step.load * (step.cornering * per_speed).min((step.side * (per * speed)).min(most_damping))};
}

struct RoadStep {
  const Footing& footing;
  double cosine;  ///< of the steering angle
  double sine;
  AxleStep front;
  AxleStep rear;

  AxleVelocity front_velocity(const BodyVelocity& v) const {
    const Array2d x = v.x - v.spin * footing.y_m;
    const double y = v.y + v.spin * footing.front_m;
    return {cosine * x + sine * y, cosine * y - sine * x};
  }
  AxleVelocity rear_velocity(const BodyVelocity& v) const {
    return {v.x - v.spin * footing.y_m, Array2d::Constant(v.y + v.spin * footing.rear_m)};
  }
};

/// Impulse of the step per mass for a velocity: x and y in m/s, moment in m²/s.
inline BodyVelocity road_impulse(const RoadStep& step, const BodyVelocity& v) {
  const AxleVelocity front = step.front_velocity(v);
  const AxleVelocity rear = step.rear_velocity(v);
  const AxleDamping f = axle_damping(step.front, front);
  const AxleDamping r = axle_damping(step.rear, rear);
  const Array2d f_along = f.along * front.along;
  const Array2d f_across = f.across * front.across;
  const Array2d front_x = step.cosine * f_along - step.sine * f_across;
  const double front_y = both(step.sine * f_along + step.cosine * f_across);
  const Array2d rear_x = r.along * rear.along;
  const double rear_y = both(r.across * rear.across);
  const Array2d x = front_x + rear_x;
  return {
      -both(x), -(front_y + rear_y),
      both(x * step.footing.y_m) - (step.footing.front_m * front_y + step.footing.rear_m * rear_y)};
}

/// Damping matrix D of the step: impulse = -D(v)·v. The matrix of every wheel is positive
/// semidefinite, so that a step with D adds no energy, whatever the velocity at which D was
/// evaluated.
inline Symmetric3 road_damping(const RoadStep& step, const BodyVelocity& v) {
  const AxleDamping f = axle_damping(step.front, step.front_velocity(v));
  const AxleDamping r = axle_damping(step.rear, step.rear_velocity(v));
  const double cc = step.cosine * step.cosine;
  const double ss = step.sine * step.sine;
  const Array2d& y = step.footing.y_m;
  const double xf = step.footing.front_m;
  const double xr = step.footing.rear_m;
  // Damping of the front wheels, rotated by the steering angle.
  const Array2d f_xx = cc * f.along + ss * f.across;
  const Array2d f_xy = (step.cosine * step.sine) * (f.along - f.across);
  const double f_yy = both(ss * f.along + cc * f.across);
  const double r_yy = both(r.across);
  const double xy = both(f_xy);
  const double xy_y = both(f_xy * y);
  const Array2d xx = f_xx + r.along;
  const Array2d xx_y = xx * y;
  const double f_ys = xf * f_yy - xy_y;
  const double r_ys = xr * r_yy;
  return {both(xx),    xy,
          f_yy + r_yy, xf * xy - both(xx_y),
          f_ys + r_ys, (xf * (f_ys - xy_y) + xr * r_ys) + both(xx_y * y)};
}

/// Solves (M + a) u = M v with M = diag(1, 1, gyration2) for positive semidefinite a. Cramer's rule
/// in place of pivots: one division; `most_damping` keeps the cofactors' rounding harmless.
inline BodyVelocity solve_damped(const Symmetric3& a, double gyration2, const BodyVelocity& v) {
  const double xx = 1.0 + a.xx;
  const double yy = 1.0 + a.yy;
  const double ss = gyration2 + a.ss;
  const double moment = gyration2 * v.spin;
  const double cxx = yy * ss - a.ys * a.ys;
  const double cxy = a.xs * a.ys - a.xy * ss;
  const double cxs = a.xy * a.ys - a.xs * yy;
  const double cyy = xx * ss - a.xs * a.xs;
  const double cys = a.xy * a.xs - xx * a.ys;
  const double css = xx * yy - a.xy * a.xy;
  const double per = 1.0 / (xx * cxx + (a.xy * cxy + a.xs * cxs));
  return {per * (cxx * v.x + (cxy * v.y + cxs * moment)),
          per * (cxy * v.x + (cyy * v.y + cys * moment)),
          per * (cxs * v.x + (cys * v.y + css * moment))};
}

/// a + a·M⁻¹·a/2.
inline Symmetric3 with_half_square(const Symmetric3& a, double per_gyration2) {
  const double xs = per_gyration2 * a.xs;
  const double ys = per_gyration2 * a.ys;
  const double ss = per_gyration2 * a.ss;
  return {a.xx + 0.5 * ((a.xx * a.xx + a.xy * a.xy) + a.xs * xs),
          a.xy + 0.5 * ((a.xx * a.xy + a.xy * a.yy) + a.xs * ys),
          a.yy + 0.5 * ((a.xy * a.xy + a.yy * a.yy) + a.ys * ys),
          a.xs + 0.5 * ((a.xx * a.xs + a.xy * a.ys) + a.xs * ss),
          a.ys + 0.5 * ((a.xy * a.xs + a.yy * a.ys) + a.ys * ss),
          a.ss + 0.5 * ((a.xs * a.xs + a.ys * a.ys) + a.ss * ss)};
}

}  // namespace

Footing footing_of(const Vehicle& vehicle) {
  const bool single_track =
      vehicle.kind == BodyKind::motorcycle || vehicle.kind == BodyKind::bicycle;
  const Profile& profile = *vehicle.profile;
  Footing footing;
  footing.wheels =
      vehicle.wheelbase_m > 0.0 && !single_track && vehicle.kind != BodyKind::pedestrian;
  double front = 0.0;
  double rear = 0.0;
  double middle_y = 0.0;
  double half_y = 0.0;
  if (footing.wheels) {
    const OutlineBox box =
        outline_box(profile, profile.first[low_bands] > 0 ? low_bands : profile_bands);
    rear = vehicle.rear_axle_x_m;
    front = rear + vehicle.wheelbase_m;
    middle_y = 0.5 * (box.low_y + box.high_y);
    half_y = 0.5 * track_over_width * (box.high_y - box.low_y);
    footing.cornering = vehicle.kind == BodyKind::car ? car_cornering : lorry_cornering;
  } else {
    // Friction of an evenly loaded rod that turns in place equals that of two loads at the middles
    // of its halves; for a square it is 8 % more than that of four loads at the middles of its
    // quarters.
    const OutlineBox box = outline_box(profile, profile_bands);
    const double middle_x = 0.5 * (box.low_x + box.high_x);
    const double half_x = 0.25 * (box.high_x - box.low_x);
    front = middle_x + half_x;
    rear = middle_x - half_x;
    middle_y = 0.5 * (box.low_y + box.high_y);
    half_y = 0.25 * (box.high_y - box.low_y);
  }
  front -= vehicle.center_m.x();
  rear -= vehicle.center_m.x();
  const double left = middle_y + half_y - vehicle.center_m.y();
  const double right = middle_y - half_y - vehicle.center_m.y();
  // Compute each share from its own lever arm, so that a mirrored vehicle has exactly the mirrored
  // loads.
  const double on_front = std::clamp(-rear / (front - rear), 0.0, 1.0);
  const double on_rear = std::clamp(front / (front - rear), 0.0, 1.0);
  const double on_left = std::clamp(-right / (left - right), 0.0, 1.0);
  const double on_right = std::clamp(left / (left - right), 0.0, 1.0);
  footing.front_m = front;
  footing.rear_m = rear;
  footing.y_m << left, right;
  footing.front_load << on_front * on_left, on_front * on_right;
  footing.rear_load << on_rear * on_left, on_rear * on_right;
  return footing;
}

Wheels wheels_after(const Footing& footing, AfterContact after, double steering_rad, double brake,
                    unsigned damaged) {
  const double share = after == AfterContact::brakes ? std::clamp(brake, 0.0, 1.0) : 0.0;
  const bool any_turns = footing.wheels && after != AfterContact::locks;
  Wheels wheels;
  if (any_turns) {
    wheels.cosine = std::cos(steering_rad);
    wheels.sine = std::sin(steering_rad);
  }
  for (int i = 0; i < 4; ++i) {
    const bool turns = any_turns && ((damaged >> i) & 1U) == 0U;
    AxleWheels& axle = i < 2 ? wheels.front : wheels.rear;
    axle.locked[i % 2] = turns ? 0.0 : 1.0;
    axle.brake[i % 2] = turns ? share : 1.0;
    axle.side[i % 2] = turns ? std::sqrt(1.0 - share * share) : 1.0;
  }
  return wheels;
}

void apply_tyre_forces(const Footing& footing, const Wheels& wheels, double grip, double seconds,
                       PlanarBody& body) {
  const double most_mps = grip * road_gravity_mps2 * seconds;
  if (!(grip > 0.0 && seconds > 0.0) || body.inverse_mass == 0.0) return;
  if (body.vx == 0.0 && body.vy == 0.0 && body.spin == 0.0) return;
  const double gyration2 = body.inverse_mass / body.inverse_inertia;
  const double per_gyration2 = body.inverse_inertia / body.inverse_mass;
  const BodyVelocity before{body.cosine * body.vx + body.sine * body.vy,
                            body.cosine * body.vy - body.sine * body.vx, body.spin};
  const double slope_mps = footing.cornering * road_gravity_mps2 * seconds;
  const auto axle = [&](const Array2d& load, const AxleWheels& w) {
    return AxleStep{load,
                    w.locked,
                    both(w.locked) > 0.0,
                    most_mps * w.brake,
                    most_mps * w.side,
                    slope_mps + w.locked * (most_mps - slope_mps)};
  };
  const RoadStep step{footing, wheels.cosine, wheels.sine, axle(footing.front_load, wheels.front),
                      axle(footing.rear_load, wheels.rear)};
  // With constant D the velocity would decay as exp(-D). 1/(1 + D + D²/2) is a second-order
  // approximation that neither overshoots nor oscillates, however stiff the tyres are at walking
  // pace. D is evaluated at an estimate of the velocity at half the step: an explicit half step,
  // shortened where the forces would more than stop the body. Any D keeps the energy from growing.
  const BodyVelocity push = road_impulse(step, before);
  const double energy = before.squared(gyration2);
  const double pushed = push.x * push.x + push.y * push.y + per_gyration2 * (push.spin * push.spin);
  const double half = pushed > 0.25 * energy ? 0.125 * energy / pushed : 0.5;
  const BodyVelocity middle{before.x + half * push.x, before.y + half * push.y,
                            before.spin + half * (per_gyration2 * push.spin)};
  const BodyVelocity after =
      solve_damped(with_half_square(road_damping(step, middle), per_gyration2), gyration2, before);
  BodyVelocity change{after.x - before.x, after.y - before.y, after.spin - before.spin};
  const double changed = change.x * change.x + change.y * change.y;
  if (changed > most_mps * most_mps) {
    // Energy is convex in the velocity: a part of the change adds no energy either.
    const double part = most_mps / std::sqrt(changed);
    change = {part * change.x, part * change.y, part * change.spin};
  }
  const BodyVelocity now{before.x + change.x, before.y + change.y, before.spin + change.spin};
  // If almost no energy is lost, rounding could add some: keep the velocity.
  if (now.squared(gyration2) > energy) return;
  if (now.squared(gyration2) < standing_mps * standing_mps &&
      before.x * before.x + before.y * before.y <= most_mps * most_mps) {
    body.vx = 0.0;
    body.vy = 0.0;
    body.spin = 0.0;
    return;
  }
  body.vx += body.cosine * change.x - body.sine * change.y;
  body.vy += body.sine * change.x + body.cosine * change.y;
  body.spin += change.spin;
}

}  // namespace crashrank::detail

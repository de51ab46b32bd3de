#pragma once

#include "crashrank/crash/contact_law.hpp"

#include <Eigen/Core>

#include <cmath>

namespace crashrank::detail {

inline constexpr double gravity_mps2 = 9.80665;

/// Euclidean length. Several times faster than std::hypot, which also handles overflow and
/// underflow that do not occur here.
inline double plane_length(double x, double y) { return std::sqrt(x * x + y * y); }

/// State of a rigid body in the plane: world axes, coordinates relative to the point of first
/// contact.
struct PlanarBody {
  double inverse_mass = 0.0;     ///< 1/kg; 0: fixed body
  double inverse_inertia = 0.0;  ///< 1/(kg·m²)
  double x = 0.0;                ///< centre of mass, m
  double y = 0.0;
  double vx = 0.0;  ///< velocity of the centre of mass, m/s
  double vy = 0.0;
  double spin = 0.0;  ///< rad/s, left positive
  double cosine = 1.0;
  double sine = 0.0;
  double turned = 0.0;  ///< heading change since the start, rad
  /// Ground that the body stands on: its height under the point of first contact, world z, m, and
  /// its rise per metre along x and y. It stays as it is while the body slides.
  double ground_m = 0.0;
  double rise_x = 0.0;
  double rise_y = 0.0;

  double energy() const {
    if (inverse_mass == 0.0) return 0.0;
    return 0.5 * ((vx * vx + vy * vy) / inverse_mass + spin * spin / inverse_inertia);
  }
  void apply_impulse(double impulse_x, double impulse_y, double moment) {
    vx += inverse_mass * impulse_x;
    vy += inverse_mass * impulse_y;
    spin += inverse_inertia * moment;
  }
  void move(double seconds) {
    x += seconds * vx;
    y += seconds * vy;
    if (spin == 0.0) return;
    // Cayley's rotation: preserves length and gives the same bits on every machine. Its angle
    // differs from w·t by (w·t)³/12 for the small angles of a step.
    const double t = 0.5 * seconds * spin;
    const double scale = 1.0 / (1.0 + t * t);
    const double c = (1.0 - t * t) * scale;
    const double s = 2.0 * t * scale;
    const double turned_cosine = c * cosine - s * sine;
    sine = c * sine + s * cosine;
    cosine = turned_cosine;
    turned += seconds * spin;
  }
  /// Height of its ground at a place, world z, m.
  double ground_at(double at_x, double at_y) const {
    return ground_m + (rise_x * at_x + rise_y * at_y);
  }
};

/// Rise of the ground that a body stands on, per metre along world x and y: the plane of its own x
/// and y axes; level for a body that lies on its side or on its roof.
inline Eigen::Vector2d ground_rise(const Pose& pose) {
  constexpr double standing = 0.5;
  const Eigen::Vector3d up = pose.rotation.col(2);
  if (!(up.z() > standing)) return Eigen::Vector2d::Zero();
  return -up.head<2>() / up.z();
}

/// Centre of mass and heading of a planar body.
struct PlanarPlace {
  double x = 0.0;
  double y = 0.0;
  double cosine = 1.0;
  double sine = 0.0;
};

inline PlanarPlace place_of(const PlanarBody& body) {
  return {body.x, body.y, body.cosine, body.sine};
}

/// Pose of a body's origin when its planar state is `now`, given that it was `given` when the
/// planar state was `start`; it slides along the ground that it stands on. `center_m`: centre of
/// mass, body axes.
Pose moved_pose(const Pose& given, const Eigen::Vector3d& center_m, const PlanarPlace& start,
                const PlanarPlace& now);

/// Force on a body and its moment about the point of first contact, world axes.
struct PlanarForce {
  double x = 0.0;       ///< N
  double y = 0.0;       ///< N
  double moment = 0.0;  ///< N·m
};

inline PlanarBody make_planar(const ContactBody& body, const Eigen::Vector3d& origin_m) {
  const Vehicle& v = *body.vehicle;
  PlanarBody p;
  const double length = std::hypot(body.pose.rotation(0, 0), body.pose.rotation(1, 0));
  p.cosine = length > 0.0 ? body.pose.rotation(0, 0) / length : 1.0;
  p.sine = length > 0.0 ? body.pose.rotation(1, 0) / length : 0.0;
  const double arm_x = p.cosine * v.center_m.x() - p.sine * v.center_m.y();
  const double arm_y = p.sine * v.center_m.x() + p.cosine * v.center_m.y();
  p.x = body.pose.translation.x() + arm_x - origin_m.x();
  p.y = body.pose.translation.y() + arm_y - origin_m.y();
  const Eigen::Vector3d ground =
      body.pose.translation + body.pose.rotation.col(2) * v.profile->ground_m;
  const Eigen::Vector2d rise = ground_rise(body.pose);
  p.rise_x = rise.x();
  p.rise_y = rise.y();
  p.ground_m = ground.z() - rise.dot(ground.head<2>() - origin_m.head<2>());
  if (v.stands()) return p;
  p.inverse_mass = 1.0 / v.mass_kg;
  p.inverse_inertia = 1.0 / v.yaw_inertia_kgm2;
  p.spin = body.velocity.angular_radps.z();
  p.vx = body.velocity.linear_mps.x() - p.spin * arm_y;
  p.vy = body.velocity.linear_mps.y() + p.spin * arm_x;
  return p;
}

}  // namespace crashrank::detail

#include "crashrank/crash/impulse.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace crashrank {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// What an impulse at the contact point changes: velocities per unit of impulse.
struct Response {
  Matrix3d inverse_mass = Matrix3d::Zero();
  Matrix3d inverse_inertia = Matrix3d::Zero();
  Vector3d arm = Vector3d::Zero();  ///< from the centre of mass to the contact

  Matrix3d at_contact() const {
    Matrix3d cross;
    cross << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0;
    return inverse_mass - cross * inverse_inertia * cross;
  }
};

Response response(const RigidBody& body, const Vector3d& point, ImpulseSpace space) {
  Response r;
  r.arm = point - body.center_m;
  if (!body.movable()) return r;
  r.inverse_mass.diagonal().setConstant(1.0 / body.mass_kg);
  if (space == ImpulseSpace::planar) {
    r.inverse_mass(2, 2) = 0.0;
    r.inverse_inertia(2, 2) = 1.0 / body.inertia_kgm2(2, 2);
  } else {
    r.inverse_inertia = body.inertia_kgm2.inverse();
  }
  return r;
}

Vector3d point_velocity(const RigidBody& body, const Vector3d& arm) {
  if (!body.movable()) return Vector3d::Zero();
  return body.velocity.linear_mps + body.velocity.angular_radps.cross(arm);
}

/// The contact as one small problem: impulse p on B changes the velocity of A against B by -K p.
struct Contact {
  Matrix3d k;         ///< 1/kg
  Vector3d approach;  ///< velocity of A against B at the contact
  Vector3d n;         ///< unit, from A to B
  bool planar = false;
  double friction = 0.0;
};

struct Push {
  Vector3d impulse = Vector3d::Zero();  ///< on B
  bool slides = false;
  double friction_needed = 0.0;
};

/// Brach's solution for a given restitution. In the basis (n, tangents) the impulse that leaves no
/// sliding solves K p = u + e (n.u) n. Sliding: along the straight way from the frictionless
/// impulse to that one the normal equation holds throughout, and it leaves the friction cone once;
/// the impulse there is the answer, which also shows that no denominator below is negative.
template <int tangent_count>
Push solve(const Contact& c, const Eigen::Matrix<double, 3, tangent_count>& tangents,
           double restitution) {
  using Tangential = Eigen::Matrix<double, tangent_count, 1>;
  using TangentialSquare = Eigen::Matrix<double, tangent_count, tangent_count>;
  const double closing = c.n.dot(c.approach);
  const double k_nn = c.n.dot(c.k * c.n);
  const Tangential k_nt = tangents.transpose() * (c.k * c.n);
  const TangentialSquare k_tt = tangents.transpose() * (c.k * tangents);
  const Tangential slip = tangents.transpose() * c.approach;
  // Eliminating the normal row leaves the tangential motion alone.
  const double start = (1.0 + restitution) * closing / k_nn;
  const TangentialSquare schur = k_tt - k_nt * k_nt.transpose() / k_nn;
  const Tangential p_t = schur.ldlt().solve(slip - k_nt * start);
  const double p_n = start - k_nt.dot(p_t) / k_nn;
  const double needed = p_t.norm();
  Push push;
  push.friction_needed = p_n > 0.0 ? needed / p_n : std::numeric_limits<double>::infinity();
  if (p_n > 0.0 && push.friction_needed <= c.friction) {
    push.impulse = p_n * c.n + tangents * p_t;
    return push;
  }
  push.slides = true;
  const Tangential along = p_t / needed;
  // Written so that no friction and endless friction are ordinary cases.
  const double coupling = k_nt.dot(along);
  const double across = start * k_nn / (k_nn / c.friction + coupling);
  push.impulse = (start - across * coupling / k_nn) * c.n + tangents * (across * along);
  return push;
}

Push solve(const Contact& c, double restitution) {
  if (c.planar) {
    return solve<1>(c, Vector3d(-c.n.y(), c.n.x(), 0.0), restitution);
  }
  Eigen::Matrix<double, 3, 2> tangents;
  tangents.col(0) = c.n.unitOrthogonal();
  tangents.col(1) = c.n.cross(tangents.col(0));
  return solve<2>(c, tangents, restitution);
}

/// Kinetic energy that an impulse on B leaves the two bodies with, less what they had.
double energy_change(const Contact& c, const Vector3d& p) {
  return 0.5 * p.dot(c.k * p) - p.dot(c.approach);
}

BodyImpulse apply(const RigidBody& body, const Response& r, const Vector3d& impulse) {
  BodyImpulse result;
  result.impulse_ns = impulse;
  result.after = body.velocity;
  if (!body.movable()) return result;
  result.delta_v_mps = r.inverse_mass * impulse;
  const Vector3d twist = r.arm.cross(impulse);
  result.delta_omega_radps = r.inverse_inertia * twist;
  if (r.inverse_inertia(0, 0) != 0.0) {
    // An explicit inverse loses digits with the inertia's condition; what is missing of the angular
    // momentum is put back.
    result.delta_omega_radps +=
        r.inverse_inertia * (twist - body.inertia_kgm2 * result.delta_omega_radps);
  }
  result.after.linear_mps += result.delta_v_mps;
  result.after.angular_radps += result.delta_omega_radps;
  RigidBody after = body;
  after.velocity = result.after;
  result.energy_change_j = kinetic_energy(after) - kinetic_energy(body);
  result.pdof_deg = pdof_deg(impulse, body.forward);
  result.clock = clock_of(result.pdof_deg);
  return result;
}

}  // namespace

RigidBody place(const MassProperties& properties, const Pose& body_in_world,
                const Velocity& velocity) {
  RigidBody body;
  body.mass_kg = properties.mass_kg;
  const Matrix3d& r = body_in_world.rotation;
  body.center_m = detail::rotate(r, properties.center_m) + body_in_world.translation;
  body.inertia_kgm2 = r * properties.inertia_kgm2 * r.transpose();
  body.velocity.linear_mps = velocity_of_point(velocity, body_in_world.translation, body.center_m);
  body.velocity.angular_radps = velocity.angular_radps;
  body.forward = r.col(0);
  return body;
}

double kinetic_energy(const RigidBody& body) {
  if (!body.movable()) return 0.0;
  const Vector3d& w = body.velocity.angular_radps;
  return 0.5 * body.mass_kg * body.velocity.linear_mps.squaredNorm() +
         0.5 * w.dot(body.inertia_kgm2 * w);
}

double pdof_deg(const Vector3d& impulse_on_body, const Vector3d& forward) {
  const Eigen::Vector2d ahead = forward.head<2>();
  const Eigen::Vector2d from = -impulse_on_body.head<2>();
  const double x = from.dot(ahead);
  const double right = from.x() * ahead.y() - from.y() * ahead.x();
  if (x == 0.0 && right == 0.0) return 0.0;
  double degrees = std::atan2(right, x) * (180.0 / std::numbers::pi);
  if (degrees < 0.0) degrees += 360.0;
  return degrees >= 360.0 ? 0.0 : degrees;
}

int clock_of(double pdof_deg) {
  const int hour = static_cast<int>(std::floor((pdof_deg + 15.0) / 30.0)) % 12;
  return hour == 0 ? 12 : hour;
}

ImpulseResult impulse(const RigidBody& a, const RigidBody& b, const Vector3d& point_m,
                      const Vector3d& normal, const ImpulseOptions& options) {
  ImpulseResult result;
  result.restitution = options.restitution;
  const Response ra = response(a, point_m, options.space);
  const Response rb = response(b, point_m, options.space);
  Contact c;
  c.k = ra.at_contact() + rb.at_contact();
  c.approach = point_velocity(a, ra.arm) - point_velocity(b, rb.arm);
  c.n = normal;
  c.friction = options.friction;
  c.planar = options.space == ImpulseSpace::planar;
  if (c.planar) {
    c.n.z() = 0.0;
    c.approach.z() = 0.0;
    if (c.n.norm() < 1e-6) return result;
    c.n.normalize();
  }
  result.normal_speed_mps = c.n.dot(c.approach);
  if (!(result.normal_speed_mps > 0.0) || (!a.movable() && !b.movable())) return result;

  Push push = solve(c, options.restitution);
  if (energy_change(c, push.impulse) > 0.0) {
    // Without restitution energy is only lost: the way from the frictionless impulse to the one
    // that stops all sliding goes downhill. So a restitution that keeps it lies between.
    double keeps = 0.0;
    double gains = options.restitution;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (keeps + gains);
      (energy_change(c, solve(c, middle).impulse) > 0.0 ? gains : keeps) = middle;
    }
    result.restitution = keeps;
    push = solve(c, keeps);
  }
  result.acts = true;
  result.slides = push.slides;
  result.friction_needed = push.friction_needed;
  const Vector3d after = c.approach - c.k * push.impulse;
  result.separation_speed_mps = -c.n.dot(after);
  result.sliding_speed_mps = (after - c.n.dot(after) * c.n).norm();
  result.dissipated_j = std::max(0.0, -energy_change(c, push.impulse));
  result.a = apply(a, ra, -push.impulse);
  result.b = apply(b, rb, push.impulse);
  return result;
}

}  // namespace crashrank

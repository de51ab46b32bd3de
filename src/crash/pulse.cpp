#include "crashrank/crash/pulse.hpp"

#include "crash/facets.hpp"
#include "crash/material.hpp"

#include "crashrank/crash/depth_map.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <vector>

namespace crashrank {
namespace {

using detail::Facet;
using detail::Material;
using Eigen::Vector2d;
using Eigen::Vector3d;

double cross(const Vector2d& p, const Vector2d& q) { return p.x() * q.y() - p.y() * q.x(); }

Vector2d turned(const Vector2d& v, double c, double s) {
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

/// A rigid body in the plane of the view.
struct Planar {
  double inverse_mass = 0.0;
  double inverse_inertia = 0.0;
  Vector2d start = Vector2d::Zero();  ///< centre of mass when the pulse begins
  Vector2d center = Vector2d::Zero();
  Vector2d velocity = Vector2d::Zero();
  double spin = 0.0;
  double angle = 0.0;
  double cosine = 1.0;
  double sine = 0.0;

  Vector2d velocity_at(const Vector2d& p) const {
    return velocity + spin * Vector2d(center.y() - p.y(), p.x() - center.x());
  }
  Vector2d carried(const Vector2d& p) const { return center + out(p - start); }
  Vector2d taken_back(const Vector2d& p) const { return start + in(p - center); }
  Vector2d out(const Vector2d& v) const { return turned(v, cosine, sine); }
  Vector2d in(const Vector2d& v) const { return turned(v, cosine, -sine); }

  void push(const Vector2d& impulse, double moment) {
    velocity += inverse_mass * impulse;
    spin += inverse_inertia * moment;
  }
  void move(double dt) {
    center += dt * velocity;
    angle += dt * spin;
    cosine = std::cos(angle);
    sine = std::sin(angle);
  }
};

Planar make_planar(const RigidBody& body, const ViewFrame& frame) {
  Planar p;
  p.start = frame.into(body.center_m).head<2>();
  p.center = p.start;
  if (!body.movable()) return p;
  p.inverse_mass = 1.0 / body.mass_kg;
  p.inverse_inertia = 1.0 / body.inertia_kgm2(2, 2);
  p.velocity = (frame.axes * body.velocity.linear_mps).head<2>();
  p.spin = body.velocity.angular_radps.z();
  return p;
}

/// Forces of one instant.
struct Wrench {
  Vector2d on_a = Vector2d::Zero();
  double moment_a = 0.0;  ///< about A's centre of mass
  double moment_b = 0.0;  ///< of the opposite forces about B's
  double friction_w = 0.0;
  double pressing = 0.0;
  Vector2d pressed_at = Vector2d::Zero();  ///< times `pressing`
};

/// The two surfaces in each other's way, looked at once.
struct Surfaces {
  DepthMap map_a;
  std::vector<Facet> facets;  ///< of B
};

Surfaces look(const PulseBody& a, const PulseBody& b, const ViewFrame& frame,
              const PulseOptions& options) {
  Surfaces surfaces;
  Vector3d low_a;
  Vector3d high_a;
  Vector3d low_b;
  Vector3d high_b;
  view_bounds(*a.mesh, a.pose, frame, low_a, high_a);
  view_bounds(*b.mesh, b.pose, frame, low_b, high_b);
  const double low = std::max(low_a.z(), low_b.z());
  const double high = std::min(high_a.z(), high_b.z());
  if (!(low < high)) return surfaces;
  constexpr double aside = 0.5;  // how far B may come in from the side
  const double rim = options.cell_w_m;
  const double left = std::max(low_b.y() - rim, low_a.y() - aside);
  const double right = std::min(high_b.y() + rim, high_a.y() + aside);
  if (!(left < right)) return surfaces;
  const ViewGrid grid_a =
      grid_over({low_a.y(), low}, {high_a.y(), high}, options.cell_w_m, options.cell_h_m);
  ViewGrid grid_b = grid_over({left, low}, {right, high}, options.cell_w_m, options.cell_h_m);
  // Rows have to be the same.
  grid_b.rows = grid_a.rows;
  grid_b.cell_h_m = grid_a.cell_h_m;
  surfaces.map_a = depth_map(*a.mesh, a.pose, frame, grid_a);
  const DepthMap map_b = depth_map(*b.mesh, b.pose, frame, grid_b);
  surfaces.facets = detail::facets_of(map_b, low_b.x() + (high_a.x() - low_a.x()));
  return surfaces;
}

class Pulse {
public:
  Pulse(const PulseBody& a, const PulseBody& b, const ViewFrame& frame, const Surfaces& surfaces,
        const PulseVariant& variant, const PulseOptions& options)
      : options_(options),
        variant_(variant),
        frame_(frame),
        body_a_(a),
        body_b_(b),
        a_(make_planar(a.rigid, frame)),
        b_(make_planar(b.rigid, frame)),
        material_a_(a, frame),
        material_b_(b, frame),
        map_a_(surfaces.map_a),
        facets_(surfaces.facets),
        crushed_(surfaces.map_a.grid.size(), 0.0) {}

  PulseResult run() {
    if (facets_.empty()) return result_;
    constexpr double quiet_s = 0.03;  // long after the last force nothing follows
    double quiet = 0.0;
    for (double t = 0.0; t < options_.longest_s; t += options_.step_s) {
      const Wrench wrench = feel();
      remember();
      if (wrench.pressing > 0.0) {
        quiet = 0.0;
        result_.duration_s = t + options_.step_s;
        apply(wrench);
      } else if (result_.acts) {
        quiet += options_.step_s;
        if (quiet > quiet_s) break;
      }
      a_.move(options_.step_s);
      b_.move(options_.step_s);
    }
    finish();
    return result_;
  }

private:
  /// The cell of A in front of a point and how deep the point lies in it; false where A is not.
  bool find(const Vector2d& in_a, std::size_t row, std::size_t& cell, double& depth) const {
    const ViewGrid& grid = map_a_.grid;
    const double column = std::floor((in_a.y() - grid.low_w_m) / grid.cell_w_m);
    if (!(column >= 0.0 && column < static_cast<double>(grid.columns))) return false;
    cell = grid.index(static_cast<std::size_t>(column), row);
    if (!map_a_.covered(cell) || in_a.x() < map_a_.least_m[cell]) return false;
    depth = map_a_.greatest_m[cell] - in_a.x();
    return depth > 0.0;
  }

  Wrench feel() const {
    // Below this speed force grows with it instead of jumping with its sign.
    constexpr double even_mps = 0.2;
    Wrench sum;
    for (const Facet& facet : facets_) {
      const Vector2d at = b_.carried(facet.point);
      const Vector2d n = b_.out(facet.normal);
      // Half a cell ahead is the material that is met next.
      const Vector2d ahead = a_.taken_back(at + (0.5 * options_.cell_w_m) * n);
      std::size_t cell = 0;
      double depth = 0.0;
      if (!find(ahead, facet.row, cell, depth) || depth < crushed_[cell]) continue;
      const Vector2d slip = b_.velocity_at(at) - a_.velocity_at(at);
      const double advance = slip.dot(n);
      if (advance <= 0.0) continue;
      const Vector2d n_a = a_.in(n);
      const double along = std::clamp(a_.in(slip).x() * n_a.x() / advance, 0.0, 1.0);
      const double height = map_a_.grid.h_of(facet.row);
      const CrushPressure law_a = material_a_.law(ahead, height, n_a);
      const CrushPressure law_b =
          material_b_.law(facet.point - (0.5 * depth) * facet.normal, height, -facet.normal);
      const double pressure =
          variant_.strength * share_crush(law_a, law_b, depth * along).pressure_pa;
      const double push = pressure * facet.area_m2 * std::min(1.0, advance / even_mps);
      const Vector2d across = slip - advance * n;
      const Vector2d drag = variant_.friction * push / std::max(across.norm(), even_mps) * across;
      const Vector2d force = push * n + drag;
      sum.on_a += force;
      sum.moment_a += cross(at - a_.center, force);
      sum.moment_b -= cross(at - b_.center, force);
      sum.friction_w += drag.dot(across);
      sum.pressing += push;
      sum.pressed_at += push * at;
    }
    return sum;
  }

  /// Columns of A that B's surface has pushed back.
  void remember() {
    constexpr double sideways = 1e-3;
    for (const Facet& facet : facets_) {
      if (facet.normal.x() > -sideways) continue;
      std::size_t cell = 0;
      double depth = 0.0;
      if (!find(a_.taken_back(b_.carried(facet.point)), facet.row, cell, depth)) continue;
      crushed_[cell] = std::max(crushed_[cell], depth);
      result_.deepest_m = std::max(result_.deepest_m, depth);
    }
  }

  void apply(const Wrench& w) {
    const double dt = options_.step_s;
    // The kinetic energy over the step is a parabola: never past its lowest point.
    const double slope =
        w.on_a.dot(a_.velocity - b_.velocity) + w.moment_a * a_.spin + w.moment_b * b_.spin;
    const double bend = w.on_a.squaredNorm() * (a_.inverse_mass + b_.inverse_mass) +
                        w.moment_a * w.moment_a * a_.inverse_inertia +
                        w.moment_b * w.moment_b * b_.inverse_inertia;
    if (!(slope < 0.0) || !(bend > 0.0)) return;
    const double step = std::min(dt, -slope / bend);
    last_at_ = w.pressed_at / w.pressing;
    if (!result_.acts) first_slip_ = (b_.velocity_at(last_at_) - a_.velocity_at(last_at_)).norm();
    const Vector2d impulse = step * w.on_a;
    a_.push(impulse, step * w.moment_a);
    b_.push(-impulse, step * w.moment_b);
    impulse_ += impulse;
    pressed_ += step * w.pressing;
    pressed_at_ += step * w.pressed_at;
    result_.friction_j += step * w.friction_w;
    result_.acts = true;
  }

  void tell(const RigidBody& body, const Planar& end, double sign, BodyImpulse& told) const {
    told.impulse_ns =
        frame_.axes.transpose() * Vector3d(sign * impulse_.x(), sign * impulse_.y(), 0);
    told.after = body.velocity;
    if (!body.movable()) return;
    told.delta_v_mps = told.impulse_ns / body.mass_kg;
    told.after.linear_mps += told.delta_v_mps;
    told.after.angular_radps.z() = end.spin;
    told.delta_omega_radps = told.after.angular_radps - body.velocity.angular_radps;
    RigidBody after = body;
    after.velocity = told.after;
    told.energy_change_j = kinetic_energy(after) - kinetic_energy(body);
    told.pdof_deg = pdof_deg(told.impulse_ns, body.forward);
    told.clock = clock_of(told.pdof_deg);
  }

  void finish() {
    constexpr double kept = 0.2;
    if (!result_.acts) return;
    const Vector2d slip = b_.velocity_at(last_at_) - a_.velocity_at(last_at_);
    result_.slides = slip.norm() > kept * first_slip_;
    const Vector2d middle = pressed_at_ / pressed_;
    result_.point_m =
        frame_.axes.transpose() * Vector3d(middle.x(), middle.y(), 0) + frame_.origin_m;
    tell(body_a_.rigid, a_, 1.0, result_.a);
    tell(body_b_.rigid, b_, -1.0, result_.b);
    result_.dissipated_j = std::max(0.0, -(result_.a.energy_change_j + result_.b.energy_change_j));
  }

  const PulseOptions& options_;
  PulseVariant variant_;
  const ViewFrame& frame_;
  const PulseBody& body_a_;
  const PulseBody& body_b_;
  Planar a_;
  Planar b_;
  Material material_a_;
  Material material_b_;
  const DepthMap& map_a_;
  const std::vector<Facet>& facets_;
  std::vector<double> crushed_;  ///< by cell of A: how deep it was pushed back
  Vector2d impulse_ = Vector2d::Zero();
  double pressed_ = 0.0;
  Vector2d pressed_at_ = Vector2d::Zero();
  Vector2d last_at_ = Vector2d::Zero();
  double first_slip_ = 0.0;
  PulseResult result_;
};

}  // namespace

std::vector<PulseResult> simulate_pulses(const PulseBody& a, const PulseBody& b,
                                         const Vector3d& point_m, const Vector3d& along,
                                         View<const PulseVariant> variants,
                                         const PulseOptions& options) {
  std::vector<PulseResult> results(variants.size());
  if (!(along.head<2>().norm() > 0.0) || (!a.rigid.movable() && !b.rigid.movable()) ||
      (a.strength.rigid && b.strength.rigid)) {
    return results;
  }
  const ViewFrame frame = view_along(along, point_m);
  const Surfaces surfaces = look(a, b, frame, options);
  for (std::size_t i = 0; i < variants.size(); ++i) {
    results[i] = Pulse(a, b, frame, surfaces, variants[i], options).run();
  }
  return results;
}

PulseResult simulate_pulse(const PulseBody& a, const PulseBody& b, const Vector3d& point_m,
                           const Vector3d& along, const PulseOptions& options) {
  const PulseVariant given{options.friction, 1.0};
  return simulate_pulses(a, b, point_m, along, {&given, 1}, options).front();
}

}  // namespace crashrank

#include "crash/pulse_run.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace crashrank::detail {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double endless = std::numeric_limits<double>::infinity();

/// Columns are found by a rounded division.
constexpr double rounding_m = 1e-9;

double cross(const Vector2d& p, const Vector2d& q) { return p.x() * q.y() - p.y() * q.x(); }

PlanarBody make_planar(const RigidBody& body, const ViewFrame& frame) {
  PlanarBody p;
  p.start = frame.into(body.center_m).head<2>();
  p.center = p.start;
  if (!body.movable()) return p;
  p.inverse_mass = 1.0 / body.mass_kg;
  p.inverse_inertia = 1.0 / body.inertia_kgm2(2, 2);
  p.velocity = (frame.axes * body.velocity.linear_mps).head<2>();
  p.spin = body.velocity.angular_radps.z();
  return p;
}

}  // namespace

void PlanarBody::push(const Vector2d& impulse, double moment) {
  velocity += inverse_mass * impulse;
  spin += inverse_inertia * moment;
}

void PlanarBody::move(double dt) {
  center += dt * velocity;
  if (spin == 0.0) return;
  angle += dt * spin;
  cosine = std::cos(angle);
  sine = std::sin(angle);
}

PulseRun::PulseRun(const PulseBody& a, const PulseBody& b, const ViewFrame& frame,
                   const PulseVariant& variant, const PulseOptions& options, PulseMemory& memory)
    : options_(options),
      variant_(variant),
      frame_(frame),
      body_a_(a),
      body_b_(b),
      memory_(memory),
      a_(make_planar(a.rigid, frame)),
      b_(make_planar(b.rigid, frame)),
      material_a_(a, frame),
      material_b_(b, frame) {
  energy_before_j_ = moving_j();
  speed_before_mps_ = (a_.velocity - b_.velocity).norm();
  speeds_before_mps_ = a_.velocity.norm() + b_.velocity.norm();
  over_ = memory.facets.empty();
  if (over_) return;
  memory.crushed_m.assign(memory.map_a.grid.size(), 0.0);
  put_to_sleep();
}

// Facets whose way to A's surface is longer than any facet has moved yet are not looked at: they
// bear no force. That is most of them, most of the time.

/// No point that lies outside A comes into it before it has moved this far; negative inside.
double PulseRun::clearance(const Vector2d& in_a, std::size_t row) const {
  const ViewGrid& grid = memory_.map_a.grid;
  const double right = grid.low_w_m + grid.cell_w_m * static_cast<double>(grid.columns);
  return std::max(
             {in_a.x() - memory_.row_front_m[row], grid.low_w_m - in_a.y(), in_a.y() - right}) -
         rounding_m;
}

void PulseRun::put_to_sleep() {
  const std::size_t count = memory_.facets.size();
  memory_.wakes_m.assign(count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    const Facet& facet = memory_.facets[i];
    const double arm = (facet.point - b_.start).norm() + options_.cell_w_m;
    reach_b_m_ = std::max(reach_b_m_, arm);
    // The point felt is half a cell before the facet.
    memory_.wakes_m[i] = clearance(facet.point, facet.row) - 0.5 * options_.cell_w_m;
  }
  wake();
}

void PulseRun::wake() {
  constexpr double ahead_m = 0.05;
  const auto count = static_cast<std::uint32_t>(memory_.wakes_m.size());
  AwakeFacets& awake = memory_.awake;
  awake.facet.clear();
  next_wake_m_ = endless;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (memory_.wakes_m[i] <= moved_m_ + ahead_m) {
      awake.facet.push_back(i);
    } else {
      next_wake_m_ = std::min(next_wake_m_, memory_.wakes_m[i]);
    }
  }
  awake.resize(awake.facet.size());
  for (std::size_t k = 0; k < awake.size(); ++k) {
    const Facet& facet = memory_.facets[awake.facet[k]];
    awake.x[k] = facet.point.x();
    awake.y[k] = facet.point.y();
    awake.normal_x[k] = facet.normal.x();
    awake.normal_y[k] = facet.normal.y();
    awake.front_m[k] = memory_.row_front_m[facet.row];
  }
  work_ += count / 8;
}

/// The cell of A in front of a point and how deep the point lies in it; false where A is not.
bool PulseRun::find(const Vector2d& in_a, std::size_t row, std::size_t& cell, double& depth) const {
  const DepthMap& map = memory_.map_a;
  const ViewGrid& grid = map.grid;
  // Cutting off is rounding down where nothing is below 0.
  const double column = (in_a.y() - grid.low_w_m) / grid.cell_w_m;
  if (!(column >= 0.0 && column < static_cast<double>(grid.columns))) return false;
  cell = grid.index(static_cast<std::size_t>(column), row);
  if (!map.covered(cell) || in_a.x() < map.least_m[cell]) return false;
  depth = map.greatest_m[cell] - in_a.x();
  return depth > 0.0;
}

/// Where the facets that are awake have come to, and how fast they advance: the same operations in
/// the same order as `PlanarBody` has them, on plain arrays, so that they are done several at once.
void PulseRun::carry_awake() {
  AwakeFacets& awake = memory_.awake;
  const std::size_t count = awake.size();
  const ViewGrid& grid = memory_.map_a.grid;
  const PlanarBody a = a_;
  const PlanarBody b = b_;
  const double left = grid.low_w_m;
  const double right = grid.low_w_m + grid.cell_w_m * static_cast<double>(grid.columns);
  const double half_cell = 0.5 * options_.cell_w_m;
  const double* const x = awake.x.data();
  const double* const y = awake.y.data();
  const double* const normal_x = awake.normal_x.data();
  const double* const normal_y = awake.normal_y.data();
  const double* const front = awake.front_m.data();
  double* __restrict const at_x = awake.at_x.data();
  double* __restrict const at_y = awake.at_y.data();
  double* __restrict const in_a_x = awake.in_a_x.data();
  double* __restrict const in_a_y = awake.in_a_y.data();
  double* __restrict const clear = awake.clear_m.data();
  double* __restrict const advance = awake.advance_mps.data();
  for (std::size_t k = 0; k < count; ++k) {
    const double from_x = x[k] - b.start.x();
    const double from_y = y[k] - b.start.y();
    const double px = b.center.x() + (b.cosine * from_x - b.sine * from_y);
    const double py = b.center.y() + (b.sine * from_x + b.cosine * from_y);
    const double to_x = px - a.center.x();
    const double to_y = py - a.center.y();
    const double ax = a.start.x() + (a.cosine * to_x + a.sine * to_y);
    const double ay = a.start.y() + (a.cosine * to_y - a.sine * to_x);
    const double before = ax - front[k];
    const double beside = left - ay > ay - right ? left - ay : ay - right;
    clear[k] = ((before > beside ? before : beside) - rounding_m) - half_cell;
    const double nx = b.cosine * normal_x[k] - b.sine * normal_y[k];
    const double ny = b.sine * normal_x[k] + b.cosine * normal_y[k];
    const double slip_x = (b.velocity.x() + b.spin * (b.center.y() - py)) -
                          (a.velocity.x() + a.spin * (a.center.y() - py));
    const double slip_y = (b.velocity.y() + b.spin * (px - b.center.x())) -
                          (a.velocity.y() + a.spin * (px - a.center.x()));
    advance[k] = slip_x * nx + slip_y * ny;
    at_x[k] = px;
    at_y[k] = py;
    in_a_x[k] = ax;
    in_a_y[k] = ay;
  }
}

PulseRun::Wrench PulseRun::feel() {
  // Below this speed force grows with it instead of jumping with its sign.
  constexpr double even_mps = 0.2;
  constexpr double rest_m = 0.1;  // a facet this far away is put to sleep again
  Wrench sum;
  const ViewGrid& grid = memory_.map_a.grid;
  const double half_cell = 0.5 * options_.cell_w_m;
  AwakeFacets& awake = memory_.awake;
  std::size_t kept = 0;
  const std::size_t count = awake.size();
  work_ += count;
  carry_awake();
  for (std::size_t k = 0; k < count; ++k) {
    const double clear = awake.clear_m[k];
    const std::uint32_t i = awake.facet[k];
    if (clear > rest_m) {
      memory_.wakes_m[i] = moved_m_ + clear;
      next_wake_m_ = std::min(next_wake_m_, memory_.wakes_m[i]);
      continue;
    }
    const Vector2d at(awake.at_x[k], awake.at_y[k]);
    const double advance = awake.advance_mps[k];
    if (kept < k) awake.keep(k, kept);
    ++kept;
    if (clear > 0.0 || advance <= 0.0) continue;
    const Facet& facet = memory_.facets[i];
    const Vector2d n = b_.out(facet.normal);
    // Half a cell ahead is the material that is met next.
    const Vector2d ahead = a_.taken_back(at + half_cell * n);
    std::size_t cell = 0;
    double depth = 0.0;
    if (!find(ahead, facet.row, cell, depth) || depth < memory_.crushed_m[cell]) continue;
    const Vector2d slip = b_.velocity_at(at) - a_.velocity_at(at);
    const Vector2d n_a = a_.in(n);
    const double along = std::clamp(a_.in(slip).x() * n_a.x() / advance, 0.0, 1.0);
    const CrushPressure law_a = material_a_.law(ahead, grid.h_of(facet.row), n_a);
    const FacetLaw& own = memory_.laws[i];
    CrushPressure law_b = own.core;
    if (!law_b.rigid) {
      const CrushCore& core = material_b_.strength().core;
      const double share =
          material_b_.core_share(facet.point - (0.5 * depth) * facet.normal, grid.h_of(facet.row));
      law_b = share == core.inside ? own.core : own.aside;
    }
    const double pressure = variant_.strength * shared_pressure(law_a, law_b, depth * along);
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
  if (kept < count) awake.resize(kept);
  return sum;
}

/// Columns of A that B's surface has pushed back.
void PulseRun::remember() {
  constexpr double sideways = 1e-3;
  const AwakeFacets& awake = memory_.awake;
  for (std::size_t k = 0; k < awake.size(); ++k) {
    // Before A's outermost point nothing is pushed back.
    if (awake.normal_x[k] > -sideways || awake.in_a_x[k] >= awake.front_m[k]) continue;
    std::size_t cell = 0;
    double depth = 0.0;
    const Vector2d at(awake.in_a_x[k], awake.in_a_y[k]);
    if (!find(at, memory_.facets[awake.facet[k]].row, cell, depth)) continue;
    memory_.crushed_m[cell] = std::max(memory_.crushed_m[cell], depth);
    result_.deepest_m = std::max(result_.deepest_m, depth);
  }
}

void PulseRun::apply(const Wrench& w) {
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

/// Moves both bodies on, and with them the bound on how far any facet has come in A's frame: as far
/// as the centres came nearer and both turns swept.
void PulseRun::move() {
  const double dt = options_.step_s;
  const double before = (b_.center - a_.center).norm();
  a_.move(dt);
  b_.move(dt);
  const double arm = std::max(before, (b_.center - a_.center).norm()) + reach_b_m_;
  const double rate =
      (b_.velocity - a_.velocity).norm() + std::abs(b_.spin) * reach_b_m_ + std::abs(a_.spin) * arm;
  moved_m_ += dt * rate * (1.0 + 1e-9);
  if (moved_m_ >= next_wake_m_) wake();
}

bool PulseRun::advance(int steps) {
  constexpr double quiet_s = 0.03;  // long after the last force nothing follows
  const auto all = static_cast<int>(std::ceil(options_.longest_s / options_.step_s));
  for (; steps > 0 && !over_; --steps) {
    if (step_ >= all) {
      over_ = true;
      break;
    }
    const Wrench wrench = feel();
    remember();
    const bool presses = wrench.pressing > 0.0;
    if (presses) {
      quiet_s_ = 0.0;
      apply(wrench);
    } else if (result_.acts) {
      quiet_s_ += options_.step_s;
      if (quiet_s_ > quiet_s) {
        over_ = true;
        break;
      }
    }
    move();
    ++step_;
    if (presses) {
      result_.duration_s = step_ * options_.step_s;
      end_a_ = a_;
      end_b_ = b_;
    }
  }
  return !over_;
}

Vector3d PulseRun::in_world(const Vector2d& v) const {
  return frame_.axes.transpose() * Vector3d(v.x(), v.y(), 0.0);
}

void PulseRun::tell(const RigidBody& body, const PlanarBody& end, double sign,
                    BodyImpulse& told) const {
  told.impulse_ns = in_world(sign * impulse_);
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

PulseResult PulseRun::result() const {
  constexpr double kept = 0.2;
  PulseResult result = result_;
  if (!result.acts) return result;
  const Vector2d slip = b_.velocity_at(last_at_) - a_.velocity_at(last_at_);
  result.slides = slip.norm() > kept * first_slip_;
  const Vector2d middle = pressed_at_ / pressed_;
  result.point_m = in_world(middle) + frame_.origin_m;
  tell(body_a_.rigid, a_, 1.0, result.a);
  tell(body_b_.rigid, b_, -1.0, result.b);
  result.moved_a_m = in_world(end_a_.center - end_a_.start);
  result.moved_b_m = in_world(end_b_.center - end_b_.start);
  result.turned_a_rad = end_a_.angle;
  result.turned_b_rad = end_b_.angle;
  result.dissipated_j = std::max(0.0, -(result.a.energy_change_j + result.b.energy_change_j));
  return result;
}

}  // namespace crashrank::detail

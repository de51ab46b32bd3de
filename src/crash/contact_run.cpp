#include "crash/contact_run.hpp"

#include "crash/pair_order.hpp"
#include "crash/rebound.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;

/// Friction of folded sheet metal in folded sheet metal: rails and folds hook into each other.
constexpr float interlocked_friction = 1.0F;
/// Share of the closing speed under which bodies count as at rest against each other.
constexpr double at_rest = 0.03;
/// A contact that still moves past at a quarter of its speed or more does not rebound.
constexpr double slipping_share = 0.25;

/// No point of the outlines is further from the centre of mass.
double rim_of(const Vehicle& v) {
  const Silhouettes& s = v.silhouettes;
  const double x = std::max(std::abs(static_cast<double>(s.min_x) - v.center_m.x()),
                            std::abs(static_cast<double>(s.max_x) - v.center_m.x()));
  const double y = std::max(std::abs(static_cast<double>(s.min_y) - v.center_m.y()),
                            std::abs(static_cast<double>(s.max_y) - v.center_m.y()));
  return std::hypot(x, y);
}

}  // namespace

bool can_press(const ContactBody& a, const ContactBody& b) {
  return (a.vehicle->movable() || b.vehicle->movable()) &&
         (!a.vehicle->strength.rigid || !b.vehicle->strength.rigid);
}

ContactRun::ContactRun(const ContactBody& a, const ContactBody& b, View<const ContactBody> fixed,
                       const Vector3d& point_m, const ContactVariant& variant,
                       const ContactOptions& options, ContactWorkspace& workspace)
    : options_(options),
      variant_(variant),
      swapped_(goes_second(a, b)),
      origin_m_(point_m.x(), point_m.y(), 0.0),
      state_(workspace.state()) {
  given_first_ = swapped_ ? b : a;
  given_second_ = swapped_ ? a : b;
  const std::size_t others = 1 + (given_second_.vehicle->movable() ? 0 : fixed.size());
  state_.bodies.clear();
  const auto add = [&](const ContactBody& body) {
    state_.bodies.push_back(
        {body.vehicle, {body.vehicle->strength, variant.strength}, make_planar(body, origin_m_)});
  };
  add(given_first_);
  add(given_second_);
  for (std::size_t k = 1; k < others; ++k) add(fixed[k - 1]);
  std::size_t pieces = 0;
  for (const PressedBody& body : state_.bodies) {
    pieces = std::max(pieces, body.vehicle->profile->pieces.size());
  }
  if (state_.near.size() < others + 1) state_.near.resize(others + 1);
  for (std::size_t k = 0; k <= others; ++k) {
    state_.near[k].resize(pieces);
    state_.near[k].begin();
  }
  state_.records.assign(others + 1, {});
  state_.forces.assign(others + 1, {});
  state_.impulses.assign(others + 1, {});
  state_.pressed.assign(others + 1, 0);

  start_first_ = end_first_ = state_.bodies[0].motion;
  start_second_ = end_second_ = state_.bodies[1].motion;
  record_.begin(start_first_, start_second_);
  friction_ = friction_between(given_first_.vehicle->surface, given_second_.vehicle->surface);
  rim_m_ = rim_of(*given_first_.vehicle);
  if (given_second_.vehicle->movable()) {
    rim_m_ = std::max(rim_m_, rim_of(*given_second_.vehicle));
  }
  energy_before_j_ = moving_j();
  speed_before_mps_ = relative_speed();
  momentum_before_ns_ =
      speed_before_mps_ / (start_first_.inverse_mass + start_second_.inverse_mass);
  const PlanarBody& p = start_first_;
  const PlanarBody& q = start_second_;
  speeds_before_mps_ = std::hypot(p.vx, p.vy) + std::hypot(q.vx, q.vy);
  speed_mps_ = speed_at_rims();
  over_ = !can_press(given_first_, given_second_);
}

double ContactRun::relative_speed() const {
  const PlanarBody& p = state_.bodies[0].motion;
  const PlanarBody& q = state_.bodies[1].motion;
  return std::hypot(p.vx - q.vx, p.vy - q.vy);
}

double ContactRun::speed_at_rims() const {
  const PlanarBody& p = state_.bodies[0].motion;
  const PlanarBody& q = state_.bodies[1].motion;
  return relative_speed() + rim_m_ * std::abs(p.spin - q.spin);
}

double ContactRun::moving_j() const {
  return state_.bodies[0].motion.energy() + state_.bodies[1].motion.energy();
}

ContactRun::Totals ContactRun::feel() {
  PressedBody& first = state_.bodies[0];
  const std::size_t others = state_.bodies.size() - 1;
  Totals totals;
  std::fill(state_.forces.begin(), state_.forces.end(), PlanarForce{});
  const auto add = [&](const PassSums& sums, bool own_is_first) {
    totals.approaching = totals.approaching || sums.approaching;
    totals.pressing += sums.pressing;
    totals.closing += sums.closing;
    totals.passing += sums.passing;
    const double own_j = sums.power_own * step_s_;
    const double other_j = sums.power_other * step_s_;
    crush_first_j_ += own_is_first ? own_j : other_j;
    crush_second_j_ += own_is_first ? other_j : own_j;
    friction_j_ += sums.power_friction * step_s_;
    depth_first_m_ = std::max(depth_first_m_, own_is_first ? sums.depth_own : sums.depth_other);
    depth_second_m_ = std::max(depth_second_m_, own_is_first ? sums.depth_other : sums.depth_own);
    totals.fresh += sums.fresh;
    totals.weight += sums.weight;
    totals.point_x += sums.point_x;
    totals.point_y += sums.point_y;
  };
  PassSettings settings;
  settings.step_s = step_s_;
  settings.since_s = since_s_;
  for (std::size_t k = 1; k <= others; ++k) {
    PressedBody& other = state_.bodies[k];
    const double base = friction_between(first.vehicle->surface, other.vehicle->surface);
    settings.friction = static_cast<float>(base * variant_.friction);
    const bool metals = first.vehicle->surface == Surface::sheet_metal &&
                        other.vehicle->surface == Surface::sheet_metal;
    settings.interlocked = metals ? interlocked_friction : 0.0F;
    PlanarForce on_first;
    double pressing = 0.0;
    if (!first.response.rigid) {
      settings.neighbours = {state_.bodies.data() + 1, others > 1 ? others : 0};
      settings.self = k - 1;
      PassSums sums;
      press_pieces(other, first, settings, moved_m_, state_.near[k], sums, state_.records[k]);
      pieces_ += state_.near[k].pieces;
      add(sums, true);
      on_first = sums.on_pressed;
      pressing += sums.pressing;
    }
    if (!other.response.rigid) {
      settings.neighbours = {};
      PassSums sums;
      press_pieces(first, other, settings, moved_m_, state_.near[0], sums, state_.records[0]);
      pieces_ += state_.near[0].pieces;
      add(sums, false);
      on_first.x -= sums.on_pressed.x;
      on_first.y -= sums.on_pressed.y;
      on_first.moment -= sums.on_pressed.moment;
      pressing += sums.pressing;
    }
    if (pressing > 0.0) state_.pressed[k] = 1;
    // Moments about the point of first contact become those about the centres of mass.
    const PlanarBody& p = first.motion;
    const PlanarBody& q = other.motion;
    PlanarForce& on = state_.forces[0];
    on.x += on_first.x;
    on.y += on_first.y;
    on.moment += on_first.moment - (p.x * on_first.y - p.y * on_first.x);
    state_.forces[k] = {-on_first.x, -on_first.y,
                        -(on_first.moment - (q.x * on_first.y - q.y * on_first.x))};
  }
  return totals;
}

/// How the energy changes along a share k of forces or impulses: slope·k + bend·k²/2.
ContactRun::EnergyChange ContactRun::energy_along(const std::vector<PlanarForce>& on) const {
  EnergyChange change;
  for (std::size_t k = 0; k < state_.bodies.size(); ++k) {
    const PlanarBody& body = state_.bodies[k].motion;
    const PlanarForce& f = on[k];
    change.slope += f.x * body.vx + f.y * body.vy + f.moment * body.spin;
    change.bend +=
        (f.x * f.x + f.y * f.y) * body.inverse_mass + f.moment * f.moment * body.inverse_inertia;
  }
  return change;
}

/// Applies the forces for the step, but no longer than until the energy is least: so none is ever
/// gained, however stiff what was met is.
void ContactRun::push() {
  const auto [slope, bend] = energy_along(state_.forces);
  const PlanarBody& p = state_.bodies[0].motion;
  const PlanarBody& q = state_.bodies[1].motion;
  const PlanarForce& on = state_.forces[0];
  const double force = std::hypot(on.x, on.y);
  acceleration_mps2_ = force * (p.inverse_mass + q.inverse_mass) +
                       rim_m_ * (std::abs(on.moment) * p.inverse_inertia +
                                 std::abs(state_.forces[1].moment) * q.inverse_inertia);
  double seconds = 0.0;
  if (slope < 0.0 && bend > 0.0) seconds = std::min(step_s_, -slope / bend);
  const double before = moving_j();
  for (std::size_t k = 0; k < state_.bodies.size(); ++k) {
    const PlanarForce& f = state_.forces[k];
    state_.bodies[k].motion.push(seconds * f.x, seconds * f.y, seconds * f.moment);
    PlanarForce& sum = state_.impulses[k];
    sum.x += seconds * f.x;
    sum.y += seconds * f.y;
    const PlanarBody& at = state_.bodies[k].motion;
    sum.moment += seconds * (f.moment + at.x * f.y - at.y * f.x);
  }
  lost_j_ += before - moving_j();
  const double impulse = seconds * force;
  impulse_ns_ += impulse;
  late_ns_ += impulse;
  // So small a share of the whole counts as no force.
  constexpr double nothing = 3e-4;
  if (impulse > nothing * impulse_ns_) quiet_m_ = 0.0;
}

ContactRun::AtForce ContactRun::at_force(const Totals& totals) const {
  const PlanarForce& on = state_.forces[0];
  const double force = std::hypot(on.x, on.y);
  if (!(totals.weight > 0.0) || !(force > 0.0)) return {};
  const double x = totals.point_x / totals.weight;
  const double y = totals.point_y / totals.weight;
  const PlanarBody& p = state_.bodies[0].motion;
  const PlanarBody& q = state_.bodies[1].motion;
  const double vx = p.vx - p.spin * (y - p.y) - (q.vx - q.spin * (y - q.y));
  const double vy = p.vy + p.spin * (x - p.x) - (q.vy + q.spin * (x - q.x));
  return {-(vx * on.x + vy * on.y) / force, std::hypot(vx, vy)};
}

/// Greatest compression: what is left of the closing speed is taken out along the impulse until
/// then, and the restitution's share of that impulse is given back, once; less where the contact
/// slides, where it has all but ended, and where it would give back more energy than e².
void ContactRun::rebound(const Totals& totals, double passing_mps) {
  const double sticks =
      std::clamp(1.0 - passing_mps / (slipping_share * most_passing_mps_), 0.0, 1.0);
  const double e =
      std::min(most_restitution, restitution_at(most_closing_mps_) * variant_.restitution *
                                     (totals.fresh / totals.pressing) *
                                     std::min(1.0, totals.pressing / most_pressing_) * sticks);
  for (std::size_t k = 0; k < state_.bodies.size(); ++k) {
    const PlanarBody& body = state_.bodies[k].motion;
    PlanarForce& i = state_.impulses[k];
    i.moment -= body.x * i.y - body.y * i.x;
  }
  auto [slope, bend] = energy_along(state_.impulses);
  if (!(bend > 0.0)) return;
  constexpr double most_left = 0.3;
  const double rest = sticks * std::clamp(-slope / bend, 0.0, most_left);
  const double lost = lost_j_ - (slope * rest + 0.5 * bend * rest * rest);
  slope += bend * rest;
  // The largest share k with slope·k + bend·k²/2 <= e²·lost.
  const double most_j = e * e * std::max(lost, 0.0);
  double share = e;
  if (slope * share + 0.5 * bend * share * share > most_j) {
    share = (-slope + std::sqrt(slope * slope + 2.0 * bend * most_j)) / bend;
  }
  share = rest + std::clamp(share, 0.0, e) * (1.0 + rest);
  const double before = moving_j();
  for (std::size_t k = 0; k < state_.bodies.size(); ++k) {
    const PlanarForce& i = state_.impulses[k];
    state_.bodies[k].motion.push(share * i.x, share * i.y, share * i.moment);
  }
  const double gained = moving_j() - before;
  if (gained > 0.0) restored_j_ += gained;
  restitution_ = std::max(restitution_, e);
  std::fill(state_.impulses.begin(), state_.impulses.end(), PlanarForce{});
  lost_j_ = 0.0;
  most_pressing_ = 0.0;
  most_closing_mps_ = 0.0;
  most_passing_mps_ = 0.0;
}

void ContactRun::move(double seconds) {
  for (PressedBody& body : state_.bodies) body.motion.move(seconds);
}

void ContactRun::step() {
  // Ends: bodies that have travelled this far without force have parted; a force that gave less
  // than this share of the impulse in such a time and travel has all but ended, once a share of
  // the momentum at stake is taken (a faint clip may come before the crash); bodies that never
  // pressed within this travel brushed past each other.
  constexpr double parted_m = 0.15;
  constexpr double faded_s = 0.03;
  constexpr double faded_m = 0.1;
  constexpr double faded_share = 0.03;
  constexpr double taken_share = 0.3;
  constexpr double missed_m = 0.5;
  constexpr double least_speed_mps = 0.5;
  const double last_s = step_s_;
  step_s_ = std::clamp(options_.travel_m / std::max(speed_mps_, 1e-3), options_.shortest_s,
                       options_.longest_s);
  if (acceleration_mps2_ > 0.0) {
    step_s_ = std::max(0.25 * options_.shortest_s,
                       std::min(step_s_, options_.speed_change * speed_mps_ / acceleration_mps2_));
  }
  since_s_ = 0.5 * (last_s + step_s_);
  move(0.5 * step_s_);
  const Totals totals = feel();
  // Material of the two near each other, which may lie as far from one centre of mass as from the
  // other: no faster than this.
  const PlanarBody& p = state_.bodies[0].motion;
  const PlanarBody& q = state_.bodies[1].motion;
  moved_m_ = step_s_ * (relative_speed() + 2.0 * rim_m_ * (std::abs(p.spin) + std::abs(q.spin)));
  acceleration_mps2_ = 0.0;
  if (totals.approaching) quiet_m_ = 0.0;
  quiet_m_ += step_s_ * std::max(speed_mps_, least_speed_mps);
  late_m_ += step_s_ * std::max(speed_mps_, least_speed_mps);
  if (totals.pressing > 0.0) {
    acts_ = true;
    const double closing = totals.closing / totals.pressing;
    const double passing = totals.passing / totals.pressing;
    most_pressing_ = std::max(most_pressing_, totals.pressing);
    most_closing_mps_ = std::max(most_closing_mps_, closing);
    most_passing_mps_ = std::max(most_passing_mps_, passing);
    fastest_passing_mps_ = std::max(fastest_passing_mps_, passing);
    closing_mps_ = std::max(closing_mps_, closing);
    point_x_ += step_s_ * totals.point_x;
    point_y_ += step_s_ * totals.point_y;
    point_weight_ += step_s_ * totals.weight;
    push();
    const AtForce now = at_force(totals);
    last_passing_mps_ = now.passing_mps;
    if (now.closing_mps < at_rest * most_closing_mps_ && lost_j_ > 0.0) {
      rebound(totals, now.passing_mps);
    }
  }
  speed_mps_ = speed_at_rims();
  move(0.5 * step_s_);
  time_s_ += step_s_;
  ++steps_;
  if (totals.pressing > 0.0) {
    duration_s_ = time_s_;
    end_first_ = state_.bodies[0].motion;
    end_second_ = state_.bodies[1].motion;
    record_.add(time_s_, end_first_, end_second_);
  }
  over_ = quiet_m_ > (acts_ ? parted_m : missed_m) || time_s_ > longest_contact_s;
  if (acts_ && time_s_ - late_from_s_ > faded_s && late_m_ > faded_m) {
    over_ = over_ || (late_ns_ < faded_share * impulse_ns_ &&
                      impulse_ns_ > taken_share * momentum_before_ns_);
    late_ns_ = 0.0;
    late_from_s_ = time_s_;
    late_m_ = 0.0;
  }
}

bool ContactRun::advance(int steps) {
  for (int i = 0; i < steps && !over_; ++i) step();
  return !over_;
}

}  // namespace crashrank::detail

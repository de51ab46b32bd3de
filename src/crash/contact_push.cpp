#include "crash/contact_run.hpp"
#include "crash/rebound.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {

namespace {

/// A contact that still moves past at a quarter of its speed or more does not rebound.
constexpr double slipping_share = 0.25;

}  // namespace

void ContactRun::EnergyChange::add(const PlanarBody& body, const PlanarForce& f) {
  slope += f.x * body.vx + f.y * body.vy + f.moment * body.spin;
  bend += (f.x * f.x + f.y * f.y) * body.inverse_mass + f.moment * f.moment * body.inverse_inertia;
}

namespace {

void push_by(PlanarBody& body, const PlanarForce& f, double share, PlanarForce& sum) {
  body.push(share * f.x, share * f.y, share * f.moment);
  sum.x += share * f.x;
  sum.y += share * f.y;
  sum.moment += share * f.moment;
}

/// A moment about a body's centre of mass becomes that about the origin, or back with -1.
double about_origin(const PlanarBody& body, const PlanarForce& f, double sign) {
  return f.moment + sign * (body.x * f.y - body.y * f.x);
}

}  // namespace

/// Applies the forces for the step, but no longer than until the energy is least along them: how it
/// changes along a share k of them is slope·k + bend·k²/2. So none is ever gained, however stiff
/// what was met is.
void ContactRun::push() {
  EnergyChange change;
  change.add(motion_of(first_), on_first_);
  for (const std::uint32_t k : pairs()) {
    change.add(motion_of(state_->pairs[k].second), state_->pairs[k].on_second);
  }
  const PlanarBody& p = motion_of(first_);
  const PlanarBody& q = motion_of(second());
  const double force = plane_length(on_first_.x, on_first_.y);
  acceleration_mps2_ =
      force * (p.inverse_mass + q.inverse_mass) +
      rim_m_ * (std::abs(on_first_.moment) * p.inverse_inertia +
                std::abs(state_->pairs[pairs_[0]].on_second.moment) * q.inverse_inertia);
  double seconds = 0.0;
  if (change.slope < 0.0 && change.bend > 0.0) {
    seconds = std::min(step_s_, -change.slope / change.bend);
  }
  pushed_s_ = seconds;
  const double before = moving_j();
  const auto push_one = [&](PlanarBody& body, const PlanarForce& f, PlanarForce& whole,
                            PlanarForce& since) {
    push_by(body, f, seconds, whole);
    since.x += seconds * f.x;
    since.y += seconds * f.y;
    since.moment += seconds * about_origin(body, f, 1.0);
  };
  push_one(motion_of(first_), on_first_, impulse_on_first_, since_rebound_);
  for (const std::uint32_t k : pairs()) {
    BodyPair& pair = state_->pairs[k];
    push_one(motion_of(pair.second), pair.on_second, pair.impulse_on_second, pair.since_rebound);
  }
  const double lost = before - moving_j();
  lost_j_ += lost;
  dissipated_j_ += lost;
  const double impulse = seconds * force;
  impulse_ns_ += impulse;
  late_ns_ += impulse;
  // So small a share of the whole counts as no force.
  constexpr double nothing = 3e-4;
  if (impulse > nothing * impulse_ns_) quiet_m_ = 0.0;
}

ContactRun::AtForce ContactRun::at_force() const {
  const double force = plane_length(on_first_.x, on_first_.y);
  if (!(totals_.weight > 0.0) || !(force > 0.0)) return {};
  const double x = totals_.point_x / totals_.weight;
  const double y = totals_.point_y / totals_.weight;
  const PlanarBody& p = motion_of(first_);
  const PlanarBody& q = motion_of(second());
  const double vx = p.vx - p.spin * (y - p.y) - (q.vx - q.spin * (y - q.y));
  const double vy = p.vy + p.spin * (x - p.x) - (q.vy + q.spin * (x - q.x));
  return {-(vx * on_first_.x + vy * on_first_.y) / force, plane_length(vx, vy)};
}

/// Greatest compression: what is left of the closing speed is taken out along the impulse until
/// then, and the restitution's share of that impulse is given back, once; less where the contact
/// slides, where it has all but ended, and where it would give back more energy than e².
void ContactRun::rebound(double passing_mps) {
  const double sticks =
      std::clamp(1.0 - passing_mps / (slipping_share * most_passing_mps_), 0.0, 1.0);
  const double e =
      std::min(most_restitution, restitution_at(most_closing_mps_) * variant_.restitution *
                                     (totals_.fresh / totals_.pressing) *
                                     std::min(1.0, totals_.pressing / most_pressing_) * sticks);
  EnergyChange change;
  const auto prepare = [&](const PlanarBody& body, PlanarForce& since) {
    since.moment = about_origin(body, since, -1.0);
    change.add(body, since);
  };
  prepare(motion_of(first_), since_rebound_);
  for (const std::uint32_t k : pairs()) {
    prepare(motion_of(state_->pairs[k].second), state_->pairs[k].since_rebound);
  }
  auto [slope, bend] = change;
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
  push_by(motion_of(first_), since_rebound_, share, impulse_on_first_);
  since_rebound_ = {};
  for (const std::uint32_t k : pairs()) {
    BodyPair& pair = state_->pairs[k];
    push_by(motion_of(pair.second), pair.since_rebound, share, pair.impulse_on_second);
    pair.since_rebound = {};
  }
  dissipated_j_ += before - moving_j();
  restitution_ = std::max(restitution_, e);
  lost_j_ = 0.0;
  most_pressing_ = 0.0;
  most_closing_mps_ = 0.0;
  most_passing_mps_ = 0.0;
}

}  // namespace crashrank::detail

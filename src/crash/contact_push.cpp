#include "crash/contact_run.hpp"
#include "crash/rebound.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {

namespace {

/// A contact does not rebound while its relative speed is above this share of its maximum: it
/// slides.
constexpr double sliding_limit = 0.25;

}  // namespace

void ContactRun::EnergyChange::add(const PlanarBody& body, const PlanarForce& f) {
  slope += f.x * body.vx + f.y * body.vy + f.moment * body.spin;
  curvature +=
      (f.x * f.x + f.y * f.y) * body.inverse_mass + f.moment * f.moment * body.inverse_inertia;
}

namespace {

void add_share(const PlanarForce& f, double share, PlanarForce& sum) {
  sum.x += share * f.x;
  sum.y += share * f.y;
  sum.moment += share * f.moment;
}

void apply_impulse(PlanarBody& body, const PlanarForce& f, double share, PlanarForce& sum) {
  body.apply_impulse(share * f.x, share * f.y, share * f.moment);
  add_share(f, share, sum);
}

/// Converts a moment about the body's centre of mass to one about the origin (sign 1), or back
/// (sign -1).
double about_origin(const PlanarBody& body, const PlanarForce& f, double sign) {
  return f.moment + sign * (body.x * f.y - body.y * f.x);
}

}  // namespace

/// Applies the forces for the duration of the step, or for the shorter time that minimises the
/// kinetic energy: applied for a time k, they change it by slope·k + curvature·k²/2. Energy
/// therefore never grows, however stiff the bodies are.
void ContactRun::apply_impulses() {
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
      radius_m_ * (std::abs(on_first_.moment) * p.inverse_inertia +
                   std::abs(state_->pairs[pairs_[0]].on_second.moment) * q.inverse_inertia);
  double seconds = 0.0;
  if (change.slope < 0.0 && change.curvature > 0.0) {
    seconds = std::min(step_s_, -change.slope / change.curvature);
  }
  applied_s_ = seconds;
  const double before = kinetic_energy_j();
  const auto apply_one = [&](PlanarBody& body, const PlanarForce& f, PlanarForce& total,
                             PlanarForce& since) {
    apply_impulse(body, f, seconds, total);
    since.x += seconds * f.x;
    since.y += seconds * f.y;
    since.moment += seconds * about_origin(body, f, 1.0);
  };
  apply_one(motion_of(first_), on_first_, impulse_on_first_, since_rebound_);
  for (const std::uint32_t k : pairs()) {
    BodyPair& pair = state_->pairs[k];
    apply_one(motion_of(pair.second), pair.on_second, pair.impulse_on_second, pair.since_rebound);
  }
  add_share(on_first_, seconds, step_first_.whole);
  add_share(state_->pairs[pairs_[0]].on_second, seconds, step_second_.whole);
  const double lost = before - kinetic_energy_j();
  lost_since_rebound_j_ += lost - seconds * totals_.deflection_w;
  dissipated_j_ += lost;
  const double impulse = seconds * force;
  impulse_ns_ += impulse;
  window_impulse_ns_ += impulse;
  // An impulse below this share of the total counts as no force.
  constexpr double negligible_share = 3e-4;
  if (impulse > negligible_share * impulse_ns_) forceless_travel_m_ = 0.0;
}

ContactRun::ForceVelocity ContactRun::velocity_at_force() const {
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

/// Applies the rebound at greatest compression. First the remaining closing speed is removed along
/// the impulse so far; then the share e of that impulse, the restitution, is added once. The share
/// is reduced where the contact slides, where its force has nearly ended, and where it would
/// restore more than e² of the energy lost.
void ContactRun::rebound(double speed_mps) {
  const double sticking =
      std::clamp(1.0 - speed_mps / (sliding_limit * max_speed_since_rebound_mps_), 0.0, 1.0);
  const double e =
      std::min(most_restitution,
               restitution_at(max_closing_since_rebound_mps_) * variant_.restitution *
                   (totals_.unused_crush / totals_.pressing) *
                   std::min(1.0, totals_.pressing / max_pressing_since_rebound_) * sticking);
  EnergyChange change;
  const auto prepare = [&](const PlanarBody& body, PlanarForce& since) {
    since.moment = about_origin(body, since, -1.0);
    change.add(body, since);
  };
  prepare(motion_of(first_), since_rebound_);
  for (const std::uint32_t k : pairs()) {
    prepare(motion_of(state_->pairs[k].second), state_->pairs[k].since_rebound);
  }
  auto [slope, curvature] = change;
  if (!(curvature > 0.0)) return;
  constexpr double max_remaining = 0.3;
  const double remaining = sticking * std::clamp(-slope / curvature, 0.0, max_remaining);
  const double lost =
      lost_since_rebound_j_ - (slope * remaining + 0.5 * curvature * remaining * remaining);
  slope += curvature * remaining;
  // The largest share k for which slope·k + curvature·k²/2 <= e²·lost.
  const double max_restored_j = e * e * std::max(lost, 0.0);
  double share = e;
  if (slope * share + 0.5 * curvature * share * share > max_restored_j) {
    share = (-slope + std::sqrt(slope * slope + 2.0 * curvature * max_restored_j)) / curvature;
  }
  const double restored = std::clamp(share, 0.0, e) * (1.0 + remaining);
  share = remaining + restored;
  const double before = kinetic_energy_j();
  const auto add_to_step = [&](const PlanarForce& since, StepImpulse& step) {
    add_share(since, share, step.whole);
    add_share(since, restored, step.rebound);
  };
  add_to_step(since_rebound_, step_first_);
  add_to_step(state_->pairs[pairs_[0]].since_rebound, step_second_);
  apply_impulse(motion_of(first_), since_rebound_, share, impulse_on_first_);
  since_rebound_ = {};
  for (const std::uint32_t k : pairs()) {
    BodyPair& pair = state_->pairs[k];
    apply_impulse(motion_of(pair.second), pair.since_rebound, share, pair.impulse_on_second);
    pair.since_rebound = {};
  }
  dissipated_j_ += before - kinetic_energy_j();
  restitution_ = std::max(restitution_, e);
  begin_compression();
}

}  // namespace crashrank::detail

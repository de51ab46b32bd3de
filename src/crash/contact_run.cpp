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

bool can_press(const Vehicle& a, const Vehicle& b) {
  return (a.movable() || b.movable()) && (!a.strength.rigid || !b.strength.rigid);
}

void BodyPair::begin(std::size_t a, std::size_t b) {
  first = static_cast<std::uint32_t>(a);
  second = static_cast<std::uint32_t>(b);
  of_first.begin();
  of_second.begin();
  faded_until_s = -1e9;
  in_first = {};
  in_second = {};
  reached_first_m = reached_second_m = 0.0;
  meet_again(left_at_step = 0);
}

double BodyPair::reach_m(bool of_first_body) const {
  const PassRecord& own = of_first_body ? in_first : in_second;
  const PassRecord& other = of_first_body ? in_second : in_first;
  return static_cast<double>(std::max(own.intrusion_own, other.intrusion_other));
}

void BodyPair::meet_again(std::uint64_t step) {
  if (step > left_at_step + 1) {
    of_first.resume();
    of_second.resume();
  }
  reached_first_m = std::max(reached_first_m, reach_m(true));
  reached_second_m = std::max(reached_second_m, reach_m(false));
  in_first = {};
  in_second = {};
  on_second = {};
  since_rebound = {};
  impulse_on_second = {};
  pressed = false;
}

void ContactRun::begin(ContactWorkspace::State& state, std::size_t first, std::uint32_t pair,
                       const ContactBody& given_first, const ContactBody& given_second,
                       const Vector3d& origin_m, const ContactVariant& variant,
                       const ContactOptions& options) {
  *this = {};
  state_ = &state;
  options_ = options;
  variant_ = variant;
  given_first_ = given_first;
  given_second_ = given_second;
  origin_m_ = origin_m;
  first_ = first;
  add(pair);
  const PlanarBody& p = motion_of(first_);
  const PlanarBody& q = motion_of(second());
  start_first_ = end_first_ = p;
  start_second_ = end_second_ = q;
  record_.begin(p, q);
  rim_m_ = rim_of(*given_first.vehicle);
  if (given_second.vehicle->movable()) rim_m_ = std::max(rim_m_, rim_of(*given_second.vehicle));
  energy_before_j_ = moving_j();
  speed_before_mps_ = relative_speed();
  momentum_before_ns_ = speed_before_mps_ / (p.inverse_mass + q.inverse_mass);
  speeds_before_mps_ = plane_length(p.vx, p.vy) + plane_length(q.vx, q.vy);
  speed_mps_ = speed_at_rims();
  over_ = !can_press(*given_first.vehicle, *given_second.vehicle);
}

bool ContactRun::add(std::uint32_t pair) {
  if (pair_count_ == most_others) return false;
  others_[pair_count_] = &state_->bodies[state_->pairs[pair].second];
  pairs_[pair_count_++] = pair;
  return true;
}

void ContactRun::begin_here(const ContactBody& given_first, const ContactBody& given_second) {
  given_first_ = given_first;
  given_second_ = given_second;
  start_first_ = end_first_ = motion_of(first_);
  start_second_ = end_second_ = motion_of(second());
  record_.begin(start_first_, start_second_);
  of_first_ = of_second_ = {};
  time_s_ = -0.5 * step_s_;
}

double ContactRun::relative_speed() const {
  const PlanarBody& p = motion_of(first_);
  const PlanarBody& q = motion_of(second());
  return plane_length(p.vx - q.vx, p.vy - q.vy);
}

double ContactRun::speed_at_rims() const {
  return relative_speed() + rim_m_ * std::abs(motion_of(first_).spin - motion_of(second()).spin);
}

/// Bodies that nothing moves have none, and so the others of several.
double ContactRun::moving_j() const {
  return motion_of(first_).energy() + motion_of(second()).energy();
}

void ContactRun::add_sums(const PassSums& sums, bool own_is_first) {
  Totals& totals = totals_;
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
}

void ContactRun::feel_pair(BodyPair& pair, std::size_t place, PassSettings& settings) {
  PressedBody& first = state_->bodies[first_];
  PressedBody& other = state_->bodies[pair.second];
  const double base = friction_between(first.vehicle->surface, other.vehicle->surface);
  settings.friction = static_cast<float>(base * variant_.friction);
  const bool metals = first.vehicle->surface == Surface::sheet_metal &&
                      other.vehicle->surface == Surface::sheet_metal;
  settings.interlocked = metals ? interlocked_friction : 0.0F;
  PlanarForce on_first;
  double pressing = 0.0;
  if (!first.response.rigid) {
    settings.neighbours = {others_.data(), pair_count_ > 1 ? pair_count_ : 0};
    settings.self = place;
    PassSums sums;
    press_pieces(other, first, settings, moved_m_, pair.of_second, sums, pair.in_first);
    pieces_ += pair.of_second.pieces;
    add_sums(sums, true);
    on_first = sums.on_pressed;
    pressing += sums.pressing;
  }
  if (!other.response.rigid) {
    settings.neighbours = {};
    PassSums sums;
    press_pieces(first, other, settings, moved_m_, pair.of_first, sums, pair.in_second);
    pieces_ += pair.of_first.pieces;
    add_sums(sums, false);
    on_first.x -= sums.on_pressed.x;
    on_first.y -= sums.on_pressed.y;
    on_first.moment -= sums.on_pressed.moment;
    pressing += sums.pressing;
  }
  if (pressing > 0.0) pair.pressed = true;
  // Moments about the origin become those about the centres of mass.
  const PlanarBody& p = first.motion;
  const PlanarBody& q = other.motion;
  on_first_.x += on_first.x;
  on_first_.y += on_first.y;
  on_first_.moment += on_first.moment - (p.x * on_first.y - p.y * on_first.x);
  pair.on_second = {-on_first.x, -on_first.y,
                    -(on_first.moment - (q.x * on_first.y - q.y * on_first.x))};
}

std::size_t ContactRun::most_pressed() const {
  std::size_t most = second();
  double greatest = 0.0;
  for (const std::uint32_t k : pairs()) {
    const PlanarForce& impulse = state_->pairs[k].impulse_on_second;
    const double size = plane_length(impulse.x, impulse.y);
    if (size > greatest) most = state_->pairs[k].second;
    greatest = std::max(greatest, size);
  }
  return most;
}

double ContactRun::next_step_s() const {
  // However hard bodies press that are no faster than this against each other, a step takes this
  // share of the usual travel: what rests or is pushed along needs no more.
  constexpr double slow_mps = 1.0;
  constexpr double least_travel = 1.0 / 60.0;
  double step_s = std::clamp(options_.travel_m / std::max(speed_mps_, 1e-3), options_.shortest_s,
                             options_.longest_s);
  if (acceleration_mps2_ > 0.0) {
    double least_s = 0.25 * options_.shortest_s;
    if (std::max(speed_mps_, most_passing_mps_) < slow_mps) {
      least_s = std::clamp(least_travel * options_.travel_m / std::max(speed_mps_, 1e-3), least_s,
                           step_s);
    }
    step_s = std::max(least_s,
                      std::min(step_s, options_.speed_change * speed_mps_ / acceleration_mps2_));
  }
  return step_s;
}

void ContactRun::feel(double step_s) {
  since_s_ = 0.5 * (step_s_ + step_s);
  step_s_ = step_s;
  totals_ = {};
  on_first_ = {};
  PassSettings settings;
  settings.step_s = step_s_;
  settings.since_s = since_s_;
  for (std::size_t k = 0; k < pair_count_; ++k) {
    feel_pair(state_->pairs[pairs_[k]], k, settings);
  }
}

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

void ContactRun::press() {
  constexpr double least_speed_mps = 0.5;
  // Material of the two near each other, which may lie as far from one centre of mass as from the
  // other: no faster than this.
  const PlanarBody& p = motion_of(first_);
  const PlanarBody& q = motion_of(second());
  moved_m_ = step_s_ * (relative_speed() + 2.0 * rim_m_ * (std::abs(p.spin) + std::abs(q.spin)));
  acceleration_mps2_ = 0.0;
  if (totals_.approaching) quiet_m_ = 0.0;
  quiet_m_ += step_s_ * std::max(speed_mps_, least_speed_mps);
  late_m_ += step_s_ * std::max(speed_mps_, least_speed_mps);
  if (presses()) {
    acts_ = true;
    const double closing = totals_.closing / totals_.pressing;
    const double passing = totals_.passing / totals_.pressing;
    most_pressing_ = std::max(most_pressing_, totals_.pressing);
    most_closing_mps_ = std::max(most_closing_mps_, closing);
    most_passing_mps_ = std::max(most_passing_mps_, passing);
    fastest_passing_mps_ = std::max(fastest_passing_mps_, passing);
    closing_mps_ = std::max(closing_mps_, closing);
    point_x_ += step_s_ * totals_.point_x;
    point_y_ += step_s_ * totals_.point_y;
    point_weight_ += step_s_ * totals_.weight;
    push();
    const AtForce now = at_force();
    last_passing_mps_ = now.passing_mps;
    if (now.closing_mps < at_rest * most_closing_mps_ && lost_j_ > 0.0) rebound(now.passing_mps);
  }
  speed_mps_ = speed_at_rims();
}

Eigen::Vector2d ContactRun::step_change_mps(bool of_first) const {
  if (!presses()) return Eigen::Vector2d(0, 0);
  const PlanarForce& f = of_first ? on_first_ : state_->pairs[pairs_[0]].on_second;
  const double share = pushed_s_ * motion_of(of_first ? first_ : second()).inverse_mass;
  return Eigen::Vector2d(share * f.x, share * f.y);
}

void ContactRun::take_back(bool from_first, double share) {
  const PlanarForce& f = from_first ? on_first_ : state_->pairs[pairs_[0]].on_second;
  PlanarForce& taken = from_first ? taken_first_ : taken_second_;
  taken.x += share * pushed_s_ * f.x;
  taken.y += share * pushed_s_ * f.y;
  taken.moment += share * pushed_s_ * f.moment;
}

void ContactRun::undergo(bool first, const Eigen::Vector2d& change_mps, bool shared) {
  Undergone& body = first ? of_first_ : of_second_;
  body.now_mps += change_mps;
  body.shared = body.shared || shared;
  if (presses()) body.most_mps = std::max(body.most_mps, body.now_mps.norm());
}

void ContactRun::end_step() {
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
  time_s_ += step_s_;
  ++steps_;
  if (presses()) {
    duration_s_ = time_s_;
    end_first_ = motion_of(first_);
    end_second_ = motion_of(second());
    record_.add(time_s_, end_first_, end_second_);
  }
  over_ = quiet_m_ > (acts_ ? parted_m : missed_m) || time_s_ > longest_contact_s;
  if (acts_ && time_s_ - late_from_s_ > faded_s && late_m_ > faded_m) {
    faded_ =
        late_ns_ < faded_share * impulse_ns_ && impulse_ns_ > taken_share * momentum_before_ns_;
    over_ = over_ || faded_;
    late_ns_ = 0.0;
    late_from_s_ = time_s_;
    late_m_ = 0.0;
  }
}

}  // namespace crashrank::detail

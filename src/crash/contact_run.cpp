#include "crash/contact_run.hpp"

#include "crash/pair_order.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;

/// Friction of folded sheet metal in folded sheet metal: rails and folds hook into each other.
constexpr float interlocked_friction = 1.0F;
/// Share of the closing speed under which bodies count as at rest against each other.
constexpr double at_rest = 0.03;

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

/// Injury risk is known for impacts of some 0.1 s. A long push or scrape that accelerates both
/// bodies no more than brakes do every day is no impact, however much velocity it adds up to. Both
/// bodies count the same share, so that impulses stay equal. Slow impacts, whose forces are as
/// small, are over by `impact_s`.
void ContactRun::weigh_step() {
  constexpr double impact_s = 0.3;
  constexpr double everyday_mps2 = 0.3 * gravity_mps2;
  constexpr double strong_mps2 = 1.0 * gravity_mps2;
  counted_ = 1.0;
  const double change_mps = std::max(step_change_mps(true).norm(), step_change_mps(false).norm());
  const double acceleration = change_mps / step_s_;
  if (acceleration >= strong_mps2) strong_s_ = time_s_;
  if (time_s_ - strong_s_ <= impact_s) return;
  counted_ = std::clamp((acceleration - everyday_mps2) / (strong_mps2 - everyday_mps2), 0.0, 1.0);
  add_taken(true, 1.0 - counted_);
  add_taken(false, 1.0 - counted_);
}

void ContactRun::take_back(bool from_first, double share) {
  add_taken(from_first, share * counted_);
}

void ContactRun::add_taken(bool from_first, double share) {
  const PlanarForce& f = from_first ? on_first_ : state_->pairs[pairs_[0]].on_second;
  PlanarForce& taken = from_first ? taken_first_ : taken_second_;
  taken.x += share * pushed_s_ * f.x;
  taken.y += share * pushed_s_ * f.y;
  taken.moment += share * pushed_s_ * f.moment;
}

void ContactRun::undergo(bool first, const Eigen::Vector2d& change_mps, bool shared) {
  Undergone& body = first ? of_first_ : of_second_;
  body.now_mps += change_mps;
  body.partial = body.partial || shared || counted_ < 1.0;
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

#include "crash/contact_run.hpp"

#include "crash/pair_order.hpp"
#include "crash/struck_part.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;

/// Friction coefficient between folded sheet metal of two bodies, whose rails and folds interlock.
constexpr float interlocked_friction = 1.0F;
/// The bodies are at greatest compression when the closing speed has fallen to this share of its
/// maximum.
constexpr double rest_share = 0.03;

/// Greatest distance of an outline point from the centre of mass, m.
double outline_radius(const Vehicle& v) {
  const Silhouettes& s = v.silhouettes;
  const double x = std::max(std::abs(static_cast<double>(s.min_x) - v.center_m.x()),
                            std::abs(static_cast<double>(s.max_x) - v.center_m.x()));
  const double y = std::max(std::abs(static_cast<double>(s.min_y) - v.center_m.y()),
                            std::abs(static_cast<double>(s.max_y) - v.center_m.y()));
  return std::hypot(x, y);
}

}  // namespace

bool can_press(const Vehicle& a, const Vehicle& b) {
  return a.has_outline() && b.has_outline() && (a.movable() || b.movable()) &&
         (!a.strength.rigid || !b.strength.rigid);
}

void BodyPair::begin(std::size_t a, std::size_t b, PiecePool& pool) {
  first = static_cast<std::uint32_t>(a);
  second = static_cast<std::uint32_t>(b);
  of_first.begin(pool);
  of_second.begin(pool);
  in_first = {};
  in_second = {};
  earlier_first_m = earlier_second_m = 0.0;
  deflected_x_m = deflected_y_m = 0.0;
  struck = false;
  begin_further_contact(last_end_step = 0);
}

double BodyPair::intrusion_m(bool of_first_body) const {
  const PassRecord& own = of_first_body ? in_first : in_second;
  const PassRecord& other = of_first_body ? in_second : in_first;
  return static_cast<double>(std::max(own.intrusion_own, other.intrusion_other));
}

double BodyPair::height_m() const {
  Box place = in_first.own;
  place.grow(in_second.own);
  return place.empty() ? 0.0 : static_cast<double>(place.center().z());
}

void BodyPair::move_rail(const Deflection& rail, double seconds) {
  deflected_x_m += seconds * deflects_x_mps;
  deflected_y_m += seconds * deflects_y_mps;
  const double distance_m = plane_length(deflected_x_m, deflected_y_m);
  if (!(distance_m > rail.distance_m)) return;
  deflected_x_m *= rail.distance_m / distance_m;
  deflected_y_m *= rail.distance_m / distance_m;
  deflects_x_mps = deflects_y_mps = 0.0;
}

void BodyPair::slow_rail(double by_mps) {
  const double speed_mps = plane_length(deflects_x_mps, deflects_y_mps);
  if (!(speed_mps > 0.0)) return;
  const double share = speed_mps > by_mps ? 1.0 - std::max(by_mps, 0.0) / speed_mps : 0.0;
  deflects_x_mps *= share;
  deflects_y_mps *= share;
}

void BodyPair::begin_further_contact(std::uint64_t step) {
  if (step > last_end_step + 1) {
    of_first.begin_further_contact();
    of_second.begin_further_contact();
  }
  earlier_first_m = std::max(earlier_first_m, intrusion_m(true));
  earlier_second_m = std::max(earlier_second_m, intrusion_m(false));
  in_first = {};
  in_second = {};
  on_second = {};
  since_rebound = {};
  impulse_on_second = {};
  deflects_x_mps = deflects_y_mps = 0.0;
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
  start_first_ = end_first_ = motion_of(first_);
  start_second_ = end_second_ = motion_of(second());
  record_.begin(start_first_, start_second_);
  measure();
  over_ = !can_press(*given_first.vehicle, *given_second.vehicle);
}

/// Sets what depends on which of the bodies can move.
void ContactRun::measure() {
  const auto inverse_mass = [this](std::size_t body) {
    const bool moves = motion_of(body).inverse_mass > 0.0;
    return moves ? 1.0 / state_->bodies[body].vehicle->mass_kg : 0.0;
  };
  radius_m_ = outline_radius(*given_first_.vehicle);
  if (inverse_mass(second()) > 0.0)
    radius_m_ = std::max(radius_m_, outline_radius(*given_second_.vehicle));
  momentum_before_ns_ = relative_speed() / (inverse_mass(first_) + inverse_mass(second()));
  speed_mps_ = relative_speed_bound();
}

void ContactRun::add_load(std::size_t body, FootLoad& load) const {
  for (const std::uint32_t k : pairs()) {
    const BodyPair& pair = state_->pairs[k];
    if (pair.second != body && pair.first != body) continue;
    const double sign = pair.second == body ? 1.0 : -1.0;
    const double height_m = pair.height_m();
    load.x_n += sign * pair.on_second.x;
    load.y_n += sign * pair.on_second.y;
    load.x_nm += sign * height_m * pair.on_second.x;
    load.y_nm += sign * height_m * pair.on_second.y;
  }
}

void ContactRun::forget_held(std::size_t body) {
  if (body != first_ && body != second()) return;
  BodyPair& pair = state_->pairs[pairs_[0]];
  (body == first_ ? impulse_on_first_ : pair.impulse_on_second) = {};
  since_rebound_ = {};
  pair.since_rebound = {};
  begin_compression();
  measure();
}

void ContactRun::begin_compression() {
  lost_since_rebound_j_ = 0.0;
  max_pressing_since_rebound_ = 0.0;
  max_closing_since_rebound_mps_ = 0.0;
  max_speed_since_rebound_mps_ = 0.0;
}

bool ContactRun::add(std::uint32_t pair) {
  if (pair_count_ == most_others) return false;
  others_[pair_count_] = &state_->bodies[state_->pairs[pair].second];
  pairs_[pair_count_++] = pair;
  return true;
}

void ContactRun::begin_at_first_force(const ContactBody& given_first,
                                      const ContactBody& given_second) {
  given_first_ = given_first;
  given_second_ = given_second;
  start_first_ = end_first_ = motion_of(first_);
  start_second_ = end_second_ = motion_of(second());
  record_.begin(start_first_, start_second_);
  time_s_ = -0.5 * step_s_;
}

double ContactRun::relative_speed() const {
  const PlanarBody& p = motion_of(first_);
  const PlanarBody& q = motion_of(second());
  return plane_length(p.vx - q.vx, p.vy - q.vy);
}

double ContactRun::relative_speed_bound() const {
  return relative_speed() + radius_m_ * std::abs(motion_of(first_).spin - motion_of(second()).spin);
}

/// Kinetic energy of the first two bodies. Further bodies of a contact are fixed and have none.
double ContactRun::kinetic_energy_j() const {
  return motion_of(first_).energy() + motion_of(second()).energy();
}

void ContactRun::add_sums(const PassSums& sums, bool own_is_first) {
  Totals& totals = totals_;
  totals.approaching = totals.approaching || sums.approaching;
  totals.pressing += sums.pressing;
  totals.closing += sums.closing;
  totals.speed += sums.speed;
  const double own_j = sums.power_own * step_s_;
  const double other_j = sums.power_other * step_s_;
  crush_first_j_ += own_is_first ? own_j : other_j;
  crush_second_j_ += own_is_first ? other_j : own_j;
  totals.crush_first_w += own_is_first ? sums.power_own : sums.power_other;
  totals.crush_second_w += own_is_first ? sums.power_other : sums.power_own;
  totals.intruded_first_m3 +=
      step_s_ * (own_is_first ? sums.intruding_own_m3ps : sums.intruding_other_m3ps);
  totals.intruded_second_m3 +=
      step_s_ * (own_is_first ? sums.intruding_other_m3ps : sums.intruding_own_m3ps);
  friction_j_ += sums.power_friction * step_s_;
  depth_first_m_ = std::max(depth_first_m_, own_is_first ? sums.depth_own : sums.depth_other);
  depth_second_m_ = std::max(depth_second_m_, own_is_first ? sums.depth_other : sums.depth_own);
  totals.unused_crush += sums.unused_crush;
  totals.weight += sums.weight;
  totals.point_x += sums.point_x;
  totals.point_y += sums.point_y;
}

void ContactRun::compute_pair_forces(BodyPair& pair, std::size_t place, PassSettings& settings) {
  PressedBody& first = state_->bodies[first_];
  const PressedBody* other = &state_->bodies[pair.second];
  const double base = friction_between(first.vehicle->surface, other->vehicle->surface);
  settings.friction = static_cast<float>(base * variant_.friction);
  const bool metals = first.vehicle->surface == Surface::sheet_metal &&
                      other->vehicle->surface == Surface::sheet_metal;
  settings.interlocked = metals ? interlocked_friction : 0.0F;
  double travel_m = travel_bound_m_;
  std::optional<PressedBody> moved;
  const std::optional<Deflection>& rail = other->vehicle->deflection;
  if (rail) {
    travel_m += pass_interval_s_ * plane_length(pair.deflects_x_mps, pair.deflects_y_mps);
    pair.move_rail(*rail, pass_interval_s_);
    moved = *other;
    moved->motion.x += pair.deflected_x_m;
    moved->motion.y += pair.deflected_y_m;
    moved->motion.vx = pair.deflects_x_mps;
    moved->motion.vy = pair.deflects_y_mps;
    other = &*moved;
  }
  PassSums into_first;
  PassSums into_other;
  if (!first.response.rigid) {
    settings.neighbours = {others_.data(), pair_count_ > 1 ? pair_count_ : 0};
    settings.self = place;
    compute_piece_forces(*other, first, settings, travel_m, pair.of_second, into_first,
                         pair.in_first);
    pieces_ += pair.of_second.pieces;
  }
  if (!other->response.rigid) {
    settings.neighbours = {};
    compute_piece_forces(first, *other, settings, travel_m, pair.of_first, into_other,
                         pair.in_second);
    pieces_ += pair.of_first.pieces;
  }
  if (rail) deflect(*rail, pair, into_first, into_other);
  if (!first.response.rigid) add_sums(into_first, true);
  if (!other->response.rigid) add_sums(into_other, false);
  PlanarForce on_first = into_first.on_pressed;
  on_first.x -= into_other.on_pressed.x;
  on_first.y -= into_other.on_pressed.y;
  on_first.moment -= into_other.on_pressed.moment;
  if (into_first.pressing + into_other.pressing > 0.0) pair.pressed = true;
  // Convert moments about the origin to moments about the centres of mass.
  const PlanarBody& p = first.motion;
  const PlanarBody& q = other->motion;
  on_first_.x += on_first.x;
  on_first_.y += on_first.y;
  on_first_.moment += on_first.moment - (p.x * on_first.y - p.y * on_first.x);
  pair.on_second = {-on_first.x, -on_first.y,
                    -(on_first.moment - (q.x * on_first.y - q.y * on_first.x))};
}

/// Limits the normal force to that at which the rail gives way: the rail and the material of both
/// bodies give way in series. The more the force exceeds the rail's, the more the rail takes over
/// of the speed at which the material is crushed; the less, the more the material takes back.
void ContactRun::deflect(const Deflection& rail, BodyPair& pair, PassSums& into_first,
                         PassSums& into_other) {
  const double normal_n = into_first.weight + into_other.weight;
  const double pressing_n = into_first.pressing + into_other.pressing;
  const double x = into_other.on_pressed.x - into_first.on_pressed.x;
  const double y = into_other.on_pressed.y - into_first.on_pressed.y;
  const double force_n = plane_length(x, y);
  const double before_mps = plane_length(pair.deflects_x_mps, pair.deflects_y_mps);
  const double deflected_m = plane_length(pair.deflected_x_m, pair.deflected_y_m);
  pair.deflects_x_mps = pair.deflects_y_mps = 0.0;
  if (!(force_n > 0.0) || !(normal_n > 0.0) || deflected_m >= rail.distance_m) return;
  const double closing_mps = (into_first.closing + into_other.closing) / pressing_n;
  const double speed_mps =
      std::max(0.0, before_mps + closing_mps * (1.0 - rail.force_n / normal_n));
  pair.deflects_x_mps = speed_mps * x / force_n;
  pair.deflects_y_mps = speed_mps * y / force_n;
  const double share = std::min(1.0, rail.force_n / normal_n);
  into_first.scale(share);
  into_other.scale(share);
  totals_.deflection_w += share * normal_n * before_mps;
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
  // At relative speeds below `slow_mps` a step covers at least this share of the usual travel,
  // however large the acceleration: bodies at rest or pushed along need no shorter steps.
  constexpr double slow_mps = 1.0;
  constexpr double least_travel = 1.0 / 60.0;
  double step_s = std::clamp(options_.travel_m / std::max(speed_mps_, 1e-3), options_.shortest_s,
                             options_.longest_s);
  if (acceleration_mps2_ > 0.0) {
    double least_s = 0.25 * options_.shortest_s;
    if (std::max(speed_mps_, max_speed_since_rebound_mps_) < slow_mps) {
      least_s = std::clamp(least_travel * options_.travel_m / std::max(speed_mps_, 1e-3), least_s,
                           step_s);
    }
    step_s = std::max(least_s,
                      std::min(step_s, options_.speed_change * speed_mps_ / acceleration_mps2_));
  }
  return step_s;
}

void ContactRun::compute_forces(double step_s) {
  pass_interval_s_ = 0.5 * (step_s_ + step_s);
  step_s_ = step_s;
  totals_ = {};
  on_first_ = {};
  step_first_ = step_second_ = {};
  struck_first_mps_ = struck_second_mps_ = 0.0;
  PassSettings settings;
  settings.step_s = step_s_;
  settings.pass_interval_s = pass_interval_s_;
  settings.overlapping = options_.overlapping;
  for (std::size_t k = 0; k < pair_count_; ++k) {
    compute_pair_forces(state_->pairs[pairs_[k]], k, settings);
  }
}

void ContactRun::apply_forces() {
  constexpr double least_speed_mps = 0.5;
  // Upper bound of the relative travel of any two points near each other. Such a point may be up to
  // the outline radius of one body away from either centre of mass, hence twice `radius_m_`.
  const PlanarBody& p = motion_of(first_);
  const PlanarBody& q = motion_of(second());
  travel_bound_m_ =
      step_s_ * (relative_speed() + 2.0 * radius_m_ * (std::abs(p.spin) + std::abs(q.spin)));
  acceleration_mps2_ = 0.0;
  if (totals_.approaching) forceless_travel_m_ = 0.0;
  forceless_travel_m_ += step_s_ * std::max(speed_mps_, least_speed_mps);
  window_travel_m_ += step_s_ * std::max(speed_mps_, least_speed_mps);
  if (presses()) {
    strike();
    acts_ = true;
    const double closing = totals_.closing / totals_.pressing;
    const double speed = totals_.speed / totals_.pressing;
    max_pressing_since_rebound_ = std::max(max_pressing_since_rebound_, totals_.pressing);
    max_closing_since_rebound_mps_ = std::max(max_closing_since_rebound_mps_, closing);
    max_speed_since_rebound_mps_ = std::max(max_speed_since_rebound_mps_, speed);
    max_speed_mps_ = std::max(max_speed_mps_, speed);
    max_closing_mps_ = std::max(max_closing_mps_, closing);
    if (point_weight_ == 0.0 && totals_.weight > 0.0) {
      begin_point_m_ = Eigen::Vector2d(totals_.point_x, totals_.point_y) / totals_.weight;
    }
    point_x_ += step_s_ * totals_.point_x;
    point_y_ += step_s_ * totals_.point_y;
    point_weight_ += step_s_ * totals_.weight;
    intruded_first_m3_ += totals_.intruded_first_m3;
    intruded_second_m3_ += totals_.intruded_second_m3;
    const ForceVelocity before = velocity_at_force();
    apply_impulses();
    deflection_j_ += applied_s_ * totals_.deflection_w;
    const ForceVelocity now = velocity_at_force();
    for (const std::uint32_t k : pairs()) {
      state_->pairs[k].slow_rail(before.closing_mps - now.closing_mps);
    }
    last_speed_mps_ = now.speed_mps;
    if (now.closing_mps < rest_share * max_closing_since_rebound_mps_ &&
        lost_since_rebound_j_ > 0.0) {
      rebound(now.speed_mps);
    }
  }
  speed_mps_ = relative_speed_bound();
}

/// Share by which the full hit of a car changes the velocity of the first or the second body more
/// than that of the other body does, over 1.
double ContactRun::light_share(bool of_first) const {
  const PlanarBody& body = motion_of(of_first ? first_ : second());
  const PlanarBody& other = motion_of(of_first ? second() : first_);
  return std::min(other.inverse_mass, 1.0 / striking_car_kg) / body.inverse_mass;
}

/// See `ContactAction::struck_mps`.
double ContactRun::struck_mps(bool of_first) const {
  const PressedBody& body = state_->bodies[of_first ? first_ : second()];
  if (body.vehicle->kind != BodyKind::pedestrian) return 0.0;
  const PressedBody* const first = &state_->bodies[first_];
  const View<const PressedBody* const> strikers =
      of_first ? View<const PressedBody* const>{others_.data(), pair_count_}
               : View<const PressedBody* const>{&first, 1};
  return struck_part_mps(body, strikers) * (1.0 + light_share(of_first));
}

/// The part of a person that lies in the way is struck by the first force between the bodies; what
/// is pushed or scraped later is not struck anew.
void ContactRun::strike() {
  bool struck = false;
  for (const std::uint32_t k : pairs()) {
    struck = struck || state_->pairs[k].struck;
    state_->pairs[k].struck = true;
  }
  if (struck) return;
  struck_first_mps_ = struck_mps(true);
  struck_second_mps_ = struck_mps(false);
}

ContactAction ContactRun::step_action(bool of_first) const {
  ContactAction action;
  const PlanarBody& body = motion_of(of_first ? first_ : second());
  const StepImpulse& impulse = of_first ? step_first_ : step_second_;
  action.dvx_mps = body.inverse_mass * impulse.whole.x;
  action.dvy_mps = body.inverse_mass * impulse.whole.y;
  action.rebound_x_mps = body.inverse_mass * impulse.rebound.x;
  action.rebound_y_mps = body.inverse_mass * impulse.rebound.y;
  action.path_mps = plane_length(action.dvx_mps, action.dvy_mps);
  action.light_mps = action.path_mps * light_share(of_first);
  action.struck_mps = of_first ? struck_first_mps_ : struck_second_mps_;
  const ContactBody& striker = of_first ? given_second_ : given_first_;
  action.edge_m2ps = action.path_mps * striker.vehicle->leading_edge_m;
  action.crush_j = applied_s_ * (of_first ? totals_.crush_first_w : totals_.crush_second_w);
  action.intruded_m3 = of_first ? totals_.intruded_first_m3 : totals_.intruded_second_m3;
  return action;
}

double ContactRun::deepest_m(bool of_first) const {
  double deepest = 0.0;
  for (const std::uint32_t k : pairs()) {
    const BodyPair& pair = state_->pairs[k];
    deepest = std::max({deepest, pair.intrusion_m(of_first),
                        of_first ? pair.earlier_first_m : pair.earlier_second_m});
  }
  return deepest;
}

void ContactRun::end_step() {
  // The contact ends when the bodies have separated (relative travel of `separation_m` without
  // force); when they pass each other without any force (`no_contact_m`); or when the force is
  // negligible: within a window of `window_s` and `window_m` of travel it adds less than
  // `low_force_share` of the impulse so far, and at least `min_impulse_share` of the relative
  // momentum has been exchanged. The last condition keeps a light graze from hiding the crash that
  // follows it.
  constexpr double separation_m = 0.3;
  constexpr double window_s = 0.03;
  constexpr double window_m = 0.1;
  constexpr double low_force_share = 0.05;
  constexpr double min_impulse_share = 0.3;
  constexpr double no_contact_m = 0.5;
  time_s_ += step_s_;
  ++steps_;
  if (presses()) {
    duration_s_ = time_s_;
    end_first_ = motion_of(first_);
    end_second_ = motion_of(second());
    record_.add(time_s_, end_first_, end_second_);
  }
  over_ =
      forceless_travel_m_ > (acts_ ? separation_m : no_contact_m) || time_s_ > longest_contact_s;
  if (acts_ && time_s_ - window_start_s_ > window_s && window_travel_m_ > window_m) {
    over_ = over_ || (window_impulse_ns_ < low_force_share * impulse_ns_ &&
                      impulse_ns_ > min_impulse_share * momentum_before_ns_);
    window_impulse_ns_ = 0.0;
    window_start_s_ = time_s_;
    window_travel_m_ = 0.0;
  }
}

}  // namespace crashrank::detail

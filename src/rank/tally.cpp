#include "rank/tally.hpp"

#include "crash/event_times.hpp"
#include "crash/rebound.hpp"
#include "crashrank/crash/contact_law.hpp"
#include "rank/measure_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crashrank::detail {
namespace {

double reduced_mass_kg(const Body& a, const Body& b) {
  if (std::isinf(a.mass_kg)) return b.mass_kg;
  return std::isinf(b.mass_kg) ? a.mass_kg : a.mass_kg * b.mass_kg / (a.mass_kg + b.mass_kg);
}

double struck_speed_of(const Scene& scene, const Body& body, const BodyEvent& event) {
  if (!body.vehicle.movable()) return event.closing_mps;
  const double struck_mps =
      struck_speed_mps(event.closing_mps, event.size_mps(), body.mass_kg, event.reduced_kg,
                       event.largest_reduced_kg, event.restitution);
  return std::max(struck_mps, scene.harm.least_struck_share * event.closing_mps);
}

/// Adds one side of a contact to an event.
void add_contact_side(BodyEvent& event, const Scene& scene, const ContactEffect& effect,
                      std::size_t side) {
  const SideEffect& own = effect.sides[side];
  const Body& other = body_of(scene, effect.sides[1 - side].body);
  event.end_s = std::max(event.end_s, effect.end_s);
  const double size_mps = own.delta_v_mps.norm();
  event.summed_mps += size_mps;
  event.moment_m += size_mps * effect.mean_force_s;
  event.delta_v_mps += own.delta_v_mps - own.squeeze_mps;
  event.greatest_mps = std::max(event.greatest_mps, size_mps);
  event.impulse_ns += own.impulse_ns;
  event.yaw_radps += own.yaw_radps;
  // The intrusion of a contact is the increase over earlier contacts of the same two bodies.
  const std::size_t intruder = effect.sides[1 - side].body;
  if (own.intrusion_m > 0.0 || intruder == event.intruder) {
    if (intruder != event.intruder) event.intruded_m = 0.0;
    event.intruder = intruder;
    event.intruded_m += own.intrusion_m;
    event.intrusion_m = std::max(event.intrusion_m, event.intruded_m);
  }
  const double reduced_kg = reduced_mass_kg(body_of(scene, own.body), other);
  event.largest_reduced_kg = std::max(event.largest_reduced_kg, reduced_kg);
  event.restitution = std::max(event.restitution, effect.restitution);
  if (effect.closing_mps < event.closing_mps) return;
  event.closing_mps = effect.closing_mps;
  event.reduced_kg = reduced_kg;
  event.leading_edge_m = other.vehicle.leading_edge_m;
}

BodyEvent new_event(const SideEffect& side) {
  BodyEvent event;
  event.forward = side.forward;
  event.road_mps = side.road_mps;
  return event;
}

/// The event of a contact that counts a share in [0, 1) of what was before it.
BodyEvent next_event(const BodyEvent& before, const SideEffect& side, double share) {
  BodyEvent event = before.scaled(share);
  event.forward = (share * before.forward + (1.0 - share) * side.forward).normalized();
  event.road_mps = share * before.road_mps + (1.0 - share) * side.road_mps;
  return event;
}

}  // namespace

double max_intrusion_m(const Vehicle& v) {
  const CrushCore& core = v.strength.core;
  const double half = 0.5 * (core.cage_front_m - core.cage_rear_m);
  return std::max(0.0, std::min(half, core.cage_half_width_m));
}

ContactEffect scale_restitution(const ContactEffect& effect, double factor) {
  ContactEffect e = effect;
  if (factor == 1.0) return e;
  const double gain = rebound_gain(effect.restitution, factor);
  const double loss = rebound_loss(effect.restitution, factor);
  e.dissipated_j *= loss;
  e.restitution = std::min(most_restitution, factor * effect.restitution);
  for (SideEffect& side : e.sides) {
    side.delta_v_mps *= gain;
    side.squeeze_mps *= gain;
    side.impulse_ns *= gain;
    side.yaw_radps *= gain;
    side.crush_j *= loss;
  }
  return e;
}

double BodyEvent::left_at(double time_s) const {
  return summed_mps > 0.0 ? share_left(moment_m / summed_mps, time_s) : 1.0;
}

BodyEvent BodyEvent::scaled(double share) const {
  BodyEvent event = *this;
  event.delta_v_mps *= share;
  event.greatest_mps *= share;
  event.summed_mps *= share;
  event.moment_m *= share;
  event.impulse_ns *= share;
  event.yaw_radps *= share;
  event.closing_mps *= share;
  event.largest_reduced_kg *= share;
  event.restitution *= share;
  event.intrusion_m *= share;
  event.intruded_m *= share;
  event.risk *= share;
  return event;
}

HarmExposure exposure_of(const Scene& scene, std::size_t index, const BodyEvent& event) {
  const Body& body = body_of(scene, index);
  HarmExposure e;
  e.kind = body.vehicle.kind;
  e.ego = index == ego_body;
  e.delta_v_mps = event.size_mps();
  e.pdof_deg = pdof_deg(event.impulse_ns, event.forward);
  e.closing_speed_mps = struck_speed_of(scene, body, event);
  e.leading_edge_m = event.leading_edge_m;
  e.intrusion_m = event.intrusion_m;
  e.road_speed_mps = event.road_mps;
  e.occupants = body.occupants;
  return e;
}

void Tally::begin() {
  sum_ = 0.0;
  bodies_.clear();
}

const Tally::Entry* Tally::find(std::size_t body) const {
  for (const Entry& entry : bodies_) {
    if (entry.body == body) return &entry;
  }
  return nullptr;
}

Tally::Entry& Tally::entry(std::size_t body) {
  for (Entry& entry : bodies_) {
    if (entry.body == body) return entry;
  }
  bodies_.push_back({});
  bodies_.back().body = body;
  return bodies_.back();
}

void Tally::add_side(const Scene& scene, const ContactEffect& effect, std::size_t side,
                     const HarmSample& sample) {
  const SideEffect& own = effect.sides[side];
  Entry& e = entry(own.body);
  const double gap_s = effect.begin_s - e.open.end_s;
  const bool is_first = e.open.number == 0;
  const double share = is_first ? 0.0 : shared_weight(gap_s) * e.open.left_at(effect.begin_s);
  if (share < 1.0) {
    // What is not kept of the contacts before is closed. Its risk is the one that,
    // combined with the risk kept, gives the risk before: the score does not fall.
    BodyEvent rest = e.open.scaled(1.0 - share);
    rest.risk /= 1.0 - share * e.open.risk;
    e.closed = term(scene, e, rest);
    e.open = next_event(e.open, own, share);
    if (is_first || gap_s >= same_event_s) ++e.open.number;
  }
  add_contact_side(e.open, scene, effect, side);
  if (!measure_row(scene.measure).counts_people) return;
  BodyEvent single = new_event(own);
  add_contact_side(single, scene, effect, side);
  const double risk = risk_of(exposure_of(scene, own.body, single), scene.harm, sample);
  e.greatest_risk = std::max(e.greatest_risk, risk);
  e.open.risk = std::max(
      {e.open.risk, risk, risk_of(exposure_of(scene, own.body, e.open), scene.harm, sample)});
}

void Tally::add(const Scene& scene, const ContactEffect& simulated, const HarmSample& sample) {
  const MeasureRow& row = measure_row(scene.measure);
  const ContactEffect effect = scale_restitution(simulated, sample.restitution);
  for (std::size_t side = 0; side < effect.sides.size(); ++side) {
    add_side(scene, effect, side, sample);
    sum_ += row.of_side(effect.sides[side], scene.harm.weights);
  }
  sum_ += row.of_contact(effect);
}

/// Term of a body over its closed events and `last`: the risk of its people, or the summed delta-v
/// of the ego.
double Tally::term(const Scene& scene, const Entry& e, const BodyEvent& last) const {
  if (e.open.number == 0) return e.closed;
  return measure_row(scene.measure).of_body(e.closed, last, e.body == ego_body);
}

double Tally::people_score(const Scene& scene, std::size_t body) const {
  const Entry* const e = find(body);
  if (e == nullptr) return 0.0;
  const double people = term(scene, *e, e->open);
  if (!measure_row(scene.measure).counts_people) return people;
  return people_weight(exposure_of(scene, body, e->open), scene.harm.weights) * people;
}

std::vector<PersonRisk> Tally::people(const Scene& scene) const {
  std::vector<PersonRisk> people;
  if (!measure_row(scene.measure).counts_people) return people;
  HarmWeights unit_weights = scene.harm.weights;
  unit_weights.ego_occupant = unit_weights.other_occupant = 1.0;
  unit_weights.pedestrian = unit_weights.cyclist = unit_weights.motorcyclist = 1.0;
  for (const Entry& e : bodies_) {
    const double persons = people_weight(exposure_of(scene, e.body, e.open), unit_weights);
    if (persons > 0.0) people.push_back({e.body, persons, term(scene, e, e.open)});
  }
  return people;
}

BodyEvent Tally::event(std::size_t body) const {
  const Entry* const e = find(body);
  return e == nullptr ? BodyEvent{} : e->open;
}

double Tally::score(const Scene& scene) const {
  double score = sum_;
  for (const Entry& e : bodies_) score += people_score(scene, e.body);
  return score;
}

double Tally::lower_bound(const Scene& scene) const {
  constexpr double rounding = 1.0 - 1e-9;
  double score = sum_;
  if (measure_row(scene.measure).counts_people) {
    for (const Entry& e : bodies_) {
      score +=
          e.greatest_risk * people_weight(exposure_of(scene, e.body, e.open), scene.harm.weights);
    }
  }
  return rounding * score;
}

}  // namespace crashrank::detail

#include "rank/tally.hpp"

#include "crash/rebound.hpp"
#include "crashrank/crash/pdof.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace crashrank::detail {
namespace {

/// Sums and roots round; bounds are widened by far more than that.
constexpr double slack = 1.0 + 1e-9;

double reduced_kg(double m1, double m2) {
  if (std::isinf(m1)) return m2;
  return std::isinf(m2) ? m1 : m1 * m2 / (m1 + m2);
}

double struck_by(const Body& body, double closing_mps, double delta_v_mps, double reduced) {
  if (!body.vehicle.movable()) return closing_mps;
  return struck_speed_mps(closing_mps, delta_v_mps, body.mass_kg, reduced);
}

/// Least and greatest risk over all directions and intrusions that a delta-v in a range may have.
Range risk_over(const Scene& scene, const HarmExposure& exposure, const Body& body,
                const Range& delta_v, double closing_mps, const Range& reduced,
                double other_edge_m) {
  constexpr std::array<double, 3> sides_deg{0.0, 90.0, 180.0};
  const HarmSample& plain = scene.plain;
  Range risk{1.0, 0.0};
  const double intrusion = std::max(exposure.intrusion_m, most_intrusion_m(body.vehicle));
  for (const double side : sides_deg) {
    for (const double edge : {exposure.leading_edge_m, other_edge_m}) {
      HarmExposure e = exposure;
      e.leading_edge_m = edge;
      e.pdof_deg = side;
      e.delta_v_mps = delta_v.least;
      e.closing_speed_mps = struck_by(body, closing_mps, delta_v.least, reduced.most);
      risk.least = std::min(risk.least, risk_of(e, scene.harm, plain));
      e.delta_v_mps = delta_v.most;
      e.closing_speed_mps = struck_by(body, closing_mps, delta_v.most, reduced.least);
      e.intrusion_m = intrusion;
      risk.most = std::max(risk.most, risk_of(e, scene.harm, plain));
    }
  }
  return {risk.least / slack, std::min(1.0, slack * risk.most)};
}

bool continues(const EgoEvent& event, double begin_s) {
  return event.number > 0 && begin_s - event.end_s < same_event_s;
}

}  // namespace

double most_intrusion_m(const Vehicle& v) {
  const CrushCore& core = v.strength.core;
  const double half = 0.5 * (core.cage_front_m - core.cage_rear_m);
  return std::max(0.0, std::min(half, core.cage_half_width_m));
}

ContactEffect effect_of(const Contact& contact, const CrashSetup& crash,
                        const ContactOutcome& outcome) {
  ContactEffect e;
  e.actor = contact.actor;
  e.begin_s = contact.time_of_impact_s;
  e.end_s = contact.time_of_impact_s + outcome.duration_s;
  e.closing_mps = contact.closing_speed_mps;
  e.ego_forward = crash.a.pose.rotation.col(0);
  e.ego_road_mps = crash.a.velocity.linear_mps.norm();
  e.other_road_mps = crash.b.velocity.linear_mps.norm();
  if (!outcome.acts) return e;
  e.restitution = outcome.restitution;
  e.dissipated_j = outcome.dissipated_j;
  e.ego_delta_v_mps = outcome.a.delta_v_mps;
  e.ego_impulse_ns = outcome.a.impulse_ns;
  e.ego_yaw_radps = outcome.a.delta_yaw_rate_radps;
  e.other_delta_v_mps = outcome.b.delta_v_mps.norm();
  e.other_pdof_deg = outcome.b.pdof_deg;
  e.ego_intrusion_m = outcome.a.intrusion_m;
  e.other_intrusion_m = outcome.b.intrusion_m;
  e.ego_crush_j = outcome.a.crush_energy_j;
  e.other_crush_j = outcome.b.crush_energy_j;
  return e;
}

ContactEffect with_rebound(const ContactEffect& effect, double factor) {
  ContactEffect e = effect;
  if (factor == 1.0) return e;
  const double gain = rebound_gain(effect.restitution, factor);
  e.ego_delta_v_mps *= gain;
  e.ego_impulse_ns *= gain;
  e.ego_yaw_radps *= gain;
  e.other_delta_v_mps *= gain;
  const double loss = rebound_loss(effect.restitution, factor);
  e.dissipated_j *= loss;
  e.ego_crush_j *= loss;
  e.other_crush_j *= loss;
  return e;
}

HarmExposure exposure_of(const Scene& scene, const EgoEvent& event) {
  HarmExposure e;
  e.kind = scene.ego.vehicle.kind;
  e.ego = true;
  e.delta_v_mps = event.delta_v_mps.norm();
  e.pdof_deg = pdof_deg(event.impulse_ns, event.forward);
  e.closing_speed_mps = struck_by(scene.ego, event.closing_mps, e.delta_v_mps, event.reduced_kg);
  e.leading_edge_m = event.leading_edge_m;
  e.intrusion_m = event.intrusion_m;
  e.road_speed_mps = event.road_mps;
  e.occupants = scene.ego.occupants;
  return e;
}

HarmExposure exposure_of_other(const Scene& scene, const ContactEffect& effect) {
  const Body& body = scene.actors[effect.actor];
  HarmExposure e;
  e.kind = body.vehicle.kind;
  e.delta_v_mps = effect.other_delta_v_mps;
  e.pdof_deg = effect.other_pdof_deg;
  e.closing_speed_mps = struck_by(body, effect.closing_mps, effect.other_delta_v_mps,
                                  reduced_kg(scene.ego.mass_kg, body.mass_kg));
  e.leading_edge_m = scene.ego.vehicle.leading_edge_m;
  e.intrusion_m = effect.other_intrusion_m;
  e.road_speed_mps = effect.other_road_mps;
  e.occupants = body.occupants;
  return e;
}

void Tally::add(const Scene& scene, const ContactEffect& simulated, const HarmSample& sample) {
  const ContactEffect effect = with_rebound(simulated, sample.restitution);
  const Body& other = scene.actors[effect.actor];
  if (!continues(open_, effect.begin_s)) {
    const double before = ego_term(scene);
    closed_ = before;
    const std::size_t number = open_.number + 1;
    open_ = {};
    open_.number = number;
    open_.begin_s = effect.begin_s;
    open_.forward = effect.ego_forward;
    open_.road_mps = effect.ego_road_mps;
  }
  open_.end_s = std::max(open_.end_s, effect.end_s);
  open_.delta_v_mps += effect.ego_delta_v_mps;
  open_.impulse_ns += effect.ego_impulse_ns;
  open_.yaw_radps += effect.ego_yaw_radps;
  open_.intrusion_m = std::max(open_.intrusion_m, effect.ego_intrusion_m);
  if (effect.closing_mps >= open_.closing_mps) {
    open_.closing_mps = effect.closing_mps;
    open_.reduced_kg = reduced_kg(scene.ego.mass_kg, other.mass_kg);
    open_.leading_edge_m = other.vehicle.leading_edge_m;
  }
  if (scene.measure == Measure::harm) {
    open_.risk = std::max(open_.risk, risk_of(exposure_of(scene, open_), scene.harm, sample));
  }
  switch (scene.measure) {
    case Measure::energy:
      sum_ += effect.dissipated_j;
      break;
    case Measure::intrusion:
      sum_ += effect.ego_intrusion_m + effect.other_intrusion_m;
      break;
    case Measure::harm: {
      HarmExposure e = exposure_of_other(scene, effect);
      e.crush_energy_j = effect.other_crush_j;
      sum_ += harm_of(e, scene.harm, sample);
      e.crush_energy_j = effect.ego_crush_j;
      sum_ += property_harm(e, scene.harm.weights);
      break;
    }
    default:
      break;
  }
}

/// Risk of the ego's people, or its summed delta-v, over all events.
double Tally::ego_term(const Scene& scene) const {
  if (open_.number == 0) return closed_;
  if (scene.measure == Measure::delta_v) {
    return closed_ + open_.delta_v_mps.norm();
  }
  if (scene.measure != Measure::harm) return 0.0;
  return combined_risk(closed_, open_.risk);
}

double Tally::ego_score(const Scene& scene) const {
  const double ego = ego_term(scene);
  if (scene.measure != Measure::harm) return ego;
  return people_weight(exposure_of(scene, open_), scene.harm.weights) * ego;
}

double Tally::score(const Scene& scene) const { return sum_ + ego_score(scene); }

Range Tally::bounds(const Scene& scene, const PendingContact& pending, const Later& later) const {
  const bool same = continues(open_, pending.begin_s);
  const double known = same ? open_.delta_v_mps.norm() : 0.0;
  const Range& own = pending.ego_delta_v_mps;
  // The event's delta-v: by the triangle inequality where the contact continues it.
  Range event{same ? std::max({0.0, known - own.most, own.least - known}) : own.least,
              known + own.most};
  const double before = same ? closed_ : ego_term(scene);
  Range score;
  switch (scene.measure) {
    case Measure::delta_v:
      // A later contact may belong to the event and take its delta-v back.
      score = {before + (later.any ? 0.0 : event.least), before + event.most + later.most};
      break;
    case Measure::energy:
      score = {sum_ + pending.dissipated_j.least, sum_ + pending.dissipated_j.most + later.most};
      break;
    case Measure::harm: {
      const Body& other = scene.actors[pending.actor];
      const double reduced = reduced_kg(scene.ego.mass_kg, other.mass_kg);
      EgoEvent begun = same ? open_ : EgoEvent{};
      if (!same) {
        begun.road_mps = pending.ego_road_mps;
        begun.leading_edge_m = other.vehicle.leading_edge_m;
      }
      const HarmExposure ego = exposure_of(scene, begun);
      const double closing = std::max(begun.closing_mps, pending.closing_mps);
      const Range of_event{same ? std::min(begun.reduced_kg, reduced) : reduced,
                           std::max(begun.reduced_kg, reduced)};
      Range ego_risk =
          risk_over(scene, ego, scene.ego, event, closing, of_event, other.vehicle.leading_edge_m);
      // What has happened in the event stays.
      ego_risk.least = std::max(ego_risk.least, begun.risk);
      ego_risk.most = std::max(ego_risk.most, begun.risk);
      ContactEffect struck;
      struck.actor = pending.actor;
      struck.closing_mps = pending.closing_mps;
      struck.other_road_mps = pending.other_road_mps;
      const HarmExposure theirs = exposure_of_other(scene, struck);
      const Range other_risk =
          risk_over(scene, theirs, other, pending.other_delta_v_mps, pending.closing_mps,
                    {reduced, reduced}, theirs.leading_edge_m);
      const double ego_people = people_weight(ego, scene.harm.weights);
      const double other_people = people_weight(theirs, scene.harm.weights);
      const double least_ego = combined_risk(before, ego_risk.least);
      // An occupant's -ln(1 - risk) is convex in delta-v and 0 at 0, so that no way in which later
      // contacts share their delta-v among events is worse than all of it in this one.
      double most_ego = combined_risk(before, ego_risk.most);
      if (later.any) {
        const Range all{0.0, event.most + later.ego_delta_v_mps};
        most_ego =
            has_cage(ego.kind) && std::isfinite(all.most)
                ? combined_risk(
                      before, std::max(begun.risk, risk_over(scene, ego, scene.ego, all, closing,
                                                             of_event, other.vehicle.leading_edge_m)
                                                       .most))
                : 1.0;
      }
      score.least = sum_ + ego_people * least_ego + other_people * other_risk.least;
      score.most = sum_ + ego_people * most_ego + other_people * other_risk.most + later.most +
                   scene.harm.weights.property_per_mj * 1e-6 * pending.dissipated_j.most;
      break;
    }
    default:
      score = {0.0, std::numeric_limits<double>::infinity()};
      break;
  }
  return {score.least / slack, slack * score.most};
}

}  // namespace crashrank::detail

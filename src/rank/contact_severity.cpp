#include "rank/contact_severity.hpp"

#include "crashrank/crash/severity.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;

/// A strength that is the same from all sides, up to the body's height.
CrushStrength soft(double yield_npm, double slope_npm2, double height_m) {
  CrushStrength strength;
  strength.front = {yield_npm, slope_npm2};
  strength.side = strength.front;
  strength.rear = strength.front;
  strength.low_m = 0.0;
  strength.high_m = std::max(height_m, 0.1);
  return strength;
}

CrushStrength strength_of(BodyKind kind, double mass_kg, const Box& box) {
  constexpr double without_mirrors = 0.9;
  constexpr double rear_overhang = 0.2;
  constexpr double wheelbase = 0.6;
  const Vector3d size = box.extent().cast<double>();
  CarShape shape;
  shape.mass_kg = mass_kg;
  shape.width_m = without_mirrors * size.y();
  shape.rear_axle_x_m = static_cast<double>(box.min.x()) + rear_overhang * size.x();
  shape.wheelbase_m = wheelbase * size.x();
  switch (kind) {
    case BodyKind::car:
      return car_strength(shape);
    case BodyKind::truck:
    case BodyKind::bus: {
      // Campbell's line for the mass, borne by the chassis.
      CrushStrength strength = car_strength(shape);
      strength.core = CrushCore{};
      strength.low_m = 0.4;
      strength.high_m = 1.2;
      return strength;
    }
    case BodyKind::motorcycle:
    case BodyKind::bicycle:
      return soft(10e3, 200e3, size.z());
    case BodyKind::pedestrian:
      // About 5 kN/m at no depth: what a chest bears over its breadth.
      return soft(5e3, 50e3, size.z());
    case BodyKind::barrier:
    case BodyKind::pole:
    case BodyKind::building:
      break;
  }
  return CrushStrength::unyielding();
}

PulseBody pulse_body(const Body& body, const Motion& motion, double time_s) {
  PulseBody placed;
  Velocity velocity;
  motion.state_at(time_s, placed.pose, velocity);
  placed.mesh = &body.model->mesh;
  placed.tree = &body.model->tree;
  placed.rigid = place(body.mass, placed.pose, velocity);
  placed.strength = body.strength;
  if (!placed.rigid.movable()) {
    placed.rigid.velocity = Velocity{};
    placed.strength = CrushStrength::unyielding();
  }
  return placed;
}

void tell(const BodySeverity& from, BodyOutcome& to) {
  to.delta_v_mps = from.delta_v_total_mps;
  to.delta_v_x_mps = from.delta_v_mps.x();
  to.delta_v_y_mps = from.delta_v_mps.y();
  to.yaw_rate_change_radps = from.yaw_rate_change_radps;
  to.pdof_deg = from.pdof_deg;
  to.clock = from.clock;
  to.crush_energy_j = from.crush_energy_j;
  to.ees_mps = from.ees_mps;
  to.crush_m = from.crush_m;
  to.intrusion_m = from.intrusion_m;
  to.cdc = from.cdc;
}

/// One rigid impulse: what can be told without following the crush.
void tell_impulse(const Scene& scene, const PulseBody& a, const PulseBody& b, Contact& contact) {
  ImpulseOptions options;
  options.friction = scene.harm.friction;
  const Vector3d normal = contact.normal.norm() > 0.0 ? contact.normal : contact.closing;
  if (!(normal.norm() > 0.0)) return;
  const ImpulseResult result =
      impulse(a.rigid, b.rigid, contact.point_m, normal.normalized(), options);
  contact.severity.slides = result.slides;
  contact.severity.dissipated_j = result.dissipated_j;
  const auto fill = [](const PulseBody& body, const BodyImpulse& from, BodyOutcome& to) {
    const Vector3d local = body.pose.rotation.transpose() * from.delta_v_mps;
    to.delta_v_mps = from.delta_v_mps.norm();
    to.delta_v_x_mps = local.x();
    to.delta_v_y_mps = local.y();
    to.yaw_rate_change_radps = from.delta_omega_radps.z();
    to.pdof_deg = pdof_deg(from.impulse_ns, body.rigid.forward);
    to.clock = clock_of(to.pdof_deg);
  };
  fill(a, result.a, contact.severity.ego);
  fill(b, result.b, contact.severity.other);
}

SeverityOptions coarse(double friction) {
  SeverityOptions options;
  options.pulse.friction = friction;
  options.pulse.cell_w_m = 0.05;
  options.pulse.cell_h_m = 0.2;
  options.pulse.step_s = 0.001;
  options.pulse.longest_s = 0.2;
  options.crush.cell_m = 0.1;
  return options;
}

HarmExposure exposure_of(const Body& body, const Body& striker, bool ego, const Contact& contact,
                         const BodyOutcome& outcome) {
  HarmExposure e;
  e.kind = body.kind;
  e.ego = ego;
  e.delta_v_mps = outcome.delta_v_mps;
  e.pdof_deg = outcome.pdof_deg;
  e.closing_speed_mps = contact.closing_speed_mps;
  e.leading_edge_m = striker.leading_edge_m;
  e.crush_energy_j = outcome.crush_energy_j;
  return e;
}

double harm_of_both(const Scene& scene, const Contact& contact, double faster, BodyOutcome& ego,
                    BodyOutcome& other) {
  const Body& actor = scene.actors[contact.actor];
  HarmExposure one = exposure_of(scene.ego, actor, true, contact, ego);
  HarmExposure two = exposure_of(actor, scene.ego, false, contact, other);
  one.delta_v_mps *= faster;
  two.delta_v_mps *= faster;
  ego.harm = harm_of(one, scene.harm);
  other.harm = harm_of(two, scene.harm);
  return ego.harm + other.harm;
}

/// The harm over the ranges: each end of each in turn, the others as they are.
ScoreInterval harm_interval(const Scene& scene, const PulseBody& a, const PulseBody& b,
                            const Vector3d& along, const Contact& contact) {
  const HarmRanges& ranges = scene.harm.ranges;
  ScoreInterval interval{contact.severity.harm, contact.severity.harm};
  const double friction = scene.harm.friction;
  const std::array<PulseVariant, 4> variants{{{ranges.least_friction, 1.0},
                                              {ranges.most_friction, 1.0},
                                              {friction, ranges.least_strength},
                                              {friction, ranges.most_strength}}};
  for (const PulseResult& pulse :
       simulate_pulses(a, b, contact.point_m, along, {variants.data(), variants.size()},
                       coarse(friction).pulse)) {
    BodyOutcome ego = contact.severity.ego;
    BodyOutcome other = contact.severity.other;
    ego.delta_v_mps = pulse.a.delta_v_mps.norm();
    other.delta_v_mps = pulse.b.delta_v_mps.norm();
    if (pulse.acts) {
      ego.pdof_deg = pdof_deg(pulse.a.impulse_ns, a.rigid.forward);
      other.pdof_deg = pdof_deg(pulse.b.impulse_ns, b.rigid.forward);
    }
    const double harm = harm_of_both(scene, contact, 1.0, ego, other);
    interval.lowest = std::min(interval.lowest, harm);
    interval.highest = std::max(interval.highest, harm);
  }
  BodyOutcome ego = contact.severity.ego;
  BodyOutcome other = contact.severity.other;
  interval.highest = std::max(
      interval.highest, harm_of_both(scene, contact, 1.0 + ranges.most_restitution, ego, other));
  return interval;
}

}  // namespace

void prepare_body(const ScenarioModel& model, Body& body) {
  const Box box = body.model->mesh.bounds();
  const Vector3d size = box.extent().cast<double>();
  body.kind = model.kind;
  body.mass.mass_kg = body.mass_kg;
  body.mass.center_m = box.center().cast<double>();
  const double flat = (size.x() * size.x() + size.y() * size.y()) / 12.0;
  body.mass.inertia_kgm2 = Eigen::Matrix3d::Identity();
  if (std::isfinite(body.mass_kg)) body.mass.inertia_kgm2 *= body.mass_kg * std::max(flat, 1e-6);
  body.strength = strength_of(model.kind, body.mass_kg, box);
  body.leading_edge_m = leading_edge_m(body.model->mesh);
}

void tell_severity(const Scene& scene, const Motion& ego_motion, Contact& contact) {
  const Body& other = scene.actors[contact.actor];
  const PulseBody a = pulse_body(scene.ego, ego_motion, contact.time_of_impact_s);
  const PulseBody b = pulse_body(other, other.motion, contact.time_of_impact_s);
  ContactSeverity& told = contact.severity;
  if (!scene.pulses) {
    tell_impulse(scene, a, b, contact);
    return;
  }
  Vector3d along(contact.closing.x(), contact.closing.y(), 0.0);
  if (!(along.norm() > 1e-6)) along = Vector3d(contact.normal.x(), contact.normal.y(), 0.0);
  const Severity severity =
      crash_severity(a, b, contact.point_m, along, coarse(scene.harm.friction));
  told.simulated = true;
  told.slides = severity.pulse.slides;
  told.duration_s = severity.pulse.duration_s;
  told.dissipated_j = severity.pulse.dissipated_j;
  tell(severity.a, told.ego);
  tell(severity.b, told.other);
  told.harm = harm_of_both(scene, contact, 1.0, told.ego, told.other);
  told.harm_interval = {told.harm, told.harm};
  if (scene.measure == Measure::harm && scene.harm.intervals) {
    told.harm_interval = harm_interval(scene, a, b, along, contact);
  }
}

}  // namespace crashrank::detail

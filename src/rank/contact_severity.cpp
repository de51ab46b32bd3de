#include "rank/contact_severity.hpp"

#include "crash/severity_of.hpp"
#include "rank/crash_setup.hpp"

#include "crashrank/crash/pulse.hpp"
#include "crashrank/crash/severity.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

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
  // Of lorries and buses: bumper and front wall, then a cab with seats (a bus to its rear wall).
  constexpr double before_cab_m = 0.3;
  constexpr double cab_m = 2.0;
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
      // Campbell's line for the mass, borne by the chassis over its whole width.
      CrushStrength strength = car_strength(shape);
      strength.core = CrushCore{};
      strength.core.cage_half_width_m = 0.5 * shape.width_m;
      strength.core.cage_front_m = static_cast<double>(box.max.x()) - before_cab_m;
      strength.core.cage_rear_m = kind == BodyKind::truck
                                      ? strength.core.cage_front_m - cab_m
                                      : static_cast<double>(box.min.x()) + before_cab_m;
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

/// What the pulse alone tells, without the crush that follows from it.
void tell_pulse(const PulseBody& a, const PulseBody& b, const PulseResult& pulse,
                ContactSeverity& told) {
  told.slides = pulse.slides;
  told.duration_s = pulse.duration_s;
  told.dissipated_j = pulse.dissipated_j;
  const auto fill = [](const PulseBody& body, const BodyImpulse& from, BodyOutcome& to) {
    const Vector3d local = body.pose.rotation.transpose() * from.delta_v_mps;
    to.delta_v_mps = from.delta_v_mps.norm();
    to.delta_v_x_mps = local.x();
    to.delta_v_y_mps = local.y();
    to.yaw_rate_change_radps = from.delta_omega_radps.z();
    to.pdof_deg = pdof_deg(from.impulse_ns, body.rigid.forward);
    to.clock = clock_of(to.pdof_deg);
  };
  fill(a, pulse.a, told.ego);
  fill(b, pulse.b, told.other);
}

/// The score that one contact adds in a sample.
double sample_score(const Scene& scene, const HarmExposure& ego, const HarmExposure& other,
                    double dissipated_j, const HarmSample& sample) {
  const double e = sample.restitution;
  switch (scene.measure) {
    case Measure::delta_v:
      return (1.0 + e) * ego.delta_v_mps;
    case Measure::energy:
      return (1.0 - e * e) * dissipated_j;
    default:
      return harm_of(ego, scene.harm, sample) + harm_of(other, scene.harm, sample);
  }
}

PulseVariant variant_of(const HarmSample& sample) { return {sample.friction, sample.strength}; }

bool same(const PulseVariant& p, const PulseVariant& q) {
  return p.friction == q.friction && p.strength == q.strength;
}

/// The plain pulse's variant, then those of the scene's samples, in their order. Samples that
/// differ in risk alone share their pulse; they follow each other.
std::vector<PulseVariant> variants_of(const Scene& scene, const PulseVariant& plain) {
  std::vector<PulseVariant> variants{plain};
  for (std::size_t i = 1; i < scene.samples.size(); ++i) {
    const PulseVariant wanted = variant_of(scene.samples[i]);
    if (variants.size() == 1 || !same(variants.back(), wanted)) variants.push_back(wanted);
  }
  return variants;
}

/// Evaluates the contact in every sample of the scene, from the pulses of `variants_of`.
void tell_samples(const Scene& scene, const PulseBody& a, const PulseBody& b,
                  const std::vector<PulseVariant>& variants, const std::vector<PulseResult>& pulses,
                  Contact& contact) {
  ContactSeverity& told = contact.severity;
  const std::vector<HarmSample>& samples = scene.samples;
  const HarmExposure ego =
      exposure_of(scene, scene.ego, scene.actors[contact.actor], true, contact, told.ego);
  const HarmExposure other =
      exposure_of(scene, scene.actors[contact.actor], scene.ego, false, contact, told.other);
  told.sample_scores.reserve(samples.size());
  told.sample_scores.push_back(sample_score(scene, ego, other, told.dissipated_j, samples.front()));

  std::size_t at = 1;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (!same(variants[at], variant_of(samples[i]))) ++at;
    const PulseResult& pulse = pulses[at];
    HarmExposure one = ego;
    HarmExposure two = other;
    const Body& actor = scene.actors[contact.actor];
    one.delta_v_mps = pulse.a.delta_v_mps.norm();
    two.delta_v_mps = pulse.b.delta_v_mps.norm();
    one.closing_speed_mps = struck(scene, scene.ego, actor, contact, one.delta_v_mps);
    two.closing_speed_mps = struck(scene, actor, scene.ego, contact, two.delta_v_mps);
    if (pulse.acts) {
      one.pdof_deg = pdof_deg(pulse.a.impulse_ns, a.rigid.forward);
      two.pdof_deg = pdof_deg(pulse.b.impulse_ns, b.rigid.forward);
    }
    told.sample_scores.push_back(sample_score(scene, one, two, pulse.dissipated_j, samples[i]));
  }
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

EgoAfterContact tell_severity(const Scene& scene, const EgoAtContact& ego, Contact& contact) {
  const Body& other = scene.actors[contact.actor];
  const CrashSetup crash = set_up_crash(scene, ego, contact);
  ContactSeverity& told = contact.severity;
  const SeverityOptions how = coarse(scene.harm.friction);
  if (!scene.pulses) {
    tell_pulse(crash.a, crash.b,
               simulate_pulse(crash.a, crash.b, contact.point_m, crash.along, how.pulse), told);
    return after_pulse(crash, {});
  }
  // One look at the surfaces serves the plain pulse and those of the samples.
  const std::vector<PulseVariant> variants = variants_of(scene, {how.pulse.friction, 1.0});
  const std::vector<PulseResult> pulses =
      simulate_pulses(crash.a, crash.b, contact.point_m, crash.along,
                      {variants.data(), variants.size()}, how.pulse);
  const Severity severity =
      severity_of(crash.a, crash.b, contact.point_m, crash.along, pulses.front(), how.crush);
  told.simulated = true;
  told.slides = severity.pulse.slides;
  told.duration_s = severity.pulse.duration_s;
  told.dissipated_j = severity.pulse.dissipated_j;
  tell(severity.a, told.ego);
  tell(severity.b, told.other);
  told.ego.harm =
      harm_of(exposure_of(scene, scene.ego, other, true, contact, told.ego), scene.harm);
  told.other.harm =
      harm_of(exposure_of(scene, other, scene.ego, false, contact, told.other), scene.harm);
  told.harm = told.ego.harm + told.other.harm;
  if (!scene.samples.empty()) {
    tell_samples(scene, crash.a, crash.b, variants, pulses, contact);
  }
  return after_pulse(crash, severity.pulse);
}

}  // namespace crashrank::detail

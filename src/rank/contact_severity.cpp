#include "rank/contact_severity.hpp"

#include "crash/contact_run.hpp"
#include "crashrank/crash/cdc.hpp"
#include "crashrank/crash/pdof.hpp"
#include "rank/crash_scratch.hpp"
#include "rank/crash_setup.hpp"
#include "rank/tally.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;

bool same(const HarmSample& p, const HarmSample& q) {
  return p.friction == q.friction && p.strength == q.strength && p.step == q.step &&
         p.shift_m == q.shift_m;
}

void fill(const ContactBody& body, const Model& model, const BodyContact& from, bool slides,
          BodyOutcome& to) {
  const Vehicle& v = *body.vehicle;
  const Vector3d local = body.pose.rotation.transpose() * from.delta_v_mps;
  to.delta_v_mps = from.delta_v_mps.norm();
  to.delta_v_x_mps = local.x();
  to.delta_v_y_mps = local.y();
  to.yaw_rate_change_radps = from.delta_yaw_rate_radps;
  to.event_delta_v_mps = to.delta_v_mps;
  to.event_yaw_rate_change_radps = to.yaw_rate_change_radps;
  to.pdof_deg = from.pdof_deg;
  to.clock = clock_of(to.pdof_deg);
  to.crush_energy_j = from.crush_energy_j;
  to.ees_mps = v.movable() ? std::sqrt(2.0 * from.crush_energy_j / v.mass_kg) : 0.0;
  to.intrusion_m = from.intrusion_m;
  if (from.damaged.empty()) return;
  const Box bounds = model.mesh.bounds();
  const double damage_m = damage_depth_m(from.damaged, bounds);
  // What ploughs along a flank is deep below the front, but damage is no deeper than its bounds.
  to.crush_m = std::min(from.crush_depth_m, damage_m);
  to.cdc = cdc_code({to.pdof_deg, from.damaged, bounds, damage_m, slides});
}

}  // namespace

std::vector<std::size_t> effect_of_sample(const Scene& scene) {
  std::vector<std::size_t> places;
  std::size_t last = 0;
  for (std::size_t i = 0; i < scene.samples.size(); ++i) {
    if (i > 0 && (last == 0 || !same(scene.samples[i], scene.samples[i - 1]))) ++last;
    places.push_back(last);
  }
  return places;
}

EgoAfterContact simulate_variants(const Scene& scene, const EgoAtContact& ego, Contact& contact,
                                  std::vector<std::size_t>& met, CrashScratch& scratch,
                                  std::vector<ContactEffect>& effects) {
  const Body& other = scene.actors[contact.actor];
  const CrashSetup crash =
      set_up_crash(scene, ego, contact, {met.data(), met.size()}, scratch.group);
  const ContactOutcome plain = simulate_contact(crash.a, crash.b, crash.fixed, contact.point_m,
                                                variant_of(scene.plain), scratch.workspace);
  scratch.motion = plain.motion;
  add_pressed(scene, scratch.workspace.state(), scratch.group, met);
  ContactSeverity& severity = contact.severity;
  severity.simulated = true;
  severity.slides = plain.slides;
  severity.duration_s = plain.duration_s;
  severity.dissipated_j = plain.dissipated_j;
  fill(crash.a, *scene.ego.model, plain.a, plain.slides, severity.ego);
  fill(crash.b, *other.model, plain.b, plain.slides, severity.other);
  effects.push_back(effect_of(contact, crash, plain));
  for (std::size_t i = 1; i < scene.samples.size(); ++i) {
    if (i > 1 && same(scene.samples[i], scene.samples[i - 1])) continue;
    const HarmSample& sample = scene.samples[i];
    const CrashSetup varied = shifted(crash, contact, sample);
    effects.push_back(
        effect_of(contact, varied,
                  simulate_contact(varied.a, varied.b, varied.fixed, contact.point_m,
                                   variant_of(sample), scratch.workspace, options_of(sample))));
  }
  return after_contact(crash, plain);
}

}  // namespace crashrank::detail

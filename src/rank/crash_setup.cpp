#include "rank/crash_setup.hpp"

#include <cmath>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;

PulseBody pulse_body(const Body& body, const Pose& pose, const Velocity& velocity) {
  PulseBody placed;
  placed.pose = pose;
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

}  // namespace

double struck(const Scene& scene, const Body& body, const Body& striker, const Contact& contact,
              double delta_v_mps) {
  if (std::isinf(body.mass_kg)) return contact.closing_speed_mps;
  const double reduced_kg = std::isinf(striker.mass_kg)
                                ? body.mass_kg
                                : body.mass_kg * striker.mass_kg / (body.mass_kg + striker.mass_kg);
  return struck_speed_mps(contact.closing_speed_mps, delta_v_mps, body.mass_kg, reduced_kg,
                          scene.harm);
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

HarmExposure exposure_of(const Scene& scene, const Body& body, const Body& striker, bool ego,
                         const Contact& contact, const BodyOutcome& outcome) {
  HarmExposure e;
  e.kind = body.kind;
  e.ego = ego;
  e.delta_v_mps = outcome.delta_v_mps;
  e.pdof_deg = outcome.pdof_deg;
  e.closing_speed_mps = struck(scene, body, striker, contact, outcome.delta_v_mps);
  e.leading_edge_m = striker.leading_edge_m;
  e.crush_energy_j = outcome.crush_energy_j;
  return e;
}

CrashSetup set_up_crash(const Scene& scene, const EgoAtContact& ego, const Contact& contact) {
  const Body& other = scene.actors[contact.actor];
  Pose other_pose;
  Velocity other_velocity;
  other.motion.state_at(contact.time_of_impact_s, other_pose, other_velocity);
  const Vector3d closing =
      velocity_of_point(ego.left, ego.pose.translation, contact.point_m) -
      velocity_of_point(other_velocity, other_pose.translation, contact.point_m);
  Vector3d along(closing.x(), closing.y(), 0.0);
  if (!(along.norm() > 1e-6)) along = Vector3d(contact.normal.x(), contact.normal.y(), 0.0);
  return {pulse_body(scene.ego, ego.pose, ego.left), pulse_body(other, other_pose, other_velocity),
          along};
}

EgoAfterContact after_pulse(const CrashSetup& crash, const PulseResult& pulse) {
  EgoAfterContact after;
  after.velocity = crash.a.rigid.velocity;
  if (!pulse.acts) return after;
  after.duration_s = pulse.duration_s;
  after.moved_m = pulse.moved_a_m;
  after.turned_rad = pulse.turned_a_rad;
  after.velocity = pulse.a.after;
  return after;
}

}  // namespace crashrank::detail

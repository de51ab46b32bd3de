#include "rank/crash_setup.hpp"

#include "crash/contact_run.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;

ContactBody contact_body(const Body& body, const Pose& pose, const Velocity& velocity) {
  ContactBody placed;
  placed.vehicle = &body.vehicle;
  placed.pose = pose;
  if (body.vehicle.movable()) placed.velocity = velocity;
  return placed;
}

ContactBody fixed_body(const Scene& scene, std::size_t actor, double time_s) {
  const std::size_t joined = scene.joined_of[actor];
  if (joined == Scene::alone) {
    const Body& body = scene.actors[actor];
    return contact_body(body, body.motion.pose_at(time_s), {});
  }
  const JoinedBodies& bodies = scene.joined[joined];
  ContactBody placed;
  placed.vehicle = &bodies.vehicle;
  placed.pose = scene.actors[bodies.members.front()].motion.pose_at(time_s);
  return placed;
}

std::size_t first_of(const Scene& scene, std::size_t actor) {
  const std::size_t joined = scene.joined_of[actor];
  return joined == Scene::alone ? actor : scene.joined[joined].members.front();
}

/// Fixed bodies whose boxes the ego may reach while it is pressed, by actor.
void find_group(const Scene& scene, const EgoAtContact& ego, const Contact& contact,
                View<const std::size_t> met, FixedGroup& group) {
  constexpr double seconds = 0.3;
  const double reach =
      2.0 * scene.ego.radius_m + seconds * contact.closing_speed_mps + scene.impact.tolerance_m;
  const std::size_t own = first_of(scene, contact.actor);
  for (std::size_t i = 0; i < scene.actors.size() && group.bodies.size() < group.most; ++i) {
    const Body& body = scene.actors[i];
    if (body.vehicle.movable()) continue;
    const std::size_t first = first_of(scene, i);
    if (first == own || std::find(met.begin(), met.end(), first) != met.end()) continue;
    if (std::find(group.actors.begin(), group.actors.end(), first) != group.actors.end()) continue;
    const Pose pose = body.motion.pose_at(contact.time_of_impact_s);
    // Distance to the body's box along its own axes.
    const Vector3d from =
        pose.rotation.transpose() * (ego.pose.translation - pose.translation) - body.center_m;
    const Vector3d half = body.half_axes_m.cwiseAbs().rowwise().sum();
    const Vector3d beside = (from.cwiseAbs() - half).cwiseMax(0.0);
    if (beside.head<2>().norm() > reach) continue;
    group.bodies.push_back(fixed_body(scene, first, contact.time_of_impact_s));
    group.actors.push_back(first);
  }
}

}  // namespace

CrashSetup set_up_crash(const Scene& scene, const EgoAtContact& ego, const Contact& contact,
                        View<const std::size_t> met, FixedGroup& group) {
  const Body& other = scene.actors[contact.actor];
  group.bodies.clear();
  group.actors.clear();
  CrashSetup crash;
  crash.a = contact_body(scene.ego, ego.pose, ego.left);
  if (other.vehicle.movable()) {
    Pose pose;
    Velocity velocity;
    other.motion.state_at(contact.time_of_impact_s, pose, velocity);
    crash.b = contact_body(other, pose, velocity);
  } else {
    find_group(scene, ego, contact, met, group);
    crash.b = fixed_body(scene, contact.actor, contact.time_of_impact_s);
    crash.fixed = {group.bodies.data(), group.bodies.size()};
  }
  return crash;
}

void add_met(const Scene& scene, std::size_t actor, std::vector<std::size_t>& met) {
  const std::size_t joined = scene.joined_of[actor];
  if (joined == Scene::alone) {
    met.push_back(actor);
    return;
  }
  const std::vector<std::size_t>& members = scene.joined[joined].members;
  met.insert(met.end(), members.begin(), members.end());
}

RigidState rigid_state(const ContactBody& body) {
  RigidState state;
  const Vehicle& v = *body.vehicle;
  state.mass_kg = v.mass_kg;
  state.inertia_kgm2 = v.yaw_inertia_kgm2;
  state.center_m = body.pose.rotation * v.center_m + body.pose.translation;
  if (!v.movable()) return state;
  // As the simulation has it: in the plane.
  const Vector3d arm = state.center_m - body.pose.translation;
  state.spin_radps = body.velocity.angular_radps.z();
  state.velocity_mps = body.velocity.linear_mps + state.spin_radps * Vector3d(-arm.y(), arm.x(), 0);
  return state;
}

ContactVariant variant_of(const HarmSample& sample) {
  // What friction is stated for is the pair of painted panels; the others scale with it.
  const double panels = friction_between(Surface::sheet_metal, Surface::sheet_metal);
  return {sample.friction / panels, sample.strength, 1.0};
}

ContactOptions options_of(const HarmSample& sample) {
  ContactOptions options;
  options.travel_m *= sample.step;
  options.shortest_s *= sample.step;
  options.longest_s *= sample.step;
  options.speed_change *= sample.step;
  return options;
}

CrashSetup shifted(const CrashSetup& crash, const Contact& contact, const HarmSample& sample) {
  CrashSetup moved = crash;
  const Vector3d across(-contact.closing.y(), contact.closing.x(), 0.0);
  const double speed = across.norm();
  if (speed > 0.0) moved.a.pose.translation += (sample.shift_m / speed) * across;
  return moved;
}

EgoAfterContact after_contact(const CrashSetup& crash, const ContactOutcome& outcome) {
  EgoAfterContact after;
  const RigidState before = rigid_state(crash.a);
  after.velocity.linear_mps = before.velocity_mps;
  after.velocity.angular_radps = crash.a.velocity.angular_radps;
  if (!outcome.acts) return after;
  after.duration_s = outcome.duration_s;
  after.moved_m = outcome.a.moved_m;
  after.turned_rad = outcome.a.turned_rad;
  after.velocity.linear_mps += outcome.a.delta_v_mps;
  after.velocity.angular_radps.z() += outcome.a.delta_yaw_rate_radps;
  return after;
}

void add_pressed(const Scene& scene, const ContactWorkspace::State& state, const FixedGroup& group,
                 std::vector<std::size_t>& met) {
  // The first pair is that of the contact itself.
  for (std::size_t k = 0; k < group.actors.size() && k + 1 < state.pairs_in_use; ++k) {
    if (state.pairs[k + 1].pressed) add_met(scene, group.actors[k], met);
  }
}

}  // namespace crashrank::detail

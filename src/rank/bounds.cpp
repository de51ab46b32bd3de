#include "rank/bounds.hpp"

#include "crash/scene_run.hpp"
#include "rank/crash_score.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;

/// Widens every bound by far more than the rounding errors of sums and roots.
constexpr double slack = 1.0 + 1e-9;

double surface_area_m2(const TriangleMesh& mesh) {
  double area = 0.0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const Triangle t = mesh.triangle(i);
    const Vector3d a = t.corner[0].cast<double>();
    area += 0.5 * (t.corner[1].cast<double>() - a).cross(t.corner[2].cast<double>() - a).norm();
  }
  return area;
}

/// Upper bound on the kinetic energy of a body that follows its plan, J. Covers the horizon and the
/// longest simulation after it, since a body can be hit after the end of its plan.
double max_energy_j(const Scene& scene, const Body& body, const Motion& motion) {
  if (!std::isfinite(body.mass_kg)) return 0.0;
  const MotionBound bound = motion.bound(0.0, scene.slice_s.back() + SceneOptions{}.longest_s);
  // A body that is touched lightly goes on with the accelerations of its plan.
  const double speed = slack * (bound.speed_mps + bound.angular_radps * body.radius_m +
                                2.0 * SceneOptions{}.plan_ends_mps);
  const double spin = bound.angular_radps;
  return slack * 0.5 *
         (body.mass_kg * speed * speed + body.vehicle->yaw_inertia_kgm2 * spin * spin);
}

/// Upper bound on the harm to the people in or on a body, without property: their weight, at a risk
/// of 1.
double max_people_weight(const Scene& scene, std::size_t index) {
  const Body& body = body_of(scene, index);
  HarmExposure own;
  own.kind = body.vehicle->kind;
  own.ego = index == ego_body;
  own.occupants = body.occupants;
  return people_weight(own, scene.harm.weights);
}

}  // namespace

void ScoreBounds::prepare(const Scene& scene) {
  actor_energy_j_.resize(scene.actors.size());
  limit(scene);
}

void ScoreBounds::limit(const Scene& scene) {
  limits_ = {};
  limits_.ego_mass_kg = scene.ego.mass_kg;
  // Those of the simulation and a first contact without force.
  limits_.contacts = static_cast<double>(SceneRun::most_contacts + 1);
  max_energy_ratio_ = 1.0;
  add(scene, ego_body);
  for (std::size_t i = 0; i < scene.actors.size(); ++i) {
    if (scene.futures.exists(i)) add(scene, i);
  }
  update(scene);
}

void ScoreBounds::add(const Scene& scene, std::size_t index) {
  const Body& body = body_of(scene, index);
  limits_.people += max_people_weight(scene, index);
  limits_.triangles += static_cast<double>(body.model->mesh.size());
  if (scene.measure == Measure::area) limits_.area_m2 += surface_area_m2(body.model->mesh);
  limits_.intrusion_m = std::max(limits_.intrusion_m, max_intrusion_m(*body.vehicle));
  if (!std::isfinite(body.mass_kg)) return;
  // The energy about a point at distance `arm` from the centre of mass grows by m·arm² / I at most.
  const double arm = 2.0 * body.radius_m;
  max_energy_ratio_ =
      std::max(max_energy_ratio_, 1.0 + body.mass_kg * arm * arm / body.vehicle->yaw_inertia_kgm2);
}

void ScoreBounds::update(const Scene& scene) {
  std::fill(actor_energy_j_.begin(), actor_energy_j_.end(), 0.0);
  for (const Plan& plan : scene.futures.plans) {
    if (!scene.futures.exists(plan.actor)) continue;
    double& max_j = actor_energy_j_[plan.actor];
    max_j = std::max(max_j, max_energy_j(scene, scene.actors[plan.actor], plan.motion));
  }
  energy_sum_j_ = 0.0;
  for (const double max_j : actor_energy_j_) energy_sum_j_ += max_j;
}

double ScoreBounds::upper_bound(const Scene& scene, const Motion& ego) const {
  CrashLimits limits = limits_;
  limits.energy_j = slack * (energy_sum_j_ + max_energy_j(scene, scene.ego, ego));
  // The closing energy of a contact, rotation included, is at most twice the total energy.
  limits.closing_energy_j = 2.0 * max_energy_ratio_ * limits.energy_j;
  return slack * measure_row(scene.measure).upper_bound(limits, scene.harm.weights);
}

double ScoreBounds::upper_bound_displaced(const Scene& scene, const Motion& ego,
                                          Motion& displaced) const {
  double bound = upper_bound(scene, ego);
  if (!scene.futures.displaces_ego()) return bound;
  // Energy does not depend on position and heading, and the largest speed occurs at one end of the
  // interval of speed errors.
  for (const double error : scene.futures.ego_speed_errors()) {
    displaced = ego;
    displaced.displace({0.0, 0.0, 0.0, error});
    bound = std::max(bound, upper_bound(scene, displaced));
  }
  return bound;
}

}  // namespace crashrank::detail

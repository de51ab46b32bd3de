#include "rank/bounds.hpp"

#include "crash/scene_run.hpp"
#include "rank/tally.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;

/// Sums and roots round; bounds are widened by far more than that.
constexpr double slack = 1.0 + 1e-9;

double surface_of(const TriangleMesh& mesh) {
  double area = 0.0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const Triangle t = mesh.triangle(i);
    const Vector3d a = t.corner[0].cast<double>();
    area += 0.5 * (t.corner[1].cast<double>() - a).cross(t.corner[2].cast<double>() - a).norm();
  }
  return area;
}

/// Energy that a body on its plan never exceeds. A plan ends with the horizon, and what is touched
/// later is followed for as long as a scene lasts.
double most_energy(const Scene& scene, const Body& body, const Motion& motion) {
  if (!std::isfinite(body.mass_kg)) return 0.0;
  const MotionBound bound = motion.bound(0.0, scene.slice_s.back() + SceneOptions{}.longest_s);
  const double speed = slack * (bound.speed_mps + bound.angular_radps * body.radius_m);
  const double spin = bound.angular_radps;
  return slack * 0.5 * (body.mass_kg * speed * speed + body.vehicle.yaw_inertia_kgm2 * spin * spin);
}

/// Harm to those on a body, property apart, whatever hits it.
double surely(const Scene& scene, std::size_t index) {
  const Body& body = body_of(scene, index);
  HarmExposure own;
  own.kind = body.vehicle.kind;
  own.ego = index == ego_body;
  own.occupants = body.occupants;
  return people_weight(own, scene.harm.weights);
}

}  // namespace

void ScoreBounds::prepare(const Scene& scene) {
  utmost_ = {};
  utmost_.ego_mass_kg = scene.ego.mass_kg;
  utmost_.contacts = static_cast<double>(SceneRun::most_contacts);
  most_ratio_ = 1.0;
  add(scene, ego_body);
  for (std::size_t i = 0; i < scene.actors.size(); ++i) add(scene, i);
  energy_j_.resize(scene.actors.size());
  update(scene);
}

void ScoreBounds::add(const Scene& scene, std::size_t index) {
  const Body& body = body_of(scene, index);
  utmost_.people += surely(scene, index);
  utmost_.triangles += static_cast<double>(body.model->mesh.size());
  if (scene.measure == Measure::area) utmost_.area_m2 += surface_of(body.model->mesh);
  utmost_.intrusion_m = std::max(utmost_.intrusion_m, most_intrusion_m(body.vehicle));
  if (!std::isfinite(body.mass_kg)) return;
  // Energy about a point as far from its centre of mass as it reaches.
  const double arm = 2.0 * body.radius_m;
  most_ratio_ =
      std::max(most_ratio_, 1.0 + body.mass_kg * arm * arm / body.vehicle.yaw_inertia_kgm2);
}

void ScoreBounds::update(const Scene& scene) {
  std::fill(energy_j_.begin(), energy_j_.end(), 0.0);
  for (const Plan& plan : scene.futures.plans) {
    double& most_j = energy_j_[plan.actor];
    most_j = std::max(most_j, most_energy(scene, scene.actors[plan.actor], plan.motion));
  }
  energy_sum_j_ = 0.0;
  for (const double most_j : energy_j_) energy_sum_j_ += most_j;
}

double ScoreBounds::most(const Scene& scene, const Motion& ego) const {
  Utmost utmost = utmost_;
  utmost.energy_j = slack * (energy_sum_j_ + most_energy(scene, scene.ego, ego));
  // A contact's energy, with its share of turning, is no larger than twice all there is.
  utmost.closing_energy_j = 2.0 * most_ratio_ * utmost.energy_j;
  return slack * measure_row(scene.measure).most(utmost, scene.harm.weights);
}

double ScoreBounds::most_displaced(const Scene& scene, const Motion& ego, Motion& room) const {
  double most_score = most(scene, ego);
  if (!scene.futures.displaces_ego()) return most_score;
  // Energy does not depend on place and heading, and no speed between the two is further from 0.
  for (const double error : scene.futures.ego_speed_errors()) {
    room = ego;
    room.displace({0.0, 0.0, 0.0, error});
    most_score = std::max(most_score, most(scene, room));
  }
  return most_score;
}

}  // namespace crashrank::detail

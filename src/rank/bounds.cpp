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
  people_ = surely(scene, ego_body);
  triangles_ = static_cast<double>(scene.ego.model->mesh.size());
  const bool by_area = scene.measure == Measure::area;
  area_m2_ = by_area ? surface_of(scene.ego.model->mesh) : 0.0;
  intrusion_m_ = most_intrusion_m(scene.ego.vehicle);
  for (std::size_t i = 0; i < scene.actors.size(); ++i) {
    const Body& actor = scene.actors[i];
    people_ += surely(scene, i);
    triangles_ += static_cast<double>(actor.model->mesh.size());
    if (by_area) area_m2_ += surface_of(actor.model->mesh);
    intrusion_m_ = std::max(intrusion_m_, most_intrusion_m(actor.vehicle));
  }
  update(scene);
}

void ScoreBounds::update(const Scene& scene) {
  energy_sum_j_ = 0.0;
  for (const Body& actor : scene.actors) energy_sum_j_ += most_energy(scene, actor, actor.motion);
}

double ScoreBounds::most(const Scene& scene, const Motion& ego) const {
  // All energy there is; a contact's, with its share of turning, is no larger than twice it, and a
  // body that has all of it is no faster than this.
  const double energy_j = slack * (energy_sum_j_ + most_energy(scene, scene.ego, ego));
  constexpr auto contacts = static_cast<double>(SceneRun::most_contacts);
  switch (scene.measure) {
    case Measure::polygons:
      return triangles_;
    case Measure::area:
      return slack * area_m2_;
    case Measure::closing_energy: {
      // Of both bodies' energy about a point as far from their centres of mass as they reach.
      double most_ratio = 1.0;
      const auto ratio = [](const Body& body) {
        const double arm = 2.0 * body.radius_m;
        return std::isfinite(body.mass_kg)
                   ? 1.0 + body.mass_kg * arm * arm / body.vehicle.yaw_inertia_kgm2
                   : 1.0;
      };
      for (const Body& actor : scene.actors) most_ratio = std::max(most_ratio, ratio(actor));
      most_ratio = std::max(most_ratio, ratio(scene.ego));
      return slack * contacts * 2.0 * most_ratio * energy_j;
    }
    case Measure::intrusion:
      return slack * contacts * 2.0 * intrusion_m_;
    case Measure::energy:
      return energy_j;
    case Measure::delta_v:
      return slack * contacts * 2.0 * std::sqrt(2.0 * energy_j / scene.ego.mass_kg);
    case Measure::harm:
      break;
  }
  return slack * (people_ + scene.harm.weights.property_per_mj * 1e-6 * energy_j);
}

}  // namespace crashrank::detail

#include "rank/bounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

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

/// Speed that no point of the body exceeds until the horizon.
double top_speed(const Scene& scene, const Body& body, const Motion& motion) {
  const MotionBound bound = motion.bound(0.0, scene.slice_s.back());
  return slack * (bound.speed_mps + bound.angular_radps * body.radius_m);
}

double most_energy(const Scene& scene, const Body& body, const Motion& motion) {
  if (!std::isfinite(body.mass_kg)) return 0.0;
  const double speed = top_speed(scene, body, motion);
  const double spin = motion.bound(0.0, scene.slice_s.back()).angular_radps;
  return slack * 0.5 * (body.mass_kg * speed * speed + body.vehicle.yaw_inertia_kgm2 * spin * spin);
}

/// Risk is 1 at most, and at such a speed it is.
constexpr double surely_mps = 1e3;

/// Harm to those on another body, property apart, whatever hits it.
double surely(const Scene& scene, const Body& body) {
  HarmExposure worst;
  worst.kind = body.vehicle.kind;
  worst.occupants = body.occupants;
  worst.delta_v_mps = surely_mps;
  worst.closing_speed_mps = surely_mps;
  return most_harm(worst, scene.harm);
}

double property(const Scene& scene, double energy_j) {
  return scene.harm.weights.property_per_mj * energy_j * 1e-6;
}

double inverse_kg(const RigidState& a, const RigidState& b) {
  return (a.movable() ? 1.0 / a.mass_kg : 0.0) + (b.movable() ? 1.0 / b.mass_kg : 0.0);
}

double turning_j(const RigidState& body) {
  return body.movable() ? body.inertia_kgm2 * body.spin_radps * body.spin_radps : 0.0;
}

PendingContact pending_of(const CrashSetup& crash, const Contact& contact, Range impulse_ns,
                          Range dissipated_j) {
  PendingContact pending;
  pending.actor = contact.actor;
  pending.begin_s = contact.time_of_impact_s;
  pending.closing_mps = contact.closing_speed_mps;
  pending.ego_road_mps = crash.a.velocity.linear_mps.norm();
  pending.other_road_mps = crash.b.velocity.linear_mps.norm();
  const auto delta_v = [&](const ContactBody& body) -> Range {
    if (!body.vehicle->movable()) return {};
    const double mass = body.vehicle->mass_kg;
    return {std::max(0.0, impulse_ns.least / mass / slack), slack * impulse_ns.most / mass};
  };
  pending.ego_delta_v_mps = delta_v(crash.a);
  pending.other_delta_v_mps = delta_v(crash.b);
  pending.dissipated_j = dissipated_j;
  return pending;
}

}  // namespace

void ScoreBounds::prepare(const Scene& scene) {
  const std::size_t count = scene.actors.size();
  term_.assign(count, 0.0);
  energy_.assign(count, 0.0);
  surface_m2_.assign(count, 0.0);
  order_.resize(count);
  ego_surface_m2_ = surface_of(scene.ego.model->mesh);
  HarmExposure own;
  own.kind = scene.ego.vehicle.kind;
  own.ego = true;
  own.occupants = scene.ego.occupants;
  Person person = Person::occupant;
  ego_people_ = scene.measure == Measure::harm && carries_people(own.kind, person)
                    ? people_weight(own, scene.harm.weights)
                    : 0.0;
  triangles_ = static_cast<double>(scene.ego.model->mesh.size());
  area_m2_ = ego_surface_m2_;
  for (std::size_t i = 0; i < count; ++i) {
    surface_m2_[i] = surface_of(scene.actors[i].model->mesh);
    area_m2_ += surface_m2_[i];
    triangles_ += static_cast<double>(scene.actors[i].model->mesh.size());
    term_[i] = surely(scene, scene.actors[i]);
  }
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::sort(order_.begin(), order_.end(), [&](std::size_t p, std::size_t q) {
    return term_[p] != term_[q] ? term_[p] > term_[q] : p < q;
  });
  update(scene);
}

void ScoreBounds::update(const Scene& scene) {
  energy_sum_j_ = 0.0;
  for (std::size_t i = 0; i < scene.actors.size(); ++i) {
    energy_[i] = most_energy(scene, scene.actors[i], scene.actors[i].motion);
    energy_sum_j_ += energy_[i];
  }
}

double ScoreBounds::energy_j(const Scene& scene, const Motion& ego) const {
  return slack * (energy_sum_j_ + most_energy(scene, scene.ego, ego));
}

double ScoreBounds::most(const Scene& scene, const Motion& ego) const {
  switch (scene.measure) {
    case Measure::polygons:
      return triangles_;
    case Measure::area:
      return slack * area_m2_;
    case Measure::closing_energy: {
      double score = 0.0;
      for (const Body& body : scene.actors) {
        // The point of contact may lie as far from either origin as both bodies reach.
        const double speed = top_speed(scene, scene.ego, ego) + top_speed(scene, body, body.motion);
        const double reduced = std::isinf(body.mass_kg) ? scene.ego.mass_kg
                                                        : scene.ego.mass_kg * body.mass_kg /
                                                              (scene.ego.mass_kg + body.mass_kg);
        score += 1.002 * 0.5 * reduced * speed * speed;
      }
      return score;
    }
    case Measure::intrusion: {
      double score = 0.0;
      for (const Body& body : scene.actors) score += 2.0 * (body.radius_m + scene.ego.radius_m);
      return score;
    }
    case Measure::delta_v:
    case Measure::energy:
    case Measure::harm:
      break;
  }
  return slack * whole(most_after(scene, ego, {},
                                  std::max<std::size_t>(scene.harm.after.most_contacts, 1)));
}

double ScoreBounds::most_with_first(const Scene& scene, const Motion& ego,
                                    const std::vector<std::size_t>& first) const {
  const double all = most(scene, ego);
  if (scene.measure != Measure::harm) return all;
  const std::size_t rest_contacts = std::max<std::size_t>(scene.harm.after.most_contacts, 1) - 1;
  double best = 0.0;
  for (const std::size_t actor : first) {
    const Later rest = most_after(scene, ego, {&actor, 1}, rest_contacts);
    best = std::max(best, slack * (term_[actor] + rest.most + ego_people_) +
                              property(scene, energy_j(scene, ego)));
  }
  return std::min(all, best);
}

Later ScoreBounds::most_after(const Scene& scene, const Motion& ego, View<const std::size_t> met,
                              std::size_t left) const {
  const double energy = energy_j(scene, ego);
  const std::size_t actors = term_.size() - std::min(term_.size(), met.size());
  left = std::min(left, actors);
  if (left == 0) return {};
  switch (scene.measure) {
    case Measure::energy:
      // What is dissipated is nowhere gained again, and every body is met once.
      return {true, energy, endless_v};
    case Measure::delta_v:
      // All energy in the ego's speed, before the crash and after it.
      return {true,
              static_cast<double>(left) * slack * 2.0 * std::sqrt(2.0 * energy / scene.ego.mass_kg),
              endless_v};
    default:
      break;
  }
  double sum = 0.0;
  for (const std::size_t actor : order_) {
    if (left == 0) break;
    if (std::find(met.begin(), met.end(), actor) != met.end()) continue;
    sum += term_[actor];
    --left;
  }
  return {true, slack * (sum + property(scene, energy)), endless_v};
}

PendingContact pending_at_contact(const CrashSetup& crash, const Contact& contact) {
  const RigidState a = rigid_state(crash.a);
  const RigidState b = rigid_state(crash.b);
  const double inverse = inverse_kg(a, b);
  if (!(inverse > 0.0)) return pending_of(crash, contact, {}, {});
  const double speed = (a.velocity_mps - b.velocity_mps).head<2>().norm();
  const double turning = turning_j(a) + turning_j(b);
  const double most_ns = slack * (speed + std::sqrt(speed * speed + turning * inverse)) / inverse;
  const double most_j = slack * 0.5 * (speed * speed / inverse + turning);
  return pending_of(crash, contact, {0.0, most_ns}, {0.0, most_j});
}

PendingContact pending_in_run(const CrashSetup& crash, const Contact& contact,
                              const ContactRun& run) {
  const double so_far = run.impulse_ns().norm();
  const double left = run.most_left_ns();
  const double rounding = run.rounding_ns();
  const double least = std::max(0.0, std::max(so_far - left, run.least_whole_ns()) - rounding);
  const double most = std::min(so_far + left, run.most_whole_ns()) + rounding;
  return pending_of(crash, contact, {least, most},
                    {run.least_whole_j() / slack, slack * run.most_whole_j()});
}

}  // namespace crashrank::detail

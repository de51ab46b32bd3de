#include "rank/anytime/estimate.hpp"

#include "rank/crash_chain.hpp"
#include "rank/measure_table.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

/// Speed at which the energy of a first contact, ½·m·v² with the mass of the ego, is estimated to
/// harm the people in one of the two bodies with certainty, m/s. A light first contact leaves most
/// of the speed for later ones. This value and the energy shares below are design choices: with the
/// energy along the normal alone the first choices were worse (Estimate tests); with all of the
/// closing energy a scrape ranked behind a collision with a person.
constexpr double one_person_mps = 30.0;

/// Fraction of the closing velocity that a body takes on from another.
double share_of(double own_kg, double other_kg) {
  if (std::isinf(own_kg)) return 0.0;
  return std::isinf(other_kg) ? 1.0 : other_kg / (own_kg + other_kg);
}

/// Weight of the people in or on a body.
double people_weight_of(const Scene& scene, std::size_t body) {
  return people_weight(exposure_of(scene, body, nullptr), scene.harm.weights);
}

/// Adds a body whose velocity changes at once.
void add_change(const Scene& scene, std::size_t index, const Motion& motion, double time_s,
                const Eigen::Vector3d& delta_v_mps, const Body& striker, CrashEffects& effects) {
  Pose pose;
  Velocity velocity;
  motion.state_at(time_s, pose, velocity);
  ExposureCell cell;
  cell.forward_x = static_cast<float>(pose.rotation(0, 0));
  cell.forward_y = static_cast<float>(pose.rotation(1, 0));
  cell.road_mps = static_cast<float>(velocity.linear_mps.norm());
  cell.action.dvx_mps = delta_v_mps.x();
  cell.action.dvy_mps = delta_v_mps.y();
  cell.action.path_mps = delta_v_mps.head<2>().norm();
  cell.action.light_mps = cell.action.path_mps * body_of(scene, index).mass_kg /
                          std::max(striker.mass_kg, striking_car_kg);
  cell.action.edge_m2ps = cell.action.path_mps * striker.vehicle.leading_edge_m;
  const bool moves = std::isfinite(body_of(scene, index).mass_kg) && cell.action.path_mps > 0.0;
  effects.add(index, {&cell, moves ? std::size_t{1} : std::size_t{0}});
}

/// Part of the closing velocity that the two bodies lose: the component along the normal, and as
/// much of the tangential one as friction stops. Without a normal one body is inside the other, and
/// all is lost.
Eigen::Vector3d stopped_part(const Contact& first, double friction) {
  const double normal_mps = first.closing.dot(first.normal);
  if (!(normal_mps > 0.0)) return first.closing;
  const Eigen::Vector3d along = normal_mps * first.normal;
  const Eigen::Vector3d tangential = first.closing - along;
  const double slip_mps = tangential.norm();
  const double friction_limit_mps = friction * normal_mps;
  return slip_mps > friction_limit_mps
             ? Eigen::Vector3d(along + (friction_limit_mps / slip_mps) * tangential)
             : first.closing;
}

}  // namespace

double estimate_score(const Scene& scene, const Motion& ego, const Motion& other,
                      const Contact& first, CrashEffects& effects, CrashScore& scorer) {
  const double own_kg = scene.ego.mass_kg;
  const double other_kg = scene.actors[first.actor].mass_kg;
  const Eigen::Vector3d stopped = stopped_part(first, scene.nominal.friction);
  ContactEffect effect;
  effect.dissipated_j = closing_energy_j(own_kg, other_kg, stopped.norm());
  effect.closing_energy_j = first.closing_energy_j;
  effects.clear();
  effects.contacts.push_back(effect);
  add_change(scene, ego_body, ego, first.time_of_impact_s, -share_of(own_kg, other_kg) * stopped,
             scene.actors[first.actor], effects);
  add_change(scene, first.actor, other, first.time_of_impact_s,
             share_of(other_kg, own_kg) * stopped, scene.ego, effects);
  const double score = scorer.score(scene, effects, scene.nominal);
  if (!measure_row(scene.measure).counts_people) return score;
  // Half of the stopped energy plus a quarter of all closing energy: a body that glances off can
  // collide again.
  const double energy_j = 0.5 * effect.dissipated_j + 0.25 * first.closing_energy_j;
  const double one_person_j = 0.5 * own_kg * one_person_mps * one_person_mps;
  const double people =
      std::max(people_weight_of(scene, ego_body), people_weight_of(scene, first.actor));
  return std::max(score, people * energy_j / one_person_j);
}

}  // namespace crashrank::detail

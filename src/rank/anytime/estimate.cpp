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
  return people_weight(exposure_of(scene, body, {}), scene.harm.weights);
}

SideEffect side_of(const Scene& scene, std::size_t body, const Motion& motion, double time_s,
                   const Eigen::Vector3d& delta_v_mps) {
  Pose pose;
  Velocity velocity;
  motion.state_at(time_s, pose, velocity);
  SideEffect side;
  side.body = body;
  side.delta_v_mps = delta_v_mps;
  if (const double mass_kg = body_of(scene, body).mass_kg; std::isfinite(mass_kg)) {
    side.impulse_ns = mass_kg * delta_v_mps;
  }
  side.forward = pose.rotation.col(0);
  side.road_mps = velocity.linear_mps.norm();
  return side;
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
                      const Contact& first, Tally& tally) {
  const double own_kg = scene.ego.mass_kg;
  const double other_kg = scene.actors[first.actor].mass_kg;
  const Eigen::Vector3d stopped = stopped_part(first, scene.nominal.friction);
  ContactEffect effect;
  effect.begin_s = effect.end_s = effect.mean_force_s = first.time_of_impact_s;
  effect.closing_mps = stopped.norm();
  effect.dissipated_j = closing_energy_j(own_kg, other_kg, effect.closing_mps);
  effect.closing_energy_j = first.closing_energy_j;
  effect.sides[0] =
      side_of(scene, ego_body, ego, first.time_of_impact_s, -share_of(own_kg, other_kg) * stopped);
  effect.sides[1] = side_of(scene, first.actor, other, first.time_of_impact_s,
                            share_of(other_kg, own_kg) * stopped);
  tally.begin();
  tally.add(scene, effect, scene.nominal);
  const double score = tally.score(scene);
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

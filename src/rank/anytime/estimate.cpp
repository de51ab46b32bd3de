#include "rank/anytime/estimate.hpp"

#include "rank/crash_chain.hpp"
#include "rank/measure_table.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

/// Half its square times the ego's mass is the energy of a first contact whose crash is taken to
/// harm at least the people in one of the two bodies, m/s: what a light first contact leaves of the
/// speed goes on to further ones. Together with the shares below a choice: with the normal's energy
/// alone first choices were worse (Estimate tests), with all of it a scrape came behind a person.
constexpr double one_person_mps = 30.0;

/// Share of the closing velocity that a body of this mass takes on from one of the other.
double share_of(double own_kg, double other_kg) {
  if (std::isinf(own_kg)) return 0.0;
  return std::isinf(other_kg) ? 1.0 : other_kg / (own_kg + other_kg);
}

/// The weighted people in or on a body.
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

/// How much of the closing velocity the two bodies lose against each other: all that is along the
/// normal, of the rest what friction takes. Without a normal one lies inside the other: all.
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
  effect.begin_s = effect.end_s = first.time_of_impact_s;
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
  // Half of what the normal stops, and a quarter of all: what glances off may catch later.
  const double energy_j = 0.5 * effect.dissipated_j + 0.25 * first.closing_energy_j;
  const double one_person_j = 0.5 * own_kg * one_person_mps * one_person_mps;
  const double people =
      std::max(people_weight_of(scene, ego_body), people_weight_of(scene, first.actor));
  return std::max(score, people * energy_j / one_person_j);
}

}  // namespace crashrank::detail

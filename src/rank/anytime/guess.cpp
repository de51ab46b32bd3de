#include "rank/anytime/guess.hpp"

#include "rank/measure_table.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

/// Half its square times the ego's mass is the closing energy of a first contact whose crash is
/// taken for the harm of at least one person, m/s: what a light first contact leaves of the speed
/// goes on to further ones. A choice: of none, 1, 1.5 and 2 persons the one with the least regret
/// over the shipped scenes (bench/rank).
constexpr double one_person_mps = 30.0;

/// Share of the closing velocity that a body of this mass takes on from one of the other.
double share_of(double own_kg, double other_kg) {
  if (std::isinf(own_kg)) return 0.0;
  return std::isinf(other_kg) ? 1.0 : other_kg / (own_kg + other_kg);
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

}  // namespace

double guess_score(const Scene& scene, const Motion& ego, const Motion& other, const Contact& first,
                   Tally& room) {
  const double own_kg = scene.ego.mass_kg;
  const double other_kg = scene.actors[first.actor].mass_kg;
  ContactEffect effect;
  effect.begin_s = effect.end_s = first.time_of_impact_s;
  effect.closing_mps = first.closing_speed_mps;
  effect.dissipated_j = effect.closing_energy_j = first.closing_energy_j;
  effect.sides[0] = side_of(scene, ego_body, ego, first.time_of_impact_s,
                            -share_of(own_kg, other_kg) * first.closing);
  effect.sides[1] = side_of(scene, first.actor, other, first.time_of_impact_s,
                            share_of(other_kg, own_kg) * first.closing);
  room.begin();
  room.add(scene, effect, scene.plain);
  const double score = room.score(scene);
  if (!measure_row(scene.measure).counts_people) return score;
  const double utmost_j = 0.5 * own_kg * one_person_mps * one_person_mps;
  return std::max(score, first.closing_energy_j / utmost_j);
}

}  // namespace crashrank::detail

#include "rank/reach.hpp"

#include "crash/contact_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;

/// Sums and roots round; bounds are widened by far more than that.
constexpr double speed_slack = 1.0 + 1e-9;
constexpr double endless = std::numeric_limits<double>::infinity();

double reduced_kg(double ego_kg, double other_kg) {
  return std::isinf(other_kg) ? ego_kg : ego_kg * other_kg / (ego_kg + other_kg);
}

/// No point of the ego is further from its centre of mass.
double radius_about_mass(const Body& ego) {
  return (ego.center_m - ego.vehicle.center_m).norm() + ego.half_axes_m.norm();
}

/// How an actor moves at most until the horizon, and what that means to the ego.
struct Other {
  double speed_mps = 0.0;  ///< of any of its points
  double angular_radps = 0.0;
  double turning_j2 = 0.0;
  double reduced_kg = 0.0;
};

Other other_of(const Scene& scene, const Body& actor) {
  const MotionBound bound = actor.motion.bound(0.0, scene.slice_s.back());
  Other other;
  other.speed_mps = speed_slack * (bound.speed_mps + bound.angular_radps * actor.radius_m);
  other.angular_radps = speed_slack * bound.angular_radps;
  if (std::isfinite(actor.mass_kg)) {
    other.turning_j2 =
        speed_slack * actor.vehicle.yaw_inertia_kgm2 * bound.angular_radps * bound.angular_radps;
  }
  other.reduced_kg = reduced_kg(scene.ego.mass_kg, actor.mass_kg);
  return other;
}

/// What one contact adds: to the score but for the ego's people, and to the ego's delta-v.
struct Term {
  double score = 0.0;
  double ego_delta_v_mps = 0.0;
};

/// What meeting it adds when the ego is no faster and turns no faster than that.
Term most_of_one(const Scene& scene, const Body& actor, const Other& other, double speed_mps,
                 double turning_j2) {
  const double relative = speed_mps + other.speed_mps;
  const double turning = turning_j2 + other.turning_j2;
  const double impulse = speed_slack * other.reduced_kg *
                         (relative + std::sqrt(relative * relative + turning / other.reduced_kg));
  const double ego_delta_v = speed_slack * impulse / scene.ego.mass_kg;
  switch (scene.measure) {
    case Measure::delta_v:
      return {ego_delta_v, ego_delta_v};
    case Measure::energy:
      return {speed_slack * 0.5 * (other.reduced_kg * relative * relative + turning), ego_delta_v};
    case Measure::harm:
      break;
    default:
      return {endless, endless};
  }
  // The point of contact is told by the ego's triangles, which may reach past the actor. While a
  // crash still goes on, the ego is met at a velocity between those of its start and its end, whose
  // centres of mass lie apart from its origin in different directions.
  const double ego_arm = radius_about_mass(scene.ego) + 2.0 * scene.ego.vehicle.center_m.norm();
  const double spin = std::sqrt(turning_j2 / scene.ego.vehicle.yaw_inertia_kgm2);
  HarmExposure hit;
  hit.kind = actor.vehicle.kind;
  hit.occupants = actor.occupants;
  hit.closing_speed_mps = speed_slack * (relative + spin * ego_arm +
                                         other.angular_radps * (actor.radius_m + 2.0 * ego_arm));
  hit.delta_v_mps = std::isfinite(actor.mass_kg) ? speed_slack * impulse / actor.mass_kg : 0.0;
  hit.road_speed_mps = other.speed_mps;
  hit.intrusion_m = most_intrusion_m(actor.vehicle);
  hit.crush_energy_j = speed_slack * 0.5 * (other.reduced_kg * relative * relative + turning);
  return {speed_slack * most_harm(hit, scene.harm), ego_delta_v};
}

/// A box that the ego stays in until `until_s`.
Box box_of(const Scene& scene, const Reach& reach, double until_s) {
  const double seconds = std::max(until_s - reach.from_s, 0.0);
  const Vector3d along = seconds * reach.common_mps;
  const double around = speed_slack * std::min(reach.around_mps * seconds, reach.furthest_m);
  // Between poses its origin moves straight while it turns: then its centre of mass is off by twice
  // their distance at most.
  const double body = radius_about_mass(scene.ego) + 2.0 * scene.ego.vehicle.center_m.norm();
  const double margin = scene.impact.tolerance_m +
                        1e-5 * (1.0 + body + reach.from_m.cwiseAbs().maxCoeff() + along.norm());
  constexpr float infinity_f = std::numeric_limits<float>::infinity();
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const double back = std::max(std::min(along[axis], 0.0) - around, -reach.furthest_m);
    const double ahead = std::min(std::max(along[axis], 0.0) + around, reach.furthest_m);
    const double room = body + margin;
    box.min[axis] =
        std::nextafter(static_cast<float>(reach.from_m[axis] + back - room), -infinity_f);
    box.max[axis] =
        std::nextafter(static_cast<float>(reach.from_m[axis] + ahead + room), infinity_f);
  }
  return box;
}

bool is_met(View<const std::size_t> met, std::size_t actor) {
  return std::find(met.begin(), met.end(), actor) != met.end();
}

}  // namespace

Reach reach_after(const Scene& scene, const Candidate& candidate, const CrashSetup& crash,
                  const Contact& contact) {
  const RigidState a = rigid_state(crash.a);
  const RigidState b = rigid_state(crash.b);
  const auto turning = [](const RigidState& body) {
    return body.movable() ? body.inertia_kgm2 * body.spin_radps * body.spin_radps : 0.0;
  };
  const double turning_j2 = turning(a) + turning(b);
  const double reduced = reduced_kg(a.mass_kg, b.mass_kg);
  const double share = reduced / a.mass_kg;
  const Vector3d closing = a.velocity_mps - b.velocity_mps;
  const double speed2 = closing.squaredNorm();
  Reach reach;
  reach.from_s = contact.time_of_impact_s;
  reach.from_m = a.center_m;
  reach.common_mps = a.velocity_mps - share * closing;
  reach.around_mps = speed_slack * share * std::sqrt(speed2 + turning_j2 / reduced);
  reach.energy_mps =
      speed_slack * (std::sqrt(a.velocity_mps.squaredNorm() + turning(a) / a.mass_kg) +
                     2.0 * b.velocity_mps.norm() + std::sqrt(turning(b) / a.mass_kg));
  reach.speed_mps =
      std::min(speed_slack * (reach.common_mps.norm() + reach.around_mps), reach.energy_mps);
  reach.turning_j2 = speed_slack * std::min(reduced * speed2 + turning_j2,
                                            a.mass_kg * reach.energy_mps * reach.energy_mps);
  reach.furthest_m = endless;
  const double deceleration =
      std::max(scene.harm.after.deceleration_mps2, -candidate.acceleration_mps2);
  if (deceleration > 0.0) {
    const double crash_s = longest_contact_s + 2.0 * ContactOptions{}.longest_s;
    reach.furthest_m = speed_slack * (reach.speed_mps * crash_s +
                                      0.5 * reach.speed_mps * reach.speed_mps / deceleration) +
                       1e-3;
  }
  return reach;
}

Later most_in_reach(const Scene& scene, const Reach& reach, View<const std::size_t> met,
                    std::size_t left, ReachMemory& memory, std::uint64_t& box_tests) {
  const std::size_t count = scene.actors.size();
  left = std::min(left, count - std::min(count, met.size()));
  if (left == 0) return {};
  memory.in_reach_from.assign(count, 0);
  Reach now = reach;
  double first_speed = now.speed_mps;
  double first_turning = now.turning_j2;
  for (std::size_t contact = 1;; ++contact) {
    bool more = false;
    for (std::size_t s = 0; s < scene.slices.size(); ++s) {
      if (scene.slice_s[s + 1] < now.from_s) continue;
      box_tests +=
          scene.slices[s].query(box_of(scene, now, scene.slice_s[s + 1]), [&](std::size_t i) {
            if (memory.in_reach_from[i] != 0 || is_met(met, i)) return;
            memory.in_reach_from[i] = static_cast<std::uint32_t>(contact);
            more = true;
          });
    }
    if (contact == 1 && !more) return {};
    if (contact == left) break;
    // What each of those can make of the ego.
    const double mass_kg = scene.ego.mass_kg;
    double speed = now.speed_mps;
    double turning = now.turning_j2;
    double energy = now.energy_mps;
    for (std::size_t i = 0; i < count; ++i) {
      if (memory.in_reach_from[i] == 0) continue;
      const Other other = other_of(scene, scene.actors[i]);
      const double relative = now.speed_mps + other.speed_mps;
      const double turns = now.turning_j2 + other.turning_j2;
      const double share = other.reduced_kg / mass_kg;
      const double left_mps =
          now.energy_mps + 2.0 * other.speed_mps + std::sqrt(other.turning_j2 / mass_kg);
      const double ball_mps =
          now.speed_mps + share * (2.0 * other.speed_mps + std::sqrt(turns / other.reduced_kg));
      energy = std::max(energy, left_mps);
      speed = std::max(speed, std::min(left_mps, ball_mps));
      turning = std::max(turning, std::min(other.reduced_kg * relative * relative + turns,
                                           mass_kg * left_mps * left_mps));
    }
    now.energy_mps = speed_slack * energy;
    now.common_mps.setZero();
    now.speed_mps = now.around_mps = speed_slack * speed;
    now.turning_j2 = speed_slack * turning;
    now.furthest_m = endless;
  }

  memory.last_term.assign(count, 0.0);
  double last_delta_v = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    if (memory.in_reach_from[i] == 0) continue;
    const Body& actor = scene.actors[i];
    const Term term =
        most_of_one(scene, actor, other_of(scene, actor), now.speed_mps, now.turning_j2);
    memory.last_term[i] = term.score;
    last_delta_v = std::max(last_delta_v, term.ego_delta_v_mps);
  }
  double first_delta_v = 0.0;
  double most = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    if (memory.in_reach_from[i] != 1) continue;
    const Body& actor = scene.actors[i];
    const Term first =
        most_of_one(scene, actor, other_of(scene, actor), first_speed, first_turning);
    first_delta_v = std::max(first_delta_v, first.ego_delta_v_mps);
    double sum = first.score;
    // And the largest of the others, as many as are left.
    double below = endless;
    std::size_t below_index = 0;
    for (std::size_t k = 1; k < left; ++k) {
      double largest = -1.0;
      std::size_t at = count;
      for (std::size_t j = 0; j < count; ++j) {
        if (j == i || memory.in_reach_from[j] == 0) continue;
        const double term = memory.last_term[j];
        const bool taken = term > below || (term == below && j <= below_index);
        if (!taken && term > largest) {
          largest = term;
          at = j;
        }
      }
      if (at == count) break;
      sum += largest;
      below = largest;
      below_index = at;
    }
    most = std::max(most, sum);
  }
  const double delta_v = first_delta_v + static_cast<double>(left - 1) * last_delta_v;
  return {true, speed_slack * most, speed_slack * delta_v};
}

}  // namespace crashrank::detail

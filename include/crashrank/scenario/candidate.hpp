#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/motion/motion.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace crashrank {

/// Largest ratio of what a manoeuvre requires to what the vehicle can do, until the first contact;
/// the mean over futures with different ones, by probability.
/// Above 1 the vehicle cannot follow it: the simulation is then not realistic.
struct ManoeuvreDemand {
  /// Horizontal acceleration of the centre of mass over grip times standard gravity, beside the
  /// road over the grip there.
  double grip = 0.0;
  double engine = 0.0;    ///< acceleration along its way over ScenarioEgo::max_acceleration_mps2
  double brakes = 0.0;    ///< deceleration along its way over what brakes and grip give
  double steering = 0.0;  ///< steering angle over ScenarioEgo::max_steering_rad
  double steering_rate = 0.0;  ///< its rate over ScenarioEgo::max_steering_rate_radps

  /// The greatest of them.
  double greatest() const noexcept {
    return std::max({grip, engine, brakes, steering, steering_rate});
  }
};

/// A demand up to this still counts as feasible for a manoeuvre of timed poses.
inline constexpr double feasible_posed_demand = 1.1;
/// And for all others: stated numbers are rounded, as 8 m/s² for a grip of 0.8.
inline constexpr double feasible_demand = 1.05;

/// Standard gravity, m/s².
inline constexpr double standard_gravity_mps2 = 9.80665;

/// Where a candidate comes from.
enum class CandidateOrigin {
  listed,         ///< written in the scenario
  added_braking,  ///< straight braking, added because it was not listed
  grid,           ///< generated
};

/// A manoeuvre that the ego can still choose.
struct Candidate {
  std::string name;  ///< unique within its scenario, the same in every run
  CandidateOrigin origin = CandidateOrigin::listed;  ///< where it comes from
  Motion motion;                                     ///< the ego's, if it is chosen
  /// What it asks for at time 0; 0 for timed poses. Left positive.
  double acceleration_mps2 = 0.0;
  double curvature_per_m = 0.0;  ///< of the path, 1/m
};

/// All candidates of a scenario in their order: listed, straight braking where it is missing, the
/// grid, the gentlest first: by u² + w², then harder braking, then further right.
/// `ego_length_m` stands in for an absent wheelbase (0.6 of it).
///
/// The grid covers what the grip allows: levels u, w in [-1, 1] become the longitudinal
/// acceleration u·A·sqrt(1 − w²/2) and the lateral one w·G·sqrt(1 − u²/2), the map of the square
/// onto the disc that keeps its axes, so that no two manoeuvres are alike and the corners are as
/// hard as the edges. The path's curvature is held and taken at the highest speed within the
/// horizon: at no time does a manoeuvre leave the grip circle. The curvature is limited by the
/// steering, too. Timed poses of listed candidates are checked. Errors: bad_input, naming the key.
CRASHRANK_API Result<std::vector<Candidate>> make_candidates(const Scenario& scenario,
                                                             double ego_length_m);

/// An actor's own motion. Errors: bad_input for poses that are out of order or not rigid.
CRASHRANK_API Result<Motion> make_motion(const ScenarioActor& actor);
/// A motion as a scenario writes it; `place` names it in errors.
CRASHRANK_API Result<Motion> make_motion(const ActorMotion& motion, const std::string& place);

}  // namespace crashrank

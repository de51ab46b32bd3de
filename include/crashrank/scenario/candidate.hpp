#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/motion/motion.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace crashrank {

/// Standard gravity, m/s².
inline constexpr double standard_gravity_mps2 = 9.80665;

/// Where a candidate comes from.
enum class CandidateOrigin {
  listed,         ///< written in the scenario
  added_braking,  ///< straight braking, added because nobody listed it
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

#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/motion/time_of_impact.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"

namespace crashrank::cli {

/// One of the two bodies of a crash test. It keeps its speed and heading until first contact.
struct CrashBody {
  ScenarioModel facts;
  Model model;
  Pose start;              ///< body to world at time 0
  double speed_mps = 0.0;  ///< along its forward axis
};

/// What `rank` computes of a crash test.
struct Crash {
  ImpactState state = ImpactState::none;  ///< how the bodies meet first
  bool acts = false;                      ///< they press on each other
  ContactSeverity severity;               ///< of the first contact with a force
};

/// Ranks a scenario of two bodies with one candidate: the ego drives straight on. First contact is
/// searched until `horizon_s`. Errors: as `rank`.
Result<Crash> rank_crash(const CrashBody& ego, const CrashBody& other, double horizon_s);

}  // namespace crashrank::cli

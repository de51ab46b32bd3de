#pragma once

#include "crashrank/rank/rank.hpp"
#include "rank/evaluate.hpp"

#include <limits>
#include <optional>

namespace crashrank::detail {

/// How far a candidate's plan is followed.
struct FollowedPlan {
  double longest_s = 0.0;  ///< to its first contact, in the future that has it last
  /// To its first contact in the likeliest future; infinity: none.
  double first_s = std::numeric_limits<double>::infinity();
  bool touches = false;  ///< somebody in a future
};

/// What is to be said of a candidate besides its crash.
struct ManoeuvreFacts {
  ManoeuvreDemand demand;
  bool feasible = true;
  std::optional<RoadLeaving> leaves_road;
  Clearance clearance;
  HorizonState at_horizon;
};

/// `leaving`: of its plan until the horizon. Depends on the scene and the candidate alone, unless
/// it is stopped where nobody is touched.
ManoeuvreFacts evaluate_manoeuvre(const Scene& scene, const Candidate& candidate,
                                  const FollowedPlan& followed,
                                  const std::optional<RoadLeaving>& leaving, Scratch& scratch);

/// Demand of a plan as far as `until_s`.
ManoeuvreDemand demand_until(const Scene& scene, const Candidate& candidate, double until_s,
                             const std::optional<RoadLeaving>& leaving) noexcept;

/// What leaving the road adds to the score of a future whose first contact is at `first_s`
/// (infinity: none).
double leaving_score(const Scene& scene, const std::optional<RoadLeaving>& leaving,
                     double first_s) noexcept;

/// What leaving the road adds to the score of any future at most; `leaving` is that of the plan.
double max_leaving_score(const Scene& scene, const std::optional<RoadLeaving>& leaving) noexcept;

}  // namespace crashrank::detail

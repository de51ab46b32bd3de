#pragma once

#include "crashrank/rank/rank.hpp"
#include "rank/evaluate.hpp"

#include <optional>

namespace crashrank::detail {

/// How far the plan of a candidate is followed: until its first contact or the horizon.
struct FollowedPlan {
  /// That time in each future, as `score`, with the probabilities of the futures.
  View<const WeightedScore> until_s;
  bool touches = false;  ///< it has a contact in at least one future
};

/// Results for a candidate that do not depend on its crash.
struct ManoeuvreFacts {
  ManoeuvreDemand demand;
  bool feasible = true;
  Clearance clearance;
  HorizonState at_horizon;
};

/// Evaluates demand, feasibility, clearances and the state at the horizon. `leaving` is that of the
/// plan until the horizon. Depends on the scene and the candidate alone. A candidate without
/// contact can be stopped; then the clearances must not be used.
ManoeuvreFacts evaluate_manoeuvre(const Scene& scene, const Candidate& candidate,
                                  const FollowedPlan& followed,
                                  const std::optional<RoadLeaving>& leaving, Scratch& scratch);

/// Demand of a plan as far as it is followed in each future, as the mean over the futures: what it
/// demands after a contact that nearly all futures have hardly counts.
ManoeuvreDemand expected_demand(const Scene& scene, const Candidate& candidate,
                                View<const WeightedScore> until_s,
                                const std::optional<RoadLeaving>& leaving) noexcept;

/// Demand of a plan until `until_s`.
ManoeuvreDemand demand_until(const Scene& scene, const Candidate& candidate, double until_s,
                             const std::optional<RoadLeaving>& leaving) noexcept;

/// Harm that leaving the road adds to the score of a future whose first contact is at `first_s`;
/// infinity: no contact.
double leaving_score(const Scene& scene, const std::optional<RoadLeaving>& leaving,
                     double first_s) noexcept;

/// Upper bound on `leaving_score` over all futures; `leaving` is that of the plan.
double max_leaving_score(const Scene& scene, const std::optional<RoadLeaving>& leaving) noexcept;

}  // namespace crashrank::detail

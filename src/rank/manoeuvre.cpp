#include "rank/manoeuvre.hpp"

#include "rank/measure_table.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {

ManoeuvreDemand demand_until(const Scene& scene, const Candidate& candidate, double until_s,
                             const std::optional<RoadLeaving>& leaving) noexcept {
  FollowedWay way;
  way.until_s = std::min(until_s, scene.slice_s.back());
  if (leaving) way.off_road_from_s = leaving->time_s;
  return demand_of(candidate, scene.limits, way);
}

ManoeuvreDemand expected_demand(const Scene& scene, const Candidate& candidate,
                                View<const WeightedScore> until_s,
                                const std::optional<RoadLeaving>& leaving) noexcept {
  ManoeuvreDemand mean;
  ManoeuvreDemand demand;
  double sum = 0.0;
  for (std::size_t f = 0; f < until_s.size(); ++f) {
    if (f == 0 || until_s[f].score != until_s[f - 1].score) {
      demand = demand_until(scene, candidate, until_s[f].score, leaving);
    }
    const double before = sum;
    sum += until_s[f].probability;
    if (!(sum > 0.0)) continue;
    // Of equal values the mean is that value.
    const double share = until_s[f].probability / sum;
    const auto add = [&](double value, double& to) {
      to = before > 0.0 ? to + share * (value - to) : value;
    };
    add(demand.grip, mean.grip);
    add(demand.engine, mean.engine);
    add(demand.brakes, mean.brakes);
    add(demand.steering, mean.steering);
    add(demand.steering_rate, mean.steering_rate);
  }
  return mean;
}

double leaving_score(const Scene& scene, const std::optional<RoadLeaving>& leaving,
                     double first_s) noexcept {
  const bool counts = leaving && measure_row(scene.measure).counts_people;
  return counts && leaving->time_s <= first_s ? scene.road.harm_per_leaving : 0.0;
}

double max_leaving_score(const Scene& scene, const std::optional<RoadLeaving>& leaving) noexcept {
  // If the ego is displaced, it can leave the road in a future even though its plan stays on it.
  const bool may_leave = leaving || (scene.futures.displaces_ego() && scene.road.ends());
  return may_leave ? leaving_score(scene, RoadLeaving{}, 0.0) : 0.0;
}

ManoeuvreFacts evaluate_manoeuvre(const Scene& scene, const Candidate& candidate,
                                  const FollowedPlan& followed,
                                  const std::optional<RoadLeaving>& leaving, Scratch& scratch) {
  ManoeuvreFacts facts;
  facts.demand = expected_demand(scene, candidate, followed.until_s, leaving);
  facts.feasible = is_feasible(candidate, facts.demand);
  facts.clearance = followed.touches
                        ? Clearance{.distance_m = 0.0, .time_gap_s = 0.0}
                        : clearance_of(scene, candidate.motion, scratch.ego_poses, scratch.stop);
  Pose pose;
  Velocity velocity;
  // Timed poses that end at the horizon are at rest from then on, so the speed is read just before.
  constexpr double just_before = 1.0 - 1e-9;
  candidate.motion.state_at(just_before * scene.slice_s.back(), pose, velocity);
  facts.at_horizon.speed_mps = velocity.linear_mps.norm();
  facts.at_horizon.heading_rad = std::atan2(pose.rotation(1, 0), pose.rotation(0, 0));
  facts.at_horizon.position_m = pose.translation.head<2>();
  return facts;
}

}  // namespace crashrank::detail

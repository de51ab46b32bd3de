#include "rank/anytime/refine_steps.hpp"
#include "rank/combine_futures.hpp"
#include "rank/ego_motion.hpp"
#include "rank/hits.hpp"
#include "rank/manoeuvre.hpp"
#include "rank/measure_table.hpp"
#include "rank/nearby_actors.hpp"
#include "rank/road_leaving.hpp"

#include <algorithm>

namespace crashrank::detail {
namespace {

/// Fills in demand, feasibility, clearances and the speed at the horizon. Returns false if time was
/// up.
bool fill_manoeuvre(const RefineQuery& q, const FollowedPlan& followed, CandidateState& state,
                    Scratch& scratch) {
  const ManoeuvreFacts facts =
      evaluate_manoeuvre(q.scene, q.candidate, followed, state.leaving, scratch);
  if (!followed.touches && scratch.stopped()) return false;
  RankedCandidate& result = state.result;
  result.feasible = facts.feasible || q.scene.infeasible == Infeasible::keep;
  result.least_distance_m = facts.clearance.distance_m;
  result.least_time_gap_s = facts.clearance.time_gap_s;
  result.time_to_collision_s = facts.clearance.time_to_collision_s;
  result.end_speed_mps = result.collides ? 0.0 : facts.at_horizon.speed_mps;
  state.demand_known = true;
  return true;
}

/// Returns true if an actor may come near the ego in any future.
bool comes_near(const RefineQuery& q, Scratch& scratch, RankWork& work) {
  const Futures& futures = q.scene.futures;
  for (std::size_t f = 0; f < futures.size(); f = futures.group(f).end) {
    const Motion& ego = ego_motion(q.scene, q.candidate, f, scratch.ego);
    find_nearby_actors(q.scene, ego, futures.group(f), 0.0, q.scene.slice_s.back(), scratch, work);
    // After the deadline the search may be incomplete: assume that an actor is near.
    if (!scratch.near.empty() || (f > 0 && q.deadline.expired())) return true;
  }
  return false;
}

/// Sets the scores of a candidate without contact in any future. Returns false if time was up.
bool settle_without_contact(const RefineQuery& q, CandidateState& state, Scratch& scratch) {
  const Futures& futures = q.scene.futures;
  if (!futures.displaces_ego()) {
    settle(state, leaving_score(q.scene, state.leaving, no_contact_s));
    return true;
  }
  for (std::size_t f = 0; f < futures.size(); ++f) {
    const Motion& ego = ego_motion(q.scene, q.candidate, f, scratch.ego);
    const std::optional<RoadLeaving> leaving = leaving_of(q, state, ego, scratch);
    if (scratch.stopped()) return false;
    state.futures[f].score = leaving_score(q.scene, leaving, no_contact_s);
    state.result.leaves_road = state.result.leaves_road || leaving.has_value();
  }
  combine(q, state, scratch);
  return true;
}

/// Estimate of the score in a future, without leaving the road; the upper bound under measures that
/// count triangles. Nothing if time was up.
std::optional<double> estimate_of(const RefineQuery& q, const CandidateState& state,
                                  const Motion& ego, std::size_t future, Scratch& scratch,
                                  RankWork& work) {
  if (scored_by_damage(q.scene.measure)) return state.upper_bound;
  const std::optional<double> estimate =
      scratch.boxes.score(q.scene, ego, future, scratch.stop, scratch.effects, scratch.score);
  work.box_tests += scratch.boxes.tests();
  return estimate;
}

/// Stores the hits of the last search that are the first contact of a future of the group, in their
/// order, and the estimates of their crashes. Returns false if time was up.
bool store_first_hits(const RefineQuery& q, const FutureGroup& group, const Motion& ego,
                      CandidateState& state, Scratch& scratch, RankWork& work) {
  const Futures& futures = q.scene.futures;
  for (const Scratch::Hit& hit : scratch.hits) {
    if (!hit.impact.hit()) continue;
    const auto index = static_cast<std::uint32_t>(state.first_hits.size());
    std::optional<double> estimate;
    for (std::size_t f = group.begin; f < group.end; ++f) {
      FutureScore& future = state.futures[f];
      if (future.first != FutureScore::no_contact || !futures.follows(f, hit.plan)) continue;
      if (!estimate) {
        estimate =
            f == futures.likeliest() ? state.coarse : estimate_of(q, state, ego, f, scratch, work);
        if (!estimate) return false;
        state.first_hits.push_back(hit);
      }
      future.first = index;
      future.estimate = *estimate;
    }
  }
  return true;
}

/// Stores the results of the search in a group of futures. Returns false if time was up.
bool store_hits(const RefineQuery& q, const FutureGroup& group, const Motion& ego,
                CandidateState& state, FollowedPlan& followed, Scratch& scratch, RankWork& work) {
  const std::size_t likeliest = q.scene.futures.likeliest();
  const auto leaving = leaving_of(q, state, ego, scratch);
  if (!store_first_hits(q, group, ego, state, scratch, work)) return false;
  for (std::size_t f = group.begin; f < group.end; ++f) {
    FutureScore& future = state.futures[f];
    const bool touches = future.first != FutureScore::no_contact;
    double until_s = no_contact_s;
    if (touches) until_s = state.first_hits[future.first].impact.time_s;
    followed.touches = followed.touches || touches;
    const double left = leaving_score(q.scene, leaving, until_s);
    state.result.leaves_road =
        state.result.leaves_road || (leaving.has_value() && leaving->time_s <= until_s);
    if (touches) {
      future.lower_bound = left;
      future.estimate += left;
    } else {
      future.score = left;
    }
    if (f != likeliest) continue;
    RankedCandidate& result = state.result;
    result.collides = touches;
    result.grazes = grazes_before(q.scene, scratch, f, until_s);
    if (!touches) continue;
    const Contact first = first_contact_of(q, ego, state.first_hits[future.first]);
    result.actor = first.actor;
    result.time_of_impact_s = first.time_of_impact_s;
    result.closing_speed_mps = first.closing_speed_mps;
  }
  return true;
}

}  // namespace

std::optional<RoadLeaving> leaving_of(const RefineQuery& q, const CandidateState& state,
                                      const Motion& ego, const Scratch& scratch) {
  if (&ego == &q.candidate.motion) return state.leaving;
  return find_leaving(q.scene.road, q.scene.ego, ego, q.scene.slice_s.back(), scratch.stop);
}

Contact first_contact_of(const RefineQuery& q, const Motion& ego, const Scratch::Hit& hit) {
  return first_contact(q.scene, ego, hit.actor, q.scene.futures.plans[hit.plan].motion, hit.impact);
}

bool find_nearby(const RefineQuery& q, CandidateState& state, Scratch& scratch, RankWork& work) {
  const double horizon_s = q.scene.slice_s.back();
  const auto leaving =
      find_leaving(q.scene.road, q.scene.ego, q.candidate.motion, horizon_s, scratch.stop);
  if (q.scene.road.ends() && scratch.stopped()) return false;
  state.leaving = leaving;
  if (!comes_near(q, scratch, work)) {
    state.result.leaves_road = leaving.has_value();
    const WeightedScore whole{horizon_s, 1.0};
    if (!fill_manoeuvre(q, {{&whole, 1}, false}, state, scratch) ||
        !settle_without_contact(q, state, scratch)) {
      return false;
    }
    state.result.stage = RankStage::near;
    return true;
  }
  const std::size_t likeliest = q.scene.futures.likeliest();
  const std::optional<double> estimate =
      estimate_of(q, state, q.candidate.motion, likeliest, scratch, work);
  if (!estimate) return false;
  state.coarse = *estimate;
  const ScoreInterval& interval = state.result.interval;
  state.result.estimate = std::clamp(state.coarse + leaving_score(q.scene, leaving, no_contact_s),
                                     interval.lowest, interval.highest);
  state.result.stage = RankStage::near;
  // A plan that is feasible until the horizon is feasible until any contact.
  state.demand_known =
      q.scene.infeasible == Infeasible::keep ||
      is_feasible(q.candidate, demand_until(q.scene, q.candidate, horizon_s, state.leaving));
  return true;
}

bool search_contacts(const RefineQuery& q, CandidateState& state, Scratch& scratch,
                     RankWork& work) {
  const Futures& futures = q.scene.futures;
  const auto restore = [&state, before = state.result] {
    state.result = before;
    state.futures.assign(state.futures.size(), {});
    state.first_hits.clear();
    return false;
  };
  bool decided = true;
  double probability = 0.0;
  FollowedPlan followed;
  for (std::size_t f = 0; f < futures.size(); f = futures.group(f).end) {
    const FutureGroup group = futures.group(f);
    const Motion& ego = ego_motion(q.scene, q.candidate, f, scratch.ego);
    const bool known = find_hits(q.scene, ego, group, scratch, work);
    const bool in_time = known && group.size() == futures.size();
    if (!in_time && scratch.stopped()) return restore();
    decided = decided && known;
    probability = collision_probability(q.scene, group, scratch, probability);
    const bool stored = store_hits(q, group, ego, state, followed, scratch, work);
    if (!stored || (!in_time && scratch.stopped())) return restore();
  }
  state.unresolved = !decided;
  if (!decided) {
    restore();
    return true;
  }
  state.result.stage = RankStage::searched;
  state.result.collision_probability = probability;
  scratch.weighted.clear();
  for (std::size_t f = 0; f < futures.size(); ++f) {
    const FutureScore& future = state.futures[f];
    const double until_s = future.first == FutureScore::no_contact
                               ? q.scene.slice_s.back()
                               : state.first_hits[future.first].impact.time_s;
    scratch.weighted.push_back({until_s, futures.probability(f)});
  }
  followed.until_s = scratch.weighted;
  if (!fill_manoeuvre(q, followed, state, scratch)) return restore();
  combine(q, state, scratch);
  return true;
}

}  // namespace crashrank::detail

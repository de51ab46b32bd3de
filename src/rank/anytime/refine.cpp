#include "rank/anytime/refine.hpp"

#include "rank/anytime/estimate.hpp"
#include "rank/combine_futures.hpp"
#include "rank/ego_motion.hpp"
#include "rank/hits.hpp"
#include "rank/manoeuvre.hpp"
#include "rank/measure_table.hpp"
#include "rank/nearby_actors.hpp"
#include "rank/road_leaving.hpp"

#include <algorithm>
#include <exception>
#include <limits>
#include <utility>

namespace crashrank::detail {
namespace {

void narrow(CandidateState& state, double lowest, double highest) {
  ScoreInterval& interval = state.result.interval;
  interval.lowest = std::max(interval.lowest, lowest);
  interval.highest = std::max(std::min(interval.highest, highest), interval.lowest);
}

void settle(CandidateState& state, double score) {
  state.result.known = true;
  state.result.score = state.result.estimate = score;
  state.result.interval = {score, score};
}

std::uint64_t work_units(const RankWork& work) {
  return work.box_tests + work.impact.bv_tests + work.impact.primitive_tests +
         work.damage.bv_tests + work.damage.primitive_tests + work.paths + work.crash_pieces;
}

constexpr double never_s = std::numeric_limits<double>::infinity();
/// Limit for the first simulation of a crash while the first place is open, in outline pieces
/// moved: about the first contact of two cars.
constexpr std::uint64_t first_quota = 20'000;

/// Fills in demand, feasibility, clearances and the speed at the horizon. Returns false if time was
/// up.
bool fill_manoeuvre(const RefineQuery& q, const FollowedPlan& followed, CandidateState& state,
                    Scratch& scratch) {
  const ManoeuvreFacts facts =
      evaluate_manoeuvre(q.scene, q.candidate, followed, state.leaving, scratch);
  if (!followed.touches && scratch.stopped()) return false;
  RankedCandidate& result = state.result;
  result.feasible = facts.feasible || q.scene.infeasible == Infeasible::keep;
  result.leaves_road = facts.leaves_road.has_value();
  result.least_distance_m = facts.clearance.distance_m;
  result.least_time_gap_s = facts.clearance.time_gap_s;
  result.end_speed_mps = result.collides ? 0.0 : facts.at_horizon.speed_mps;
  state.demand_known = true;
  return true;
}

/// Narrows the interval by what is known of the futures; sets the exact score if all futures with a
/// probability above 0 are known.
void combine(const RefineQuery& q, CandidateState& state, Scratch& scratch) {
  const Futures& futures = q.scene.futures;
  bool known = true;
  for (std::size_t f = 0; f < futures.size(); ++f) {
    known = known && (state.futures[f].known() || !(futures.probability(f) > 0.0));
  }
  const auto risk_with = [&](auto of_unknown) {
    std::vector<double>& scores = scratch.first_s;  // not used between searches
    scores.clear();
    for (const FutureScore& each : state.futures) {
      scores.push_back(each.known() ? each.score : of_unknown(each));
    }
    return risk_of_futures(q.scene, {scores.data(), scores.size()}, scratch.weighted);
  };
  const auto lower_bound_of = [](const FutureScore& future) { return future.lower_bound; };
  const double estimate = risk_with(
      [](const FutureScore& future) { return std::max(future.lower_bound, future.estimate); });
  if (known) {
    settle(state, risk_with(lower_bound_of));
  } else if (futures.size() == 1) {
    narrow(state, state.futures.front().lower_bound, state.result.interval.highest);
  } else {
    // Covers the rounding of sums.
    constexpr double rounding = 1e-12;
    narrow(state, (1.0 - rounding) * risk_with(lower_bound_of),
           (1.0 + rounding) * risk_with([&](const FutureScore&) { return state.upper_bound; }));
  }
  const ScoreInterval& interval = state.result.interval;
  state.result.estimate = std::clamp(estimate, interval.lowest, interval.highest);
}

/// Selects the future to simulate next: the one with the least simulated work relative to its
/// probability.
std::size_t next_future(const Futures& futures, const CandidateState& state) {
  std::size_t next = futures.size();
  double least = 0.0;
  for (std::size_t f = 0; f < futures.size(); ++f) {
    const double probability = futures.probability(f);
    if (state.futures[f].known() || !(probability > 0.0)) continue;
    const double simulated = static_cast<double>(first_quota + state.futures[f].simulated);
    if (next < futures.size() && simulated >= least * probability) continue;
    next = f;
    least = simulated / probability;
  }
  return next;
}

/// First moment off the road of the ego on its motion in a future.
std::optional<RoadLeaving> leaving_of(const RefineQuery& q, const CandidateState& state,
                                      const Motion& ego, const Scratch& scratch) {
  if (&ego == &q.candidate.motion) return state.leaving;
  return find_leaving(q.scene.road, q.scene.ego, ego, q.scene.slice_s.back(), scratch.stop);
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
    settle(state, leaving_score(q.scene, state.leaving, never_s));
    return true;
  }
  for (std::size_t f = 0; f < futures.size(); ++f) {
    const Motion& ego = ego_motion(q.scene, q.candidate, f, scratch.ego);
    const double score = leaving_score(q.scene, leaving_of(q, state, ego, scratch), never_s);
    if (scratch.stopped()) return false;
    state.futures[f].score = score;
  }
  combine(q, state, scratch);
  return true;
}

/// First step: finds whether an actor is near the swept boxes of the candidate. Returns false if
/// time was up.
bool find_nearby(const RefineQuery& q, CandidateState& state, Scratch& scratch, RankWork& work) {
  const double horizon_s = q.scene.slice_s.back();
  const auto leaving =
      find_leaving(q.scene.road, q.scene.ego, q.candidate.motion, horizon_s, scratch.stop);
  if (q.scene.road.ends() && scratch.stopped()) return false;
  state.leaving = leaving;
  if (!comes_near(q, scratch, work)) {
    if (!fill_manoeuvre(q, {horizon_s, never_s, false}, state, scratch) ||
        !settle_without_contact(q, state, scratch)) {
      return false;
    }
    state.result.stage = RankStage::near;
    return true;
  }
  state.result.stage = RankStage::near;
  // A plan that is feasible until the horizon is feasible until any contact.
  state.demand_known =
      q.scene.infeasible == Infeasible::keep ||
      is_feasible(q.candidate, demand_until(q.scene, q.candidate, horizon_s, state.leaving));
  return true;
}

Contact first_contact_of(const RefineQuery& q, const Motion& ego, const Scratch::Hit& hit) {
  return first_contact(q.scene, ego, hit.actor, q.scene.futures.plans[hit.plan].motion, hit.impact);
}

/// Estimate of the score of the crash that begins with a contact; `upper_bound` if the first
/// contact alone says nothing about the measure.
double estimate_of(const RefineQuery& q, const Motion& ego, const Scratch::Hit& hit,
                   double upper_bound, Scratch& scratch) {
  if (scored_by_damage(q.scene.measure)) return upper_bound;
  const double estimate = estimate_score(q.scene, ego, q.scene.futures.plans[hit.plan].motion,
                                         first_contact_of(q, ego, hit), scratch.tally);
  const bool says_nothing = !(estimate > 0.0) && !measure_row(q.scene.measure).counts_people;
  return says_nothing ? upper_bound : estimate;
}

/// Stores the hits of the last search that are the first contact of a future of the group, in their
/// order, and the estimates of their crashes.
void store_first_hits(const RefineQuery& q, const FutureGroup& group, const Motion& ego,
                      CandidateState& state, Scratch& scratch) {
  const Futures& futures = q.scene.futures;
  for (const Scratch::Hit& hit : scratch.hits) {
    if (!hit.impact.hit()) continue;
    const auto index = static_cast<std::uint32_t>(state.first_hits.size());
    double estimate = FutureScore::unknown;
    for (std::size_t f = group.begin; f < group.end; ++f) {
      FutureScore& future = state.futures[f];
      if (future.first != FutureScore::no_contact || !futures.follows(f, hit.plan)) continue;
      if (estimate < 0.0) {
        estimate = estimate_of(q, ego, hit, state.upper_bound, scratch);
        state.first_hits.push_back(hit);
      }
      future.first = index;
      future.estimate = estimate;
    }
  }
}

/// Stores the results of the search in a group of futures.
void store_hits(const RefineQuery& q, const FutureGroup& group, const Motion& ego,
                CandidateState& state, FollowedPlan& followed, Scratch& scratch) {
  const std::size_t likeliest = q.scene.futures.likeliest();
  const auto leaving = leaving_of(q, state, ego, scratch);
  store_first_hits(q, group, ego, state, scratch);
  for (std::size_t f = group.begin; f < group.end; ++f) {
    FutureScore& future = state.futures[f];
    const bool touches = future.first != FutureScore::no_contact;
    const double until_s = touches ? state.first_hits[future.first].impact.time_s : never_s;
    followed.touches = followed.touches || touches;
    followed.longest_s = std::max(followed.longest_s, touches ? until_s : q.scene.slice_s.back());
    const double left = leaving_score(q.scene, leaving, until_s);
    if (touches) {
      future.lower_bound = left;
      future.estimate += left;
    } else {
      future.score = left;
    }
    if (f != likeliest) continue;
    followed.first_s = until_s;
    RankedCandidate& result = state.result;
    result.collides = touches;
    result.grazes = grazes_before(q.scene, scratch, f, until_s);
    if (!touches) continue;
    const Contact first = first_contact_of(q, ego, state.first_hits[future.first]);
    result.actor = first.actor;
    result.time_of_impact_s = first.time_of_impact_s;
    result.closing_speed_mps = first.closing_speed_mps;
  }
}

/// Second step: finds the first contacts of the ego in all futures. Returns false if time was up.
bool search(const RefineQuery& q, CandidateState& state, Scratch& scratch, RankWork& work) {
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
    store_hits(q, group, ego, state, followed, scratch);
    if (!in_time && scratch.stopped()) return restore();
  }
  state.unresolved = !decided;
  if (!decided) {
    restore();
    return true;
  }
  state.result.stage = RankStage::searched;
  state.result.collision_probability = probability;
  if (!fill_manoeuvre(q, followed, state, scratch)) return restore();
  combine(q, state, scratch);
  return true;
}

/// Copies the result of a simulation to all futures that have the same relevant plans so far.
/// Returns false if the crash reaches an actor that was left out: then the result is invalid.
bool share_score(const Scene& scene, std::size_t future, CandidateState& state, Scratch& scratch) {
  const FutureScore found = state.futures[future];
  const FutureGroup group = scene.futures.group(future);
  if (group.size() == 1 && !scene.futures.leaves_out()) return true;
  std::fill(scratch.relevant.begin(), scratch.relevant.end(), char{0});
  for (std::uint32_t k = 0; k <= found.first; ++k) scratch.relevant[state.first_hits[k].plan] = 1;
  scratch.chain.mark_relevant_plans(scene, scratch.relevant);
  if (scene.futures.needs_left_out(scratch.relevant)) return false;
  scratch.same.clear();
  scratch.others.clear();
  for (std::size_t f = group.begin; f < group.end; ++f) {
    if (f == future || !state.futures[f].known()) {
      scratch.same.push_back(static_cast<std::uint32_t>(f));
    }
  }
  scene.futures.split(future, scratch.relevant, scratch.same, scratch.others);
  for (const std::uint32_t f : scratch.same) {
    FutureScore& same = state.futures[f];
    same.score = found.score;
    same.lower_bound = std::max(same.lower_bound, found.lower_bound);
    same.simulated = std::max(same.simulated, found.simulated);
  }
  return true;
}

/// Third step: simulates the scene after the first contact in one future. Returns false if time was
/// up.
///
/// While the first place is open, candidates and their futures alternate, each time with a multiple
/// of the work before, because first contacts alone suffice to reject most candidates. A simulation
/// starts anew each time, since there is no memory for one simulation per future; all runs before
/// the last cost half as much as the last together.
bool simulate_crash(const RefineQuery& q, CandidateState& state, Scratch& scratch, RankWork& work) {
  constexpr int steps_at_a_time = 4;
  constexpr std::uint64_t quota_growth = 3;
  const std::size_t index = next_future(q.scene.futures, state);
  FutureScore& future = state.futures[index];
  const FutureScore before = future;
  const RankedCandidate result_before = state.result;
  const bool is_limited = q.stop_above < std::numeric_limits<double>::infinity();
  const std::uint64_t quota = std::max(first_quota, quota_growth * future.simulated);
  const HarmSample& nominal = q.scene.nominal;
  CrashChain& chain = scratch.chain;
  const Motion& ego = ego_motion(q.scene, q.candidate, index, scratch.ego);
  const Contact first = first_contact_of(q, ego, state.first_hits[future.first]);
  chain.begin(q.scene, ego, index, first, nominal);
  std::size_t added = 0;
  scratch.tally.begin();
  bool going = true;
  bool in_time = true;
  const double left =
      leaving_score(q.scene, leaving_of(q, state, ego, scratch), first.time_of_impact_s);
  if (scratch.stopped()) return false;
  while (going) {
    going = chain.advance(steps_at_a_time);
    if (!going) break;
    const bool has_new_contacts = added < chain.contacts().size();
    for (; added < chain.contacts().size(); ++added) {
      scratch.tally.add(q.scene, chain.effect(added), nominal);
    }
    if (has_new_contacts) {
      future.lower_bound = std::max(future.lower_bound, left + scratch.tally.lower_bound(q.scene));
      combine(q, state, scratch);
    }
    in_time = !q.deadline.expired();
    if (!in_time || state.result.interval.lowest > q.stop_above) break;
    if (is_limited && chain.run().work() > quota) break;
  }
  future.simulated = std::max(future.simulated, chain.run().work());
  work.crash_steps += chain.run().steps();
  work.crash_pieces += chain.run().work();
  if (!going) {
    chain.effects(scratch.effects, scratch.order);
    scratch.tally.begin();
    for (const ContactEffect& effect : scratch.effects) scratch.tally.add(q.scene, effect, nominal);
    future.score = left + scratch.tally.score(q.scene);
  }
  if (!share_score(q.scene, index, state, scratch)) {
    future = before;
    state.result = result_before;
    state.unresolved = state.needs_left_out = true;
    return in_time;
  }
  combine(q, state, scratch);
  return in_time;
}

}  // namespace

void begin_refining(const Scene& scene, const ScoreBounds& bounds, const Candidate& candidate,
                    std::size_t index, Motion& displaced, CandidateState& state) {
  // Keep the memory of the vectors.
  std::vector<FutureScore> futures = std::move(state.futures);
  std::vector<Scratch::Hit> first_hits = std::move(state.first_hits);
  state = {};
  state.futures = std::move(futures);
  state.first_hits = std::move(first_hits);
  state.futures.assign(scene.futures.size(), {});
  state.first_hits.clear();
  state.result.candidate = index;
  // Whether it leaves the road is determined in the first step.
  state.upper_bound = bounds.upper_bound_displaced(scene, candidate.motion, displaced);
  if (scene.road.ends()) state.upper_bound += leaving_score(scene, RoadLeaving{}, never_s);
  state.result.interval = {0.0, state.upper_bound};
  state.result.estimate = state.upper_bound;
}

void bound_as_clear(const Scene& scene, CandidateState& state) {
  const std::optional<RoadLeaving> may_leave =
      scene.road.ends() ? std::optional<RoadLeaving>(RoadLeaving{}) : std::nullopt;
  state.upper_bound = leaving_score(scene, may_leave, never_s);
  narrow(state, 0.0, state.upper_bound);
  state.result.estimate = state.upper_bound;
}

StepResult refine(const RefineQuery& q, CandidateState& state, Scratch& scratch) {
  RankWork work;
  StepResult end;
  scratch.stop = {&Deadline::stop, const_cast<Deadline*>(&q.deadline)};
  switch (state.result.stage) {
    case RankStage::unseen:
      end.finished = find_nearby(q, state, scratch, work);
      break;
    case RankStage::near:
      end.finished = search(q, state, scratch, work);
      break;
    case RankStage::searched:
    case RankStage::scored:
      if (!scored_by_damage(q.scene.measure)) {
        end.finished = simulate_crash(q, state, scratch, work);
      } else {
        // Not stopped once it has started: its result is needed.
        scratch.stop = {};
        try {
          scratch.needs_left_out = false;
          const CandidateResult result = evaluate(q.scene, q.candidate, scratch, work);
          state.needs_left_out = scratch.needs_left_out;
          if (result.score && !state.needs_left_out) {
            settle(state, *result.score);
          } else {
            state.unresolved = true;
          }
        } catch (const std::exception&) {
          state.unresolved = true;  // out of memory: the interval remains valid
        }
      }
      if (state.result.known) state.result.stage = RankStage::scored;
      break;
  }
  end.work = work_units(work);
  return end;
}

OrderKey key_of(const RankedCandidate& c, bool by_estimate) noexcept {
  OrderKey key;
  key.demoted = !c.feasible;
  key.score = c.known ? c.score : by_estimate ? c.estimate : c.interval.highest;
  key.known = c.known;
  key.collision_probability = c.collision_probability;
  key.collides = c.collides;
  key.grazes = c.grazes;
  key.leaves_road = c.leaves_road;
  key.set_clearance(c.least_distance_m, c.least_time_gap_s);
  key.first_s = c.time_of_impact_s;
  key.closing_mps = c.closing_speed_mps;
  key.end_speed_mps = c.end_speed_mps;
  return key;
}

bool ranks_before(const RankedCandidate& a, const RankedCandidate& b, bool by_estimate) noexcept {
  const int compared = compare(key_of(a, by_estimate), key_of(b, by_estimate));
  return compared != 0 ? compared < 0 : a.candidate < b.candidate;
}

}  // namespace crashrank::detail

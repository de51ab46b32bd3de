#include "rank/evaluate.hpp"

#include "rank/bounds.hpp"
#include "rank/combine_futures.hpp"
#include "rank/ego_motion.hpp"
#include "rank/hits.hpp"
#include "rank/manoeuvre.hpp"
#include "rank/measure_table.hpp"
#include "rank/road_leaving.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

namespace crashrank::detail {
namespace {

void add_grazes(const Scene& scene, const Scratch& scratch, std::size_t future,
                CandidateResult& result) {
  const double until = result.collides ? result.contacts.front().time_of_impact_s
                                       : std::numeric_limits<double>::infinity();
  for (const Scratch::Hit& hit : scratch.hits) {
    const bool grazing = hit.impact.state == ImpactState::grazing;
    if (!scene.futures.follows(future, hit.plan) || (!grazing && !hit.impact.grazed)) continue;
    const double time = grazing ? hit.impact.time_s : hit.impact.graze_time_s;
    if (time <= until) result.grazes.push_back({hit.actor, time});
  }
  std::sort(result.grazes.begin(), result.grazes.end(), [](const Graze& p, const Graze& q) {
    return p.time_s != q.time_s ? p.time_s < q.time_s : p.actor < q.actor;
  });
}

/// Merges the damage of another contact of a body; a triangle that is hit twice counts once.
void merge(const BodyDamage& more, BodyDamage& whole) {
  std::vector<std::uint32_t> both;
  std::set_union(whole.triangles.begin(), whole.triangles.end(), more.triangles.begin(),
                 more.triangles.end(), std::back_inserter(both));
  whole.triangles = std::move(both);
  whole.region.grow(more.region);
}

/// Damage of all contacts together, by body.
std::map<std::size_t, BodyDamage> total_damage(const Scene& scene, const CandidateResult& result) {
  std::map<std::size_t, BodyDamage> whole;
  const auto add = [&whole](std::size_t body, const BodyDamage& damage) {
    const auto [place, is_new] = whole.try_emplace(body, damage);
    if (!is_new) merge(damage, place->second);
  };
  for (const Contact& contact : result.contacts) {
    add(ego_body, contact.ego);
    add(contact.actor, contact.other);
  }
  for (const FurtherContact& contact : result.further) {
    add(contact.a, contact.damage_a);
    add(contact.b, contact.damage_b);
  }
  for (auto& [body, damage] : whole) fill_area_and_parts(body_of(scene, body).model->mesh, damage);
  return whole;
}

double damage_score(const std::map<std::size_t, BodyDamage>& damage, const MeasureRow& row) {
  double score = 0.0;
  for (const auto& [body, whole] : damage) score += row.of_damage(whole);
  return score;
}

/// For each sample the index of its simulation in SimulatedOutcome::effects. Samples that differ
/// only in the risk model and its speeds share a simulation.
std::vector<std::size_t> simulation_of_sample(const Scene& scene) {
  const auto same = [](const HarmSample& p, const HarmSample& q) {
    return p.friction == q.friction && p.strength == q.strength && p.step == q.step &&
           p.shift_m == q.shift_m;
  };
  std::vector<std::size_t> places;
  std::size_t last = 0;
  for (std::size_t i = 0; i < scene.samples.size(); ++i) {
    if (i > 0 && (last == 0 || !same(scene.samples[i], scene.samples[i - 1]))) ++last;
    places.push_back(last);
  }
  return places;
}

/// Simulates the scene that follows from a first contact, in one future and one sample.
void simulate_chain(const Scene& scene, const Motion& ego, std::size_t future, const Contact& first,
                    const HarmSample& sample, Scratch& scratch, RankWork& work,
                    std::vector<ContactEffect>& effects) {
  scratch.chain.begin(scene, ego, future, first, sample);
  scratch.chain.finish();
  scratch.chain.mark_relevant_plans(scene, scratch.relevant);
  scratch.needs_left_out = scratch.needs_left_out || scene.futures.needs_left_out(scratch.relevant);
  scratch.chain.effects(effects, scratch.order);
  work.crash_steps += scratch.chain.run().steps();
  work.crash_pieces += scratch.chain.run().work();
}

/// Final values of all events. Needed because a contact is tallied before later contacts extend its
/// event.
struct EventTotals {
  /// by body and number of the event
  std::map<std::pair<std::size_t, std::size_t>, BodyEvent> last;

  void note(std::size_t body, const BodyEvent& event) { last[{body, event.number}] = event; }
};

/// Returns the score of the nominal sample and sets the event and the added harm of each contact.
double score_nominal(const Scene& scene, const SimulatedOutcome& from, Tally& tally,
                     CandidateResult& result) {
  const MeasureRow& row = measure_row(scene.measure);
  tally.begin();
  EventTotals events;
  const std::vector<ContactEffect>& effects = from.effects.front();
  std::vector<std::array<std::size_t, 2>> numbers;
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const ContactEffect& effect = effects[k];
    std::array<double, 2> harm{};
    for (std::size_t side = 0; side < 2; ++side) {
      harm[side] = -tally.people_score(scene, effect.sides[side].body);
    }
    tally.add(scene, effect, scene.nominal);
    numbers.emplace_back();
    for (std::size_t side = 0; side < 2; ++side) {
      const SideEffect& own = effect.sides[side];
      const BodyEvent event = tally.event(own.body);
      events.note(own.body, event);
      numbers.back()[side] = event.number;
      harm[side] += tally.people_score(scene, own.body) + row.of_side(own, scene.harm.weights);
    }
    const ReportedContact& reported = from.reported[k];
    if (!reported.is_further) result.contacts[reported.index].event = numbers.back()[0];
    if (!row.counts_people) continue;
    const OutcomePair outcomes = outcomes_of(result, reported);
    outcomes.a.harm = harm[0];
    outcomes.b.harm = harm[1];
    (reported.is_further ? result.further[reported.index].harm
                         : result.contacts[reported.index].severity.harm) = harm[0] + harm[1];
  }
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const OutcomePair outcomes = outcomes_of(result, from.reported[k]);
    const auto fill_event = [&](std::size_t side, BodyOutcome& outcome) {
      const BodyEvent& event = events.last[{effects[k].sides[side].body, numbers[k][side]}];
      outcome.event_delta_v_mps = event.size_mps();
      outcome.event_yaw_rate_change_radps = event.yaw_radps;
    };
    fill_event(0, outcomes.a);
    fill_event(1, outcomes.b);
  }
  return tally.score(scene);
}

/// Appends the score of the candidate in every sample, including the harm of leaving the road.
void score_samples(const Scene& scene, const std::vector<std::vector<ContactEffect>>& effects,
                   double leaving, Tally& tally, CandidateResult& result) {
  const std::vector<std::size_t> place = simulation_of_sample(scene);
  for (std::size_t i = 0; i < scene.samples.size(); ++i) {
    double score = leaving;
    if (!effects.empty()) {
      tally.begin();
      for (const ContactEffect& effect : effects[place[i]]) {
        tally.add(scene, effect, scene.samples[i]);
      }
      score += tally.score(scene);
    }
    result.sample_scores.push_back(score);
  }
}

/// Simulates a candidate in one future. Returns false if it was stopped.
bool simulate_future(const Scene& scene, const Motion& ego, std::size_t future, Scratch& scratch,
                     RankWork& work, SimulatedOutcome& found) {
  std::fill(scratch.relevant.begin(), scratch.relevant.end(), char{0});
  const Scratch::Hit* const hit = first_hit(scene, scratch, future);
  mark_relevant_hits(scratch, hit, scratch.relevant);
  CandidateResult& result = found.result;
  result.collides = found.summary.collides = hit != nullptr;
  if (result.collides) {
    const Motion& other = scene.futures.plans[hit->plan].motion;
    result.contacts.push_back(first_contact(scene, ego, hit->actor, other, hit->impact));
    const Contact first = result.contacts.front();
    result.contacts.front().severity.simulated = needs_crash(scene.measure);
    found.summary.actor = first.actor;
    found.summary.time_of_impact_s = first.time_of_impact_s;
    found.summary.closing_speed_mps = first.closing_speed_mps;
    found.effects.emplace_back();
    simulate_chain(scene, ego, future, first, scene.nominal, scratch, work, found.effects.back());
    result.crowded = scratch.chain.run().crowded();
    found.summary.contacts = scratch.chain.contacts().size();
    found.reported = report_contacts(scene, scratch.chain, scratch.order, hit->impact,
                                     ego.pose_at(first.time_of_impact_s),
                                     other.pose_at(first.time_of_impact_s), result, found.plans);
    std::size_t last = 0;
    const std::vector<std::size_t> places = simulation_of_sample(scene);
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (places[i] == last) continue;
      last = places[i];
      if (scratch.stopped()) return false;
      found.effects.emplace_back();
      simulate_chain(scene, ego, future, first, scene.samples[i], scratch, work,
                     found.effects.back());
    }
  }
  add_grazes(scene, scratch, future, result);
  return true;
}

double first_contact_s(const FutureOutcome& outcome) {
  return outcome.collides ? outcome.time_of_impact_s : std::numeric_limits<double>::infinity();
}

/// How far the plan of the ego is followed: until its first contact or the horizon; time 0 if no
/// future is known.
FollowedPlan followed_plan(const Scene& scene, const std::vector<FutureOutcome>& futures) {
  FollowedPlan followed;
  for (const FutureOutcome& outcome : futures) {
    const double first = first_contact_s(outcome);
    followed.longest_s = std::max(followed.longest_s, std::min(first, scene.slice_s.back()));
    followed.touches = followed.touches || outcome.collides;
    if (outcome.is_likeliest) followed.first_s = first;
  }
  return followed;
}

/// Fills in demand, feasibility, clearances and the state at the horizon of a candidate whose
/// futures are known.
void add_manoeuvre(const Scene& scene, const Candidate& candidate,
                   const std::optional<RoadLeaving>& leaving, Scratch& scratch,
                   CandidateResult& result) {
  const auto if_finite = [](double number) {
    return std::isfinite(number) ? std::optional<double>(number) : std::nullopt;
  };
  const FollowedPlan followed = followed_plan(scene, result.futures);
  ManoeuvreFacts facts = evaluate_manoeuvre(scene, candidate, followed, leaving, scratch);
  result.demand = facts.demand;
  result.feasible = facts.feasible;
  result.leaves_road = facts.leaves_road;
  result.least_distance_m = if_finite(facts.clearance.distance_m);
  result.least_time_gap_s = if_finite(facts.clearance.time_gap_s);
  if (!followed.touches) {
    if (result.least_distance_m) result.nearest = facts.clearance.nearest;
    if (result.least_time_gap_s) result.soonest = facts.clearance.soonest;
  }
  if (!result.collides) result.at_horizon = facts.at_horizon;
}

/// Evaluates the damage and the score of one outcome.
CandidateResult finish_outcome(const Scene& scene, SimulatedOutcome& outcome,
                               PrecomputedPairs& found, Scratch& scratch, RankWork& work) {
  CandidateResult result = std::move(outcome.result);
  for (std::size_t i = 0; i < outcome.plans.size(); ++i) {
    const std::size_t k = i - std::min(i, result.contacts.size());
    const bool is_further = i >= result.contacts.size();
    BodyDamage& a = is_further ? result.further[k].damage_a : result.contacts[i].ego;
    BodyDamage& b = is_further ? result.further[k].damage_b : result.contacts[i].other;
    find_damage(scene, outcome.plans[i], found, a, b, scratch.damage, work);
    found.first += outcome.plans[i].queries();
  }
  const std::map<std::size_t, BodyDamage> damage = total_damage(scene, result);
  if (result.collides) result.ego = damage.at(ego_body);
  const double simulated =
      outcome.effects.empty() ? 0.0 : score_nominal(scene, outcome, scratch.tally, result);
  if (!outcome.effects.empty()) result.people = scratch.tally.people(scene);
  const double left = leaving_score(scene, outcome.leaving, first_contact_s(outcome.summary));
  result.score = scored_by_damage(scene.measure) ? damage_score(damage, measure_row(scene.measure))
                                                 : left + simulated;
  score_samples(scene, outcome.effects, left, scratch.tally, result);
  return result;
}

/// Returns an outcome without contact that has the same score, or null. Two such outcomes count as
/// one.
SimulatedOutcome* same_without_contact(const Scene& scene,
                                       const std::optional<RoadLeaving>& leaving,
                                       std::vector<SimulatedOutcome>& outcomes) {
  const auto score = [&](const std::optional<RoadLeaving>& of) {
    return leaving_score(scene, of, std::numeric_limits<double>::infinity());
  };
  const auto same =
      std::find_if(outcomes.begin(), outcomes.end(), [&](const SimulatedOutcome& each) {
        return !each.summary.collides && score(each.leaving) == score(leaving);
      });
  return same != outcomes.end() ? &*same : nullptr;
}

/// Simulates a candidate in the futures of a group, beginning with future `first`. Returns false if
/// it was stopped.
bool simulate_group(const Scene& scene, const Candidate& candidate, std::size_t first,
                    Scratch& scratch, RankWork& work, SimulatedCandidate& found) {
  const Futures& futures = scene.futures;
  const FutureGroup group = futures.group(first);
  const Motion& ego = ego_motion(scene, candidate, first, scratch.ego);
  found.decided = find_hits(scene, ego, group, scratch, work) && found.decided;
  if (scratch.stopped()) return false;
  found.collision_probability =
      collision_probability(scene, group, scratch, found.collision_probability);
  const auto leaving = find_leaving(scene.road, scene.ego, ego, scene.slice_s.back(), scratch.stop);
  if (scratch.stopped()) return false;
  if (group.size() < futures.size() && first_hit(scene, scratch, first) == nullptr) {
    if (SimulatedOutcome* const same = same_without_contact(scene, leaving, found.outcomes)) {
      same->futures.push_back(static_cast<std::uint32_t>(first));
      ++same->summary.futures;
      same->summary.probability += futures.probability(first);
      return true;
    }
  }
  scratch.remaining.clear();
  for (std::size_t f = group.begin; f < group.end; ++f) {
    scratch.remaining.push_back(static_cast<std::uint32_t>(f));
  }
  while (!scratch.remaining.empty()) {
    const bool is_first = scratch.remaining.size() == group.size();
    const std::size_t future = is_first ? first : scratch.remaining.front();
    found.outcomes.emplace_back();
    SimulatedOutcome& each = found.outcomes.back();
    if (!simulate_future(scene, ego, future, scratch, work, each)) return false;
    scratch.same.swap(scratch.remaining);
    scratch.remaining.clear();
    futures.split(future, scratch.relevant, scratch.same, scratch.remaining);
    each.leaving = leaving;
    each.futures.assign(scratch.same.begin(), scratch.same.end());
    each.summary.futures = each.futures.size();
    each.summary.is_likeliest = future == futures.likeliest();
    // Results report damage for the likeliest future only; for the others it is evaluated only if
    // it is the score.
    if (!each.summary.is_likeliest && !scored_by_damage(scene.measure)) each.plans.clear();
    for (const std::uint32_t f : scratch.same) each.summary.probability += futures.probability(f);
  }
  return true;
}

}  // namespace

void Scratch::prepare(const Scene& scene) {
  std::uint32_t deepest = scene.ego.model->tree.depth;
  for (const Body& actor : scene.actors) deepest = std::max(deepest, actor.model->tree.depth);
  impact.prepare(deepest, deepest);
  const Futures& futures = scene.futures;
  place.reserve(futures.plans.size());
  near.reserve(futures.plans.size());
  hits.reserve(futures.plans.size());
  relevant.resize(futures.plans.size());
  ego_poses.reserve(scene.trajectories.steps + 1);
  first_s.reserve(futures.max_future_count());
  until_s.reserve(futures.max_future_count());
  weighted.reserve(futures.max_future_count());
  for (auto* const each : {&same, &remaining, &others}) each->reserve(futures.max_future_count());
  ego_poses.reserve(scene.trajectories.steps + 1);
  chain.prepare(scene);
  effects.reserve(SceneRun::most_contacts + 1);
  order.reserve(SceneRun::most_contacts + 1);
  tally.prepare(scene.actors.size() + 1);
}

SimulatedCandidate simulate_candidate(const Scene& scene, const Candidate& candidate,
                                      Scratch& scratch, RankWork& work) {
  SimulatedCandidate stopped;
  stopped.decided = false;
  SimulatedCandidate found;
  const Futures& futures = scene.futures;
  scratch.relevant.resize(futures.plans.size());
  const std::size_t likeliest = futures.likeliest();
  if (!simulate_group(scene, candidate, likeliest, scratch, work, found)) return stopped;
  for (std::size_t f = 0; futures.displaces_ego() && f < futures.size(); ++f) {
    if (f == likeliest) continue;
    if (!simulate_group(scene, candidate, f, scratch, work, found)) return stopped;
  }
  found.outcomes.front().result.collision_probability = found.collision_probability;
  return found;
}

namespace {

CandidateResult finish_unstopped(const Scene& scene, const Candidate& candidate,
                                 SimulatedCandidate&& simulated, PrecomputedPairs found,
                                 Scratch& scratch, RankWork& work) {
  // Leaving the road in the likeliest future, in which the ego is not displaced.
  const std::optional<RoadLeaving> leaving =
      simulated.outcomes.empty()
          ? find_leaving(scene.road, scene.ego, candidate.motion, scene.slice_s.back())
          : simulated.outcomes.front().leaving;
  std::vector<CandidateResult> results;
  for (SimulatedOutcome& each : simulated.outcomes) {
    results.push_back(finish_outcome(scene, each, found, scratch, work));
  }
  if (simulated.decided) {
    CandidateResult result =
        combine_futures(scene, std::move(results), simulated.outcomes, scratch);
    add_manoeuvre(scene, candidate, leaving, scratch, result);
    result.searched = true;
    return result;
  }
  CandidateResult result;
  if (!results.empty()) result = std::move(results.front());
  result.score.reset();
  result.sample_scores.clear();
  ScoreBounds bounds;
  bounds.prepare(scene);
  result.score_interval = {0.0, bounds.upper_bound_displaced(scene, candidate.motion, scratch.ego) +
                                    max_leaving_score(scene, leaving)};
  result.numerical_interval = result.score_interval;
  // For a candidate that was not simulated only the demand at time 0 is known.
  result.demand = demand_until(scene, candidate, 0.0, leaving);
  result.feasible = is_feasible(candidate, result.demand);
  return result;
}

}  // namespace

CandidateResult finish(const Scene& scene, const Candidate& candidate,
                       SimulatedCandidate&& simulated, PrecomputedPairs found, Scratch& scratch,
                       RankWork& work) {
  // An evaluated candidate is reported completely, even if the ranking was cancelled meanwhile.
  const StopCheck kept = std::exchange(scratch.stop, {});
  CandidateResult result =
      finish_unstopped(scene, candidate, std::move(simulated), found, scratch, work);
  scratch.stop = kept;
  return result;
}

CandidateResult evaluate(const Scene& scene, const Candidate& candidate, Scratch& scratch,
                         RankWork& work) {
  return finish(scene, candidate, simulate_candidate(scene, candidate, scratch, work), {}, scratch,
                work);
}

}  // namespace crashrank::detail

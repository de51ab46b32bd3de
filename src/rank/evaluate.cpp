#include "rank/evaluate.hpp"

#include "rank/bounds.hpp"
#include "rank/combine_futures.hpp"
#include "rank/manoeuvre.hpp"
#include "rank/measure_table.hpp"
#include "rank/road_leaving.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

namespace crashrank::detail {
namespace {

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

/// The largest values of all events. Needed because a contact is tallied before later contacts
/// extend its event.
struct EventTotals {
  /// by body and number of the event: as it was with its largest delta-v
  std::map<std::pair<std::size_t, std::size_t>, BodyEvent> largest;

  void note(std::size_t body, const BodyEvent& event) {
    BodyEvent& noted = largest[{body, event.number}];
    if (noted.number == 0 || event.size_mps() >= noted.size_mps()) noted = event;
  }
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
    // A difference of two sums: rounding can make what adds nothing negative.
    for (double& added : harm) added = std::max(added, 0.0);
    outcomes.a.harm = harm[0];
    outcomes.b.harm = harm[1];
    (reported.is_further ? result.further[reported.index].harm
                         : result.contacts[reported.index].severity.harm) = harm[0] + harm[1];
  }
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const OutcomePair outcomes = outcomes_of(result, from.reported[k]);
    const auto fill_event = [&](std::size_t side, BodyOutcome& outcome) {
      const BodyEvent& event = events.largest[{effects[k].sides[side].body, numbers[k][side]}];
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
  }
  return followed;
}

/// First moment off the road before the first contact: in the likeliest future, otherwise the
/// earliest of all futures.
std::optional<RoadLeaving> leaving_in_futures(const std::vector<SimulatedOutcome>& outcomes) {
  std::optional<RoadLeaving> earliest;
  for (const SimulatedOutcome& outcome : outcomes) {
    if (!outcome.summary.leaves_road) continue;
    if (outcome.summary.is_likeliest) return outcome.leaving;
    if (!earliest || outcome.leaving->time_s < earliest->time_s) earliest = outcome.leaving;
  }
  return earliest;
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
  result.least_distance_m = if_finite(facts.clearance.distance_m);
  result.least_time_gap_s = if_finite(facts.clearance.time_gap_s);
  result.time_to_collision_s = if_finite(facts.clearance.time_to_collision_s);
  if (!followed.touches) {
    if (result.least_distance_m) result.nearest = facts.clearance.nearest;
    if (result.least_time_gap_s) result.soonest = facts.clearance.soonest;
    if (result.time_to_collision_s) result.imminent = facts.clearance.imminent;
  }
  if (!result.collides) result.at_horizon = facts.at_horizon;
}

/// Upper bound on the score of a candidate in any future.
double max_score(const Scene& scene, const Candidate& candidate,
                 const std::optional<RoadLeaving>& leaving, Motion& displaced) {
  ScoreBounds bounds;
  bounds.prepare(scene);
  return bounds.upper_bound_displaced(scene, candidate.motion, displaced) +
         max_leaving_score(scene, leaving);
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
    const bool has_contact_without_force = std::any_of(
        simulated.outcomes.begin(), simulated.outcomes.end(),
        [](const SimulatedOutcome& each) { return each.summary.contact_without_force; });
    const std::optional<RoadLeaving> may_leave =
        scene.road.ends() ? std::optional<RoadLeaving>(RoadLeaving{}) : std::nullopt;
    const double upper_bound =
        has_contact_without_force ? max_score(scene, candidate, may_leave, scratch.ego) : 0.0;
    CandidateResult result =
        combine_futures(scene, std::move(results), simulated.outcomes, upper_bound, scratch);
    add_manoeuvre(scene, candidate, leaving, scratch, result);
    result.leaves_road = leaving_in_futures(simulated.outcomes);
    result.searched = true;
    return result;
  }
  CandidateResult result;
  if (!results.empty()) result = std::move(results.front());
  result.score.reset();
  result.sample_scores.clear();
  result.score_interval = {0.0, max_score(scene, candidate, leaving, scratch.ego)};
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

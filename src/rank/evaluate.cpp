#include "rank/evaluate.hpp"

#include "rank/bounds.hpp"
#include "rank/combine_futures.hpp"
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

/// Sets the people of the result in the nominal sample, the exposure of the bodies of its contacts,
/// and the harm of each contact: of the harm to the people of a body the share that the squared
/// delta-v of the contact has in the sum over all contacts of the body, as its energy would have. A
/// nudge after an impact bears next to nothing of it.
void add_exposures(const Scene& scene, const SimulatedOutcome& from, CrashScore& score,
                   CandidateResult& result) {
  const MeasureRow& row = measure_row(scene.measure);
  const CrashEffects& effects = from.effects.front();
  result.people = score.people(scene, effects);
  std::vector<double> summed_m2ps2(result.people.size(), 0.0);
  const auto place_of = [&](std::size_t body) {
    std::size_t k = 0;
    while (k < result.people.size() && result.people[k].body != body) ++k;
    return k;
  };
  for (const ContactEffect& effect : effects.contacts) {
    for (const SideEffect& side : effect.sides) {
      const std::size_t k = place_of(side.body);
      if (k < summed_m2ps2.size()) summed_m2ps2[k] += side.delta_v_mps * side.delta_v_mps;
    }
  }
  for (std::size_t n = 0; n < effects.contacts.size(); ++n) {
    const OutcomePair outcomes = outcomes_of(result, from.reported[n]);
    double harm = 0.0;
    for (std::size_t s = 0; s < 2; ++s) {
      const SideEffect& side = effects.contacts[n].sides[s];
      BodyOutcome& outcome = s == 0 ? outcomes.a : outcomes.b;
      const std::size_t k = place_of(side.body);
      if (k == summed_m2ps2.size()) continue;
      const PersonRisk& person = result.people[k];
      outcome.exposure_mps = person.exposure_mps;
      if (!row.counts_people) continue;
      const double share =
          summed_m2ps2[k] > 0.0 ? side.delta_v_mps * side.delta_v_mps / summed_m2ps2[k] : 0.0;
      outcome.harm = share * person.probability *
                         people_weight(exposure_of(scene, side.body, nullptr), scene.harm.weights) +
                     row.of_side(side, scene.harm.weights);
      harm += outcome.harm;
    }
    if (!row.counts_people) continue;
    (from.reported[n].is_further ? result.further[from.reported[n].index].harm
                                 : result.contacts[from.reported[n].index].severity.harm) = harm;
  }
  if (!row.counts_people) result.people.clear();
  result.people.erase(std::remove_if(result.people.begin(), result.people.end(),
                                     [](const PersonRisk& each) { return !(each.persons > 0.0); }),
                      result.people.end());
}

/// Appends the score of the candidate in every sample, including the harm of leaving the road.
void score_samples(const Scene& scene, const std::vector<CrashEffects>& effects, double leaving,
                   CrashScore& score, CandidateResult& result) {
  const std::vector<std::size_t> place = simulation_of_sample(scene);
  std::vector<double>& scores = result.sample_scores;
  scores.assign(scene.samples.size(), leaving);
  for (std::size_t i = 0; !effects.empty() && i < scores.size();) {
    std::size_t end = i + 1;
    while (end < scores.size() && place[end] == place[i]) ++end;
    score.add_scores(scene, effects[place[i]], {scene.samples.data() + i, end - i},
                     scores.data() + i);
    i = end;
  }
}

double first_contact_s(const FutureOutcome& outcome) {
  return outcome.collides ? outcome.time_of_impact_s : std::numeric_limits<double>::infinity();
}

/// How far the plan of the ego is followed; `until_s` gets the times.
FollowedPlan followed_plan(const Scene& scene, const std::vector<FutureOutcome>& futures,
                           std::vector<WeightedScore>& until_s) {
  FollowedPlan followed;
  until_s.clear();
  for (const FutureOutcome& outcome : futures) {
    until_s.push_back(
        {std::min(first_contact_s(outcome), scene.slice_s.back()), outcome.probability});
    followed.touches = followed.touches || outcome.collides;
  }
  followed.until_s = until_s;
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
  const FollowedPlan followed = followed_plan(scene, result.futures, scratch.weighted);
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
  for (std::size_t i = 0; scene.finds_damage && i < outcome.plans.size(); ++i) {
    const std::size_t k = i - std::min(i, result.contacts.size());
    const bool is_further = i >= result.contacts.size();
    BodyDamage& a = is_further ? result.further[k].damage_a : result.contacts[i].ego;
    BodyDamage& b = is_further ? result.further[k].damage_b : result.contacts[i].other;
    find_damage(scene, outcome.plans[i], found, a, b, scratch.damage, work);
    found.first += outcome.plans[i].queries();
  }
  const std::map<std::size_t, BodyDamage> damage = total_damage(scene, result);
  if (result.collides) result.ego = damage.at(ego_body);
  double simulated = 0.0;
  if (!outcome.effects.empty()) {
    simulated = scratch.score.score(scene, outcome.effects.front(), scene.nominal);
    add_exposures(scene, outcome, scratch.score, result);
  }
  const double left = leaving_score(scene, outcome.leaving, first_contact_s(outcome.summary));
  result.score = scored_by_damage(scene.measure) ? damage_score(damage, measure_row(scene.measure))
                                                 : left + simulated;
  score_samples(scene, outcome.effects, left, scratch.score, result);
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

#include "rank/evaluate.hpp"

#include "rank/bounds.hpp"
#include "rank/contact_severity.hpp"
#include "rank/follow.hpp"
#include "rank/hits.hpp"
#include "rank/meet.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace crashrank::detail {
namespace {

void add_grazes(const Scratch& scratch, CandidateResult& result) {
  const double until = result.collides ? result.contacts.front().time_of_impact_s
                                       : std::numeric_limits<double>::infinity();
  for (const Scratch::Hit& hit : scratch.hits) {
    const bool grazing = hit.impact.state == ImpactState::grazing;
    if (!grazing && !hit.impact.grazed) continue;
    const double time = grazing ? hit.impact.time_s : hit.impact.graze_time_s;
    if (time <= until) result.grazes.push_back({hit.actor, time});
  }
  std::sort(result.grazes.begin(), result.grazes.end(), [](const Graze& p, const Graze& q) {
    return p.time_s != q.time_s ? p.time_s < q.time_s : p.actor < q.actor;
  });
}

void sum_up_ego(const Scene& scene, CandidateResult& result) {
  if (result.contacts.empty()) return;
  result.ego = result.contacts.front().ego;
  if (result.contacts.size() == 1) return;
  for (std::size_t i = 1; i < result.contacts.size(); ++i) {
    const BodyDamage& more = result.contacts[i].ego;
    std::vector<std::uint32_t> both;
    std::set_union(result.ego.triangles.begin(), result.ego.triangles.end(), more.triangles.begin(),
                   more.triangles.end(), std::back_inserter(both));
    result.ego.triangles = std::move(both);
    result.ego.region.grow(more.region);
  }
  sum_up(scene.ego.model->mesh, result.ego);
}

/// Scores that need no simulation.
double planned_score(const CandidateResult& result, Measure measure) {
  double score = 0.0;
  switch (measure) {
    case Measure::polygons:
      score = static_cast<double>(result.ego.triangles.size());
      for (const Contact& contact : result.contacts) {
        score += static_cast<double>(contact.other.triangles.size());
      }
      break;
    case Measure::area:
      score = result.ego.area_m2;
      for (const Contact& contact : result.contacts) score += contact.other.area_m2;
      break;
    default:
      for (const Contact& contact : result.contacts) score += contact.closing_energy_j;
      break;
  }
  return score;
}

/// The score of the plain variant; each contact learns its event and what it adds to the harm.
double tally_up(const Scene& scene, const std::vector<std::vector<ContactEffect>>& effects,
                CandidateResult& result) {
  Tally tally;
  std::size_t begun = 0;  // the first contact of the event
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const double before = tally.ego_score(scene);
    const ContactEffect& effect = effects[k].front();
    Contact& contact = result.contacts[k];
    tally.add(scene, effect, scene.plain);
    const EgoEvent& event = tally.event();
    if (k == 0 || event.number != result.contacts[k - 1].event) begun = k;
    contact.event = event.number;
    for (std::size_t i = begun; i <= k; ++i) {
      BodyOutcome& ego = result.contacts[i].severity.ego;
      ego.event_delta_v_mps = event.delta_v_mps.norm();
      ego.event_yaw_rate_change_radps = event.yaw_radps;
    }
    if (scene.measure != Measure::harm) continue;
    ContactSeverity& severity = contact.severity;
    HarmExposure other = exposure_of_other(scene, effect);
    other.crush_energy_j = effect.other_crush_j;
    severity.other.harm = harm_of(other, scene.harm);
    HarmExposure own;
    own.crush_energy_j = effect.ego_crush_j;
    severity.ego.harm = (tally.ego_score(scene) - before) + property_harm(own, scene.harm.weights);
    severity.harm = severity.ego.harm + severity.other.harm;
  }
  return tally.score(scene);
}

/// How the bodies of a contact along the plan moved, and where the actors that the ego has met
/// until then end in the list of them.
struct SimulatedContact {
  ContactMotion motion;
  std::size_t met_end = 0;
};

// What the candidate scores in every sample, and the interval of those under its own risk model.
void add_samples(const Scene& scene, const std::vector<std::vector<ContactEffect>>& effects,
                 CandidateResult& result) {
  const std::vector<std::size_t> place = effect_of_sample(scene);
  for (std::size_t i = 0; i < scene.samples.size(); ++i) {
    const HarmSample& sample = scene.samples[i];
    Tally tally;
    for (const std::vector<ContactEffect>& variants : effects) {
      tally.add(scene, variants[place[i]], sample);
    }
    const double score = tally.score(scene);
    result.sample_scores.push_back(score);
    if (scene.measure == Measure::harm && sample.model != scene.harm.model) continue;
    ScoreInterval& interval =
        is_numerical(sample) ? result.numerical_interval : result.score_interval;
    interval.lowest = std::min(interval.lowest, score);
    interval.highest = std::max(interval.highest, score);
  }
}

}  // namespace

Approach approach(const Scene& scene, const Candidate& candidate, Scratch& scratch,
                  RankWork& work) {
  Approach found;
  found.decided = find_hits(scene, candidate.motion, scratch, work);
  double last_s = std::numeric_limits<double>::infinity();
  std::vector<Contact>& contacts = found.result.contacts;
  std::vector<SimulatedContact> simulated;
  EgoAtContact first;
  EgoAfterContact left;
  for (const Scratch::Hit& hit : scratch.hits) {
    if (!hit.impact.hit() || hit.impact.time_s > last_s) continue;
    const EgoAtContact ego = planned(candidate.motion, hit.impact.time_s);
    contacts.push_back(make_contact(scene, ego, hit.actor, hit.impact));
    const std::size_t met_before = found.met.size();
    const auto place = static_cast<std::size_t>(
        std::find(found.met.begin(), found.met.end(), hit.actor) - found.met.begin());
    if (place == met_before) add_met(scene, hit.actor, found.met);
    found.effects.emplace_back();
    const EgoAfterContact after = simulate_variants(scene, ego, contacts.back(), found.met,
                                                    scratch.crash, found.effects.back());
    contacts.back().severity.simulated = scene.pulses;
    if (contacts.size() == 1) {
      last_s = hit.impact.time_s + same_crash_s;
      first = ego;
      left = after;
    }
    simulated.push_back({scratch.crash.motion, found.met.size()});
    // A body that the ego pressed on in an earlier contact is damaged along that one's motion.
    const auto pressing =
        std::find_if(simulated.begin(), simulated.end(),
                     [place](const SimulatedContact& earlier) { return place < earlier.met_end; });
    found.plans.push_back(
        plan_damage(scene, ego.pose, contacts.back(), hit.impact, pressing->motion,
                    place < met_before ? View<const std::size_t>() : found.met_since(met_before)));
    if (scene.pulses) break;
  }
  found.result.collides = !contacts.empty();
  add_grazes(scratch, found.result);
  if (scene.pulses && !contacts.empty()) {
    follow(scene, candidate, first, left, found, scratch, work);
  }
  return found;
}

CandidateResult finish(const Scene& scene, const Candidate& candidate, Approach&& approach,
                       FoundDamage found, Scratch& scratch, RankWork& work) {
  CandidateResult result = std::move(approach.result);
  for (std::size_t i = 0; i < result.contacts.size(); ++i) {
    read_damage(scene, approach.plans[i], found, result.contacts[i], scratch.damage, work);
    found.first += approach.plans[i].queries();
  }
  sum_up_ego(scene, result);
  if (approach.decided) {
    const double simulated = tally_up(scene, approach.effects, result);
    result.score = scene.pulses ? simulated : planned_score(result, scene.measure);
    result.score_interval = {*result.score, *result.score};
    result.numerical_interval = result.score_interval;
    add_samples(scene, approach.effects, result);
  } else {
    ScoreBounds bounds;
    bounds.prepare(scene);
    result.score_interval = {0.0, bounds.most(scene, candidate.motion)};
    result.numerical_interval = result.score_interval;
  }
  return result;
}

CandidateResult evaluate(const Scene& scene, const Candidate& candidate, Scratch& scratch,
                         RankWork& work) {
  return finish(scene, candidate, approach(scene, candidate, scratch, work), {}, scratch, work);
}

}  // namespace crashrank::detail

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

double score_of(const CandidateResult& result, Measure measure) {
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
    case Measure::closing_energy:
      for (const Contact& contact : result.contacts) score += contact.closing_energy_j;
      break;
    case Measure::delta_v:
      for (const Contact& contact : result.contacts) score += contact.severity.ego.delta_v_mps;
      break;
    case Measure::energy:
      for (const Contact& contact : result.contacts) score += contact.severity.dissipated_j;
      break;
    case Measure::intrusion:
      for (const Contact& contact : result.contacts) {
        score += contact.severity.ego.intrusion_m + contact.severity.other.intrusion_m;
      }
      break;
    case Measure::harm:
      for (const Contact& contact : result.contacts) score += contact.severity.harm;
      break;
  }
  return score;
}

// What the candidate scores in every sample, and the interval of those under its own risk model.
void add_samples(const Scene& scene, CandidateResult& result) {
  if (scene.samples.empty()) return;
  result.sample_scores.assign(scene.samples.size(), 0.0);
  for (const Contact& contact : result.contacts) {
    for (std::size_t i = 0; i < scene.samples.size(); ++i) {
      result.sample_scores[i] += contact.severity.sample_scores[i];
    }
  }
  for (std::size_t i = 0; i < scene.samples.size(); ++i) {
    if (scene.measure == Measure::harm && scene.samples[i].model != scene.harm.model) continue;
    ScoreInterval& interval = result.score_interval;
    interval.lowest = std::min(interval.lowest, result.sample_scores[i]);
    interval.highest = std::max(interval.highest, result.sample_scores[i]);
  }
}

}  // namespace

Approach approach(const Scene& scene, const Candidate& candidate, Scratch& scratch,
                  RankWork& work) {
  Approach found;
  found.decided = find_hits(scene, candidate.motion, scratch, work);
  double last_s = std::numeric_limits<double>::infinity();
  std::vector<Contact>& contacts = found.result.contacts;
  EgoAtContact first;
  EgoAfterContact left;
  for (const Scratch::Hit& hit : scratch.hits) {
    if (!hit.impact.hit() || hit.impact.time_s > last_s) continue;
    const EgoAtContact ego = planned(candidate.motion, hit.impact.time_s);
    contacts.push_back(make_contact(scene, ego, hit.actor, hit.impact));
    const EgoAfterContact after = tell_severity(scene, ego, contacts.back());
    if (contacts.size() == 1) {
      last_s = hit.impact.time_s + window_s(scene, contacts.front().closing_speed_mps);
      first = ego;
      left = after;
    }
    found.plans.push_back(plan_damage(scene, candidate.motion, contacts.back(),
                                      hit.impact.triangle_a, hit.impact.triangle_b));
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
    read_damage(scene, approach.motion(candidate, i), approach.plans[i], found, result.contacts[i],
                scratch.damage, work);
    found.first += approach.plans[i].poses.size();
  }
  sum_up_ego(scene, result);
  if (approach.decided) {
    result.score = score_of(result, scene.measure);
    result.score_interval = {*result.score, *result.score};
    add_samples(scene, result);
  } else {
    ScoreBounds bounds;
    bounds.prepare(scene);
    result.score_interval = {0.0, bounds.most(scene, candidate.motion)};
  }
  return result;
}

CandidateResult evaluate(const Scene& scene, const Candidate& candidate, Scratch& scratch,
                         RankWork& work) {
  return finish(scene, candidate, approach(scene, candidate, scratch, work), {}, scratch, work);
}

}  // namespace crashrank::detail

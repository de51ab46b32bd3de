#include "rank/evaluate.hpp"

#include "rank/contact_severity.hpp"
#include "rank/follow.hpp"
#include "rank/meet.hpp"
#include "rank/near.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace crashrank::detail {
namespace {

// A contact that begins this long after the first one still belongs to the same crash.
double longest_window_s(const Scene& scene) {
  return scene.crush.depth_m ? scenario_limits::crush_time_s : scene.crush.time_s;
}

double window_s(const Scene& scene, double closing_speed_mps) {
  if (!scene.crush.depth_m) return scene.crush.time_s;
  if (!(closing_speed_mps > 0.0)) return 0.0;
  return std::min(*scene.crush.depth_m / closing_speed_mps, scenario_limits::crush_time_s);
}

bool starts_as_the_ego(const Scene& scene, const Motion& motion) {
  const Pose pose = motion.pose_at(0.0);
  return pose.rotation == scene.ego_start.rotation &&
         pose.translation == scene.ego_start.translation;
}

// Fills scratch.hits with everything but clean misses. Returns false when some question stayed
// undecided.
bool find_hits(const Scene& scene, const Motion& ego, Scratch& scratch, RankWork& work) {
  scratch.hits.clear();
  find_near(scene, ego, 0.0, scene.slice_s.back(), scratch, work);
  const bool same_start = starts_as_the_ego(scene, ego);
  bool decided = true;
  double first_s = std::numeric_limits<double>::infinity();
  // All that come near in the same slice are asked up to the same time, so that no answer depends
  // on the order of the actors.
  double until_s = first_s;
  std::size_t slice = scene.slices.size();
  for (const Scratch::Near& near : scratch.near) {
    if (near.first_slice != slice) {
      slice = near.first_slice;
      until_s = first_s + longest_window_s(scene);
    }
    const double from = scene.slice_s[near.first_slice];
    const double until = std::min(scene.slice_s[near.last_slice + 1], until_s);
    if (from > until) continue;
    const Body& actor = scene.actors[near.actor];
    ImpactOptions options = scene.impact;
    options.start_is_apart =
        near.first_slice > 0 || (same_start && scene.apart_at_start[near.actor] != 0);
    const Impact impact = time_of_impact(scene.ego.model->tree, ego, actor.model->tree,
                                         actor.motion, from, until, scratch.impact, options);
    ++work.body_pairs;
    work.impact += impact.work;
    if (impact.state == ImpactState::undecided) decided = false;
    if (impact.state == ImpactState::none || impact.state == ImpactState::undecided) continue;
    scratch.hits.push_back({near.actor, impact});
    if (impact.hit()) first_s = std::min(first_s, impact.time_s);
  }
  std::sort(scratch.hits.begin(), scratch.hits.end(),
            [](const Scratch::Hit& p, const Scratch::Hit& q) {
              return p.impact.time_s != q.impact.time_s ? p.impact.time_s < q.impact.time_s
                                                        : p.actor < q.actor;
            });
  return decided;
}

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

double surface_m2(const TriangleMesh& mesh) {
  double area = 0.0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const Triangle t = mesh.triangle(i);
    const Eigen::Vector3d a = t.corner[0].cast<double>();
    area += 0.5 * (t.corner[1].cast<double>() - a).cross(t.corner[2].cast<double>() - a).norm();
  }
  return area;
}

// No crash of this candidate can score more.
double highest_score(const Scene& scene, const Motion& ego) {
  const double end = scene.slice_s.back();
  const auto top_speed = [end](const Body& body, const Motion& motion) {
    const MotionBound bound = motion.bound(0.0, end);
    return bound.speed_mps + bound.angular_radps * body.radius_m;
  };
  const auto most_energy = [&](const Body& body, const Motion& motion) {
    const double speed = top_speed(body, motion);
    return std::isfinite(body.mass_kg) ? 0.5 * body.mass_kg * speed * speed : 0.0;
  };
  double score = 0.0;
  switch (scene.measure) {
    case Measure::polygons:
      score = static_cast<double>(scene.ego.model->mesh.size());
      for (const Body& body : scene.actors) score += static_cast<double>(body.model->mesh.size());
      break;
    case Measure::area:
      score = surface_m2(scene.ego.model->mesh);
      for (const Body& body : scene.actors) score += surface_m2(body.model->mesh);
      break;
    case Measure::closing_energy:
      for (const Body& body : scene.actors) {
        // The point of contact may lie as far from either origin as both bodies reach.
        const double speed = top_speed(scene.ego, ego) + top_speed(body, body.motion);
        score += closing_energy_j(scene.ego.mass_kg, body.mass_kg, 1.001 * speed);
      }
      break;
    case Measure::delta_v:
      // Without rebound nobody's speed changes by more than both had.
      for (const Body& body : scene.actors) {
        score += 2.0 * (top_speed(scene.ego, ego) + top_speed(body, body.motion));
      }
      break;
    case Measure::energy:
      for (const Body& body : scene.actors)
        score += most_energy(body, body.motion) + most_energy(scene.ego, ego);
      break;
    case Measure::intrusion:
      for (const Body& body : scene.actors) score += 2.0 * (body.radius_m + scene.ego.radius_m);
      break;
    case Measure::harm:
      for (const Body& body : scene.actors) {
        // Risk is 1 at most, and at such a speed it is as good as that.
        constexpr double surely_mps = 1e3;
        HarmExposure worst;
        worst.delta_v_mps = surely_mps;
        worst.closing_speed_mps = surely_mps;
        worst.crush_energy_j = most_energy(body, body.motion) + most_energy(scene.ego, ego);
        worst.kind = scene.ego.kind;
        worst.ego = true;
        score += harm_of(worst, scene.harm);
        worst.kind = body.kind;
        worst.ego = false;
        score += harm_of(worst, scene.harm);
      }
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

EgoAtContact planned(const Motion& motion, double time_s) {
  EgoAtContact ego;
  motion.state_at(time_s, ego.pose, ego.met);
  ego.left = ego.met;
  return ego;
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
    result.score_interval = {0.0, highest_score(scene, candidate.motion)};
  }
  return result;
}

CandidateResult evaluate(const Scene& scene, const Candidate& candidate, Scratch& scratch,
                         RankWork& work) {
  return finish(scene, candidate, approach(scene, candidate, scratch, work), {}, scratch, work);
}

}  // namespace crashrank::detail

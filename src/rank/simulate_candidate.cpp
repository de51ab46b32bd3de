#include "rank/evaluate.hpp"

#include "rank/combine_futures.hpp"
#include "rank/contact_force.hpp"
#include "rank/ego_motion.hpp"
#include "rank/hits.hpp"
#include "rank/manoeuvre.hpp"
#include "rank/measure_table.hpp"
#include "rank/road_leaving.hpp"

#include <algorithm>
#include <limits>
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

/// Simulates the scene that follows from a first contact, in one future and one sample.
void simulate_chain(const Scene& scene, const Motion& ego, std::size_t future, const Contact& first,
                    const HarmSample& sample, Scratch& scratch, RankWork& work,
                    CrashEffects& effects, std::vector<BodyMotion>* motion = nullptr) {
  scratch.chain.begin(scene, ego, future, first, sample);
  if (motion != nullptr) {
    scratch.chain.finish_recording(*motion);
  } else {
    scratch.chain.finish();
  }
  work.crash_steps += scratch.chain.run().steps();
  work.crash_pieces += scratch.chain.run().work();
  scratch.chain.mark_relevant_plans(scene, scratch.relevant);
  scene.futures.mark_needed(scratch.relevant, scratch.needed);
  scratch.chain.effects(effects, scratch.order);
}

template <typename AnyContact> void note_speed(const AnyContact& contact, FutureOutcome& outcome) {
  outcome.fastest_contact_mps = std::max(outcome.fastest_contact_mps, contact.closing_speed_mps);
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
    Touch touch =
        first_touch(scene, ego, hit->actor, scene.futures.plans[hit->plan].motion, hit->impact);
    const Contact& first = touch.contact;
    found.summary.actor = first.actor;
    found.summary.time_of_impact_s = first.time_of_impact_s;
    found.summary.closing_speed_mps = first.closing_speed_mps;
    found.summary.state = first.state;
    found.effects.emplace_back();
    const bool records = scene.records_motion && future == scene.futures.likeliest();
    simulate_chain(scene, ego, future, first, scene.nominal, scratch, work, found.effects.back(),
                   records ? &result.motion : nullptr);
    result.crowded = scratch.chain.run().crowded();
    found.summary.contacts = scratch.chain.contacts().size();
    const std::optional<std::size_t> unforced =
        actor_without_force(scene, ego, future, first, scratch, work);
    if (!unforced) return false;
    touch.contact.contact_without_force = unforced == first.actor;
    found.summary.contact_without_force = unforced != no_actor;
    if (unforced != no_actor) found.summary.unforced_actor = *unforced;
    found.reported =
        report_contacts(scene, scratch.chain, touch, scratch.order, result, found.plans);
    if (!scene.finds_damage) found.plans.clear();
    for (const Contact& contact : result.contacts) note_speed(contact, found.summary);
    for (const FurtherContact& contact : result.further) note_speed(contact, found.summary);
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
        return !each.summary.collides && each.leaving.has_value() == leaving.has_value() &&
               score(each.leaving) == score(leaving);
      });
  return same != outcomes.end() ? &*same : nullptr;
}

/// Adds the probability of a future to its outcome. Rounding can make a sum exceed 1.
void add_probability(double probability, FutureOutcome& outcome) {
  outcome.probability = std::min(outcome.probability + probability, 1.0);
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
      add_probability(futures.probability(first), same->summary);
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
    each.summary.leaves_road =
        leaving && (!each.summary.collides || leaving->time_s <= each.summary.time_of_impact_s);
    each.futures.assign(scratch.same.begin(), scratch.same.end());
    each.summary.futures = each.futures.size();
    each.summary.is_likeliest = future == futures.likeliest();
    // Results report damage for the likeliest future only; for the others it is evaluated only if
    // it is the score.
    if (!each.summary.is_likeliest && !scored_by_damage(scene.measure)) each.plans.clear();
    for (const std::uint32_t f : scratch.same) {
      add_probability(futures.probability(f), each.summary);
    }
  }
  return true;
}

}  // namespace

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

void Scratch::prepare(const Scene& scene) {
  std::uint32_t deepest = scene.ego.model->tree.depth;
  for (const Body& actor : scene.actors) deepest = std::max(deepest, actor.model->tree.depth);
  for (const std::optional<EnteringBody>& kind : scene.entering) {
    if (kind) deepest = std::max(deepest, kind->body.model->tree.depth);
  }
  impact.prepare(deepest, deepest);
  const Futures& futures = scene.futures;
  place.reserve(futures.plans.size());
  near.reserve(futures.plans.size());
  hits.reserve(futures.plans.size());
  relevant.resize(futures.plans.size());
  needed.resize(scene.actors.size());
  ego_poses.reserve(scene.trajectories.steps + 1);
  first_s.reserve(futures.max_future_count());
  until_s.reserve(futures.max_future_count());
  weighted.reserve(futures.max_future_count());
  for (auto* const each : {&same, &remaining, &others}) each->reserve(futures.max_future_count());
  ego_poses.reserve(scene.trajectories.steps + 1);
  chain.prepare(scene);
  boxes.prepare(scene.actors.size() + 1);
  effects.contacts.reserve(SceneRun::most_contacts + 1);
  effects.bodies.reserve(scene.actors.size() + 1);
  effects.cells.reserve(std::min(SceneRun::most_recorded, scene.actors.size() + 1) *
                        ExposureRecord::most_cells);
  order.reserve(SceneRun::most_contacts + 1);
  score.prepare();
}

SimulatedCandidate simulate_candidate(const Scene& scene, const Candidate& candidate,
                                      Scratch& scratch, RankWork& work) {
  SimulatedCandidate stopped;
  stopped.decided = false;
  SimulatedCandidate found;
  const Futures& futures = scene.futures;
  scratch.relevant.resize(futures.plans.size());
  scratch.needed.resize(scene.actors.size());
  const std::size_t likeliest = futures.likeliest();
  if (!simulate_group(scene, candidate, likeliest, scratch, work, found)) return stopped;
  for (std::size_t f = 0; futures.displaces_ego() && f < futures.size(); ++f) {
    if (f == likeliest) continue;
    if (!simulate_group(scene, candidate, f, scratch, work, found)) return stopped;
  }
  found.outcomes.front().result.collision_probability = found.collision_probability;
  return found;
}

}  // namespace crashrank::detail

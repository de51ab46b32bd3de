#include "rank/refine.hpp"

#include "rank/follow.hpp"
#include "rank/hits.hpp"
#include "rank/meet.hpp"
#include "rank/near.hpp"
#include "rank/score_crash.hpp"

#include <algorithm>
#include <exception>
#include <limits>

namespace crashrank::detail {
namespace {

void narrow(Refined& state, double lowest, double highest) {
  ScoreInterval& interval = state.told.interval;
  interval.lowest = std::max(interval.lowest, lowest);
  interval.highest = std::max(std::min(interval.highest, highest), interval.lowest);
}

void settle(Refined& state, double score) {
  state.told.known = true;
  state.told.score = score;
  state.told.interval = {score, score};
}

std::uint64_t tests_of(const RankWork& work) {
  return work.box_tests + work.impact.bv_tests + work.impact.primitive_tests +
         work.damage.bv_tests + work.damage.primitive_tests + work.paths;
}

View<const std::size_t> met(const Refined& state) { return {state.met.data(), state.met.size()}; }

std::size_t contacts_left(const Scene& scene, const Refined& state) {
  const std::size_t most = std::min(scene.harm.after.most_contacts, harm_limits::contacts);
  return most - std::min(most, state.contacts);
}

void look_near(const RefineQuery& q, Refined& state, RefineScratch& scratch, RankWork& work) {
  find_near(q.scene, q.candidate.motion, 0.0, q.scene.slice_s.back(), scratch.evaluate, work);
  state.told.stage = RankStage::near;
  scratch.near.clear();
  for (const Scratch::Near& near : scratch.evaluate.near) scratch.near.push_back(near.actor);
  if (scratch.near.empty()) {
    settle(state, 0.0);
  } else {
    narrow(state, 0.0, q.bounds.most_with_first(q.scene, q.candidate.motion, scratch.near));
  }
}

/// The contact whose crash is to be simulated next.
void expect(const RefineQuery& q, Refined& state, const EgoAtContact& ego, Contact&& contact,
            RefineScratch& scratch, RankWork& work) {
  state.pending = std::move(contact);
  state.ego = ego;
  const CrashSetup crash =
      set_up_crash(q.scene, ego, state.pending, met(state), scratch.crash.group);
  add_met(q.scene, state.pending.actor, state.met);
  ++state.contacts;
  const std::size_t left = contacts_left(q.scene, state);
  const Later all = q.bounds.most_after(q.scene, q.candidate.motion, met(state), left);
  const Later near = most_in_reach(q.scene, reach_after(q.scene, q.candidate, crash, state.pending),
                                   met(state), left, scratch.reach, work.box_tests);
  state.after = {};
  if (all.any && near.any) {
    state.after = {true, std::min(all.most, near.most),
                   std::min(all.ego_delta_v_mps, near.ego_delta_v_mps)};
  }
  const Range score =
      state.tally.bounds(q.scene, pending_at_contact(crash, state.pending), state.after);
  narrow(state, score.least, score.most);
}

/// All contacts of a measure that takes the planned motion only.
void add_planned(const RefineQuery& q, Refined& state, const Scratch& scratch) {
  double last_s = std::numeric_limits<double>::infinity();
  double energy = 0.0;
  double most_triangles = static_cast<double>(q.scene.ego.model->mesh.size());
  double most_area = q.bounds.ego_surface_m2();
  double least_triangles = 0.0;
  for (const Scratch::Hit& hit : scratch.hits) {
    if (!hit.impact.hit() || hit.impact.time_s > last_s) continue;
    const EgoAtContact ego = planned(q.candidate.motion, hit.impact.time_s);
    const Contact contact = make_contact(q.scene, ego, hit.actor, hit.impact);
    if (last_s == std::numeric_limits<double>::infinity()) {
      last_s = hit.impact.time_s + same_crash_s;
    }
    energy += contact.closing_energy_j;
    most_triangles += static_cast<double>(q.scene.actors[hit.actor].model->mesh.size());
    most_area += q.bounds.actor_surface_m2(hit.actor);
    // The ego's triangle that met first may be the same for several bodies.
    least_triangles += least_triangles == 0.0 ? 2.0 : 1.0;
  }
  switch (q.scene.measure) {
    case Measure::closing_energy:
      settle(state, energy);
      break;
    case Measure::polygons:
      narrow(state, least_triangles, most_triangles);
      break;
    case Measure::area:
      narrow(state, 0.0, (1.0 + 1e-9) * most_area);
      break;
    default:
      break;
  }
}

/// Finds the contacts of the planned motion. False when time was up.
bool search(const RefineQuery& q, Refined& state, RefineScratch& scratch, RankWork& work) {
  const bool decided = find_hits(q.scene, q.candidate.motion, scratch.evaluate, work);
  if (!decided && q.watch.expired()) return false;
  state.told.stage = RankStage::searched;
  const auto first = std::find_if(scratch.evaluate.hits.begin(), scratch.evaluate.hits.end(),
                                  [](const Scratch::Hit& hit) { return hit.impact.hit(); });
  state.told.collides = first != scratch.evaluate.hits.end();
  const double until_s =
      state.told.collides ? first->impact.time_s : std::numeric_limits<double>::infinity();
  state.told.grazes = grazes_before(scratch.evaluate, until_s);
  if (state.told.collides) {
    const EgoAtContact ego = planned(q.candidate.motion, first->impact.time_s);
    Contact contact = make_contact(q.scene, ego, first->actor, first->impact);
    state.told.actor = contact.actor;
    state.told.time_of_impact_s = contact.time_of_impact_s;
    state.told.closing_speed_mps = contact.closing_speed_mps;
    if (decided && scored_by_pulses(q.scene)) {
      expect(q, state, ego, std::move(contact), scratch, work);
    }
  }
  state.stuck = !decided;
  if (state.stuck) return true;
  if (!state.told.collides) {
    settle(state, 0.0);
  } else if (!q.scene.pulses) {
    add_planned(q, state, scratch.evaluate);
  }
  return true;
}

/// Simulates the pending crash and looks for what comes after it.
bool crash(const RefineQuery& q, Refined& state, RefineScratch& scratch, RankWork& work,
           std::uint64_t& pulse_work) {
  scratch.met.assign(state.met.begin(), state.met.end());
  const CrashScore scored =
      score_crash(q.scene, {state.ego, state.pending, state.tally, state.after, q.give_up_above},
                  q.watch, scratch.met, scratch.crash);
  pulse_work += scored.work;
  narrow(state, scored.score.least, scored.score.most);
  if (scored.end == CrashScore::End::given_up) return true;
  if (scored.end == CrashScore::End::stopped) return false;

  Tally tally = state.tally;
  tally.add(q.scene, scored.effect, q.scene.plain);
  const double start_s = state.pending.time_of_impact_s;
  bool over = contacts_left(q.scene, state) == 0;
  if (!over) {
    scratch.aftermath.begin(q.scene, q.candidate, start_s, state.ego, scored.after);
    over = !(scratch.aftermath.until_s() > start_s);
  }
  std::optional<Scratch::Hit> hit;
  if (!over) {
    bool stopped = false;
    hit = find_next(q.scene, scratch.aftermath, {scratch.met.data(), scratch.met.size()}, start_s,
                    q.watch, stopped, scratch.evaluate, work);
    if (stopped) return false;
  }
  state.tally = tally;
  state.met.assign(scratch.met.begin(), scratch.met.end());
  state.told.stage = RankStage::followed;
  if (!hit) {
    settle(state, tally.score(q.scene));
    return true;
  }
  const EgoAtContact ego = scratch.aftermath.at(hit->impact.time_s);
  expect(q, state, ego, make_following_contact(q.scene, ego, *hit), scratch, work);
  return true;
}

}  // namespace

void begin_refining(const Scene& scene, const ScoreBounds& bounds, const Candidate& candidate,
                    std::size_t index, Refined& state) {
  std::vector<std::size_t> met = std::move(state.met);
  met.clear();
  state = {};
  state.met = std::move(met);
  state.told.candidate = index;
  state.told.interval = {0.0, bounds.most(scene, candidate.motion)};
}

void settle_as_clear(Refined& state) {
  state.told.stage = RankStage::near;
  settle(state, 0.0);
}

StepEnd refine(const RefineQuery& q, Refined& state, RefineScratch& scratch) {
  RankWork work;
  StepEnd end;
  std::uint64_t pulse_work = 0;
  scratch.evaluate.stop = &Watch::stop;
  scratch.evaluate.stop_context = const_cast<Watch*>(&q.watch);
  switch (state.told.stage) {
    case RankStage::unseen:
      look_near(q, state, scratch, work);
      break;
    case RankStage::near:
      end.finished = search(q, state, scratch, work);
      break;
    case RankStage::searched:
    case RankStage::followed:
    case RankStage::scored:
      if (scored_by_pulses(q.scene)) {
        end.finished = crash(q, state, scratch, work, pulse_work);
      } else {
        // No stop within: what is begun is worth finishing.
        scratch.evaluate.stop = nullptr;
        try {
          const CandidateResult result = evaluate(q.scene, q.candidate, scratch.evaluate, work);
          if (result.score) {
            settle(state, *result.score);
          } else {
            state.stuck = true;
          }
        } catch (const std::exception&) {
          state.stuck = true;  // no memory: the interval stands
        }
      }
      if (state.told.known) state.told.stage = RankStage::scored;
      break;
  }
  end.work = tests_of(work) + pulse_work;
  return end;
}

bool promises_more(const RankedCandidate& a, const RankedCandidate& b) {
  // A score where it is known, the worst that may come where it is not.
  const double worth_a = a.known ? a.score : a.interval.highest;
  const double worth_b = b.known ? b.score : b.interval.highest;
  if (worth_a != worth_b) return worth_a < worth_b;
  if (a.known != b.known) return a.known;
  if (a.collides != b.collides) return !a.collides;
  if (a.grazes != b.grazes) return !a.grazes;
  if (a.collides) {
    if (a.time_of_impact_s != b.time_of_impact_s) return a.time_of_impact_s > b.time_of_impact_s;
    if (a.closing_speed_mps != b.closing_speed_mps) {
      return a.closing_speed_mps < b.closing_speed_mps;
    }
  }
  return a.candidate < b.candidate;
}

}  // namespace crashrank::detail

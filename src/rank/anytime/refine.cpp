#include "rank/anytime/refine.hpp"

#include "rank/hits.hpp"
#include "rank/measure_table.hpp"
#include "rank/near.hpp"

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
         work.damage.bv_tests + work.damage.primitive_tests + work.paths + work.crash_pieces;
}

void look_near(const RefineQuery& q, Refined& state, Scratch& scratch, RankWork& work) {
  find_near(q.scene, q.candidate.motion, 0.0, q.scene.slice_s.back(), scratch, work);
  state.told.stage = RankStage::near;
  if (scratch.near.empty()) settle(state, 0.0);
}

/// Finds the first contact of the planned motion. False when time was up.
bool search(const RefineQuery& q, Refined& state, Scratch& scratch, RankWork& work) {
  const bool decided = find_hits(q.scene, q.candidate.motion, scratch, work);
  if (!decided && q.watch.expired()) return false;
  state.told.stage = RankStage::searched;
  const auto first = std::find_if(scratch.hits.begin(), scratch.hits.end(),
                                  [](const Scratch::Hit& hit) { return hit.impact.hit(); });
  state.told.collides = first != scratch.hits.end();
  const double until_s =
      state.told.collides ? first->impact.time_s : std::numeric_limits<double>::infinity();
  state.told.grazes = grazes_before(scratch, until_s);
  if (state.told.collides) {
    state.first = first_contact(q.scene, q.candidate.motion, first->actor, first->impact);
    state.told.actor = state.first.actor;
    state.told.time_of_impact_s = state.first.time_of_impact_s;
    state.told.closing_speed_mps = state.first.closing_speed_mps;
  }
  state.stuck = !decided;
  if (decided && !state.told.collides) settle(state, 0.0);
  return true;
}

/// Simulates what follows from the first contact. False when time was up.
///
/// To find the first place, candidates take turns, each with several times the work of its last
/// turn: most are beaten by their first contact alone. A simulation begins anew with each turn, for
/// there is no room for one of each candidate; all turns before the last cost half of it together.
bool crash(const RefineQuery& q, Refined& state, Scratch& scratch, RankWork& work) {
  constexpr int steps_at_a_time = 4;
  constexpr std::uint64_t first_turn = 20'000;  // pieces: about the first contact of two cars
  constexpr std::uint64_t more = 3;
  const bool in_turns = q.give_up_above < std::numeric_limits<double>::infinity();
  const std::uint64_t turn = std::max(first_turn, more * state.simulated);
  const HarmSample& plain = q.scene.plain;
  CrashChain& chain = scratch.chain;
  chain.begin(q.scene, q.candidate, state.first, plain);
  std::size_t over = 0;
  scratch.tally.begin();
  bool going = true;
  bool in_time = true;
  while (going) {
    going = chain.advance(steps_at_a_time);
    if (!going) break;
    for (; over < chain.contacts().size(); ++over) {
      scratch.tally.add(q.scene, chain.effect(over), plain);
      narrow(state, scratch.tally.least_score(q.scene), state.told.interval.highest);
    }
    in_time = !q.watch.expired();
    if (!in_time || state.told.interval.lowest > q.give_up_above) break;
    if (in_turns && chain.run().work() > turn) break;
  }
  state.simulated = std::max(state.simulated, chain.run().work());
  work.crash_steps += chain.run().steps();
  work.crash_pieces += chain.run().work();
  if (going) return in_time;
  chain.effects(scratch.effects, scratch.order);
  scratch.tally.begin();
  for (const ContactEffect& effect : scratch.effects) scratch.tally.add(q.scene, effect, plain);
  settle(state, scratch.tally.score(q.scene));
  return true;
}

}  // namespace

void begin_refining(const Scene& scene, const ScoreBounds& bounds, const Candidate& candidate,
                    std::size_t index, Refined& state) {
  state = {};
  state.told.candidate = index;
  state.told.interval = {0.0, bounds.most(scene, candidate.motion)};
}

void settle_as_clear(Refined& state) {
  state.told.stage = RankStage::near;
  settle(state, 0.0);
}

StepEnd refine(const RefineQuery& q, Refined& state, Scratch& scratch) {
  RankWork work;
  StepEnd end;
  scratch.stop = &Watch::stop;
  scratch.stop_context = const_cast<Watch*>(&q.watch);
  switch (state.told.stage) {
    case RankStage::unseen:
      look_near(q, state, scratch, work);
      break;
    case RankStage::near:
      end.finished = search(q, state, scratch, work);
      break;
    case RankStage::searched:
    case RankStage::scored:
      if (!scored_by_damage(q.scene.measure)) {
        end.finished = crash(q, state, scratch, work);
      } else {
        // No stop within: what is begun is worth finishing.
        scratch.stop = nullptr;
        try {
          const CandidateResult result = evaluate(q.scene, q.candidate, scratch, work);
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
  end.work = tests_of(work);
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

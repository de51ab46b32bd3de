#include "rank/anytime/refine_steps.hpp"
#include "rank/contact_force.hpp"
#include "rank/ego_motion.hpp"
#include "rank/manoeuvre.hpp"
#include "rank/road_leaving.hpp"

#include <algorithm>
#include <limits>

namespace crashrank::detail {
namespace {

/// Selects the future to simulate next: the one with the least simulated work relative to its
/// probability.
std::size_t next_future(const Futures& futures, const CandidateState& state) {
  std::size_t next = futures.size();
  double least = 0.0;
  for (std::size_t f = 0; f < futures.size(); ++f) {
    const double probability = futures.probability(f);
    if (state.futures[f].known() || !(probability > 0.0)) continue;
    const double simulated = static_cast<double>(1 + state.futures[f].simulated);
    if (next < futures.size() && simulated >= least * probability) continue;
    next = f;
    least = simulated / probability;
  }
  return next;
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
  std::fill(scratch.needed.begin(), scratch.needed.end(), char{0});
  if (scene.futures.mark_needed(scratch.relevant, scratch.needed)) return false;
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
    same.contact_without_force = found.contact_without_force;
  }
  return true;
}

}  // namespace

bool simulate_crash(const RefineQuery& q, CandidateState& state, Scratch& scratch, RankWork& work) {
  constexpr int steps_at_a_time = 4;
  constexpr std::int32_t cells_per_bound = cells_per_window / 2;
  const std::size_t index = next_future(q.scene.futures, state);
  FutureScore& future = state.futures[index];
  const FutureScore before = future;
  const RankedCandidate result_before = state.result;
  // A future that is worse than what is sought gives way to the others, until it has to be known
  // better.
  const double shown = 2.0 * future.lower_bound;
  const HarmSample& nominal = q.scene.nominal;
  CrashChain& chain = scratch.chain;
  const Motion& ego = ego_motion(q.scene, q.candidate, index, scratch.ego);
  const Contact first = first_contact_of(q, ego, state.first_hits[future.first]);
  chain.begin(q.scene, ego, index, first, nominal);
  std::size_t bounded_contacts = 0;
  std::int32_t bounded_period = 0;
  bool going = true;
  bool in_time = true;
  const double left =
      leaving_score(q.scene, leaving_of(q, state, ego, scratch), first.time_of_impact_s);
  if (scratch.stopped()) return false;
  const auto bound = [&] {
    chain.effects(scratch.effects, scratch.order);
    future.lower_bound =
        std::max(future.lower_bound, left + scratch.score.lower_bound(q.scene, scratch.effects));
    combine(q, state, scratch);
  };
  while (going) {
    going = chain.advance(steps_at_a_time);
    if (!going) break;
    in_time = !q.deadline.expired();
    const double limit = q.stop_above();
    const bool can_give_way =
        limit < std::numeric_limits<double>::infinity() || q.scene.futures.size() > 1;
    // A bound from time to time, and after every contact, where the simulation ends by it.
    const std::int32_t period = chain.run().current_cell() / cells_per_bound;
    const bool due = bounded_contacts != chain.contacts().size() || bounded_period != period;
    if (!in_time || (due && can_give_way)) {
      bounded_contacts = chain.contacts().size();
      bounded_period = period;
      bound();
    }
    if (!in_time || state.result.interval.lowest > limit) break;
    if (q.scene.futures.size() > 1 && future.lower_bound > std::max(limit, shown)) break;
  }
  future.simulated = std::max(future.simulated, chain.run().work());
  work.crash_steps += chain.run().steps();
  work.crash_pieces += chain.run().work();
  if (!going) {
    const std::optional<std::size_t> unforced =
        actor_without_force(q.scene, ego, index, first, scratch, work);
    if (unforced) {
      chain.effects(scratch.effects, scratch.order);
      future.score = left + scratch.score.score(q.scene, scratch.effects, nominal);
      future.contact_without_force = unforced != no_actor;
    } else {
      in_time = false;
      bound();
    }
  }
  if (!share_score(q.scene, index, state, scratch)) {
    future = before;
    state.result = result_before;
    state.unresolved = true;
    copy_needed(scratch, state);
    return in_time;
  }
  combine(q, state, scratch);
  return in_time;
}

}  // namespace crashrank::detail

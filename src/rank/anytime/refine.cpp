#include "rank/anytime/refine.hpp"

#include "rank/anytime/refine_steps.hpp"
#include "rank/combine_futures.hpp"
#include "rank/manoeuvre.hpp"
#include "rank/measure_table.hpp"
#include "rank/road_leaving.hpp"

#include <algorithm>
#include <exception>
#include <utility>

namespace crashrank::detail {
namespace {

std::uint64_t work_units(const RankWork& work) {
  return work.box_tests + work.impact.bv_tests + work.impact.primitive_tests +
         work.damage.bv_tests + work.damage.primitive_tests + work.paths + work.crash_pieces;
}

}  // namespace

void narrow(CandidateState& state, double lowest, double highest) {
  ScoreInterval& interval = state.result.interval;
  interval.lowest = std::max(interval.lowest, lowest);
  interval.highest = std::max(std::min(interval.highest, highest), interval.lowest);
}

void settle(CandidateState& state, double score) {
  state.result.known = true;
  state.result.score = state.result.estimate = score;
  state.result.interval = {score, score};
}

void combine(const RefineQuery& q, CandidateState& state, Scratch& scratch) {
  const Futures& futures = q.scene.futures;
  bool known = true;
  for (std::size_t f = 0; f < futures.size(); ++f) {
    known = known && (state.futures[f].known() || !(futures.probability(f) > 0.0));
  }
  const auto risk_of_scores = [&](auto score_of) {
    std::vector<double>& scores = scratch.first_s;  // not used between searches
    scores.clear();
    for (const FutureScore& each : state.futures) scores.push_back(score_of(each));
    return risk_of_futures(q.scene, {scores.data(), scores.size()}, scratch.weighted);
  };
  const auto risk_with = [&](auto of_unknown) {
    return risk_of_scores(
        [&](const FutureScore& each) { return each.known() ? each.score : of_unknown(each); });
  };
  const auto lower_bound_of = [](const FutureScore& future) { return future.lower_bound; };
  const double estimate = risk_with(
      [](const FutureScore& future) { return std::max(future.lower_bound, future.estimate); });
  if (known) {
    settle(state, risk_with(lower_bound_of));
    state.result.contact_without_force =
        std::any_of(state.futures.begin(), state.futures.end(),
                    [](const FutureScore& future) { return future.contact_without_force; });
    if (state.result.contact_without_force) {
      state.result.interval.highest =
          std::max(state.result.score, risk_of_scores([&](const FutureScore& each) {
                     if (!each.known()) return each.lower_bound;
                     return each.contact_without_force ? state.upper_bound : each.score;
                   }));
    }
  } else if (futures.size() == 1) {
    narrow(state, state.futures.front().lower_bound, state.result.interval.highest);
  } else {
    // Covers the rounding of sums.
    constexpr double rounding = 1e-12;
    narrow(state, (1.0 - rounding) * risk_with(lower_bound_of),
           (1.0 + rounding) * risk_of_scores([&](const FutureScore& each) {
             const bool is_final = each.known() && !each.contact_without_force;
             return is_final ? each.score : state.upper_bound;
           }));
  }
  const ScoreInterval& interval = state.result.interval;
  state.result.estimate = std::clamp(estimate, interval.lowest, interval.highest);
}

void copy_needed(const Scratch& scratch, CandidateState& state) {
  for (std::size_t i = 0; i < scratch.needed.size(); ++i) {
    if (scratch.needed[i] == 0 || state.needed_count == state.needed.size()) continue;
    state.needed[state.needed_count++] = static_cast<std::uint32_t>(i);
  }
}

void begin_refining(const Scene& scene, const ScoreBounds& bounds, const Candidate& candidate,
                    std::size_t index, Motion& displaced, CandidateState& state) {
  // Keep the memory of the vectors.
  std::vector<FutureScore> futures = std::move(state.futures);
  std::vector<Scratch::Hit> first_hits = std::move(state.first_hits);
  state = {};
  state.futures = std::move(futures);
  state.first_hits = std::move(first_hits);
  state.futures.assign(scene.futures.size(), {});
  state.first_hits.clear();
  state.result.candidate = index;
  // Whether it leaves the road is determined in the first step.
  state.upper_bound = bounds.upper_bound_displaced(scene, candidate.motion, displaced);
  if (scene.road.ends()) state.upper_bound += leaving_score(scene, RoadLeaving{}, no_contact_s);
  state.result.interval = {0.0, state.upper_bound};
  state.result.estimate = state.upper_bound;
  constexpr int times = 4;
  for (int k = 1; k <= times; ++k) {
    const Velocity at = candidate.motion.velocity_at(scene.slice_s.back() * k / times);
    state.speed2 += at.linear_mps.squaredNorm();
    state.turn2 += at.angular_radps.squaredNorm();
  }
}

void bound_as_clear(const Scene& scene, CandidateState& state) {
  const std::optional<RoadLeaving> may_leave =
      scene.road.ends() ? std::optional<RoadLeaving>(RoadLeaving{}) : std::nullopt;
  state.upper_bound = leaving_score(scene, may_leave, no_contact_s);
  narrow(state, 0.0, state.upper_bound);
  state.result.estimate = state.upper_bound;
}

StepResult refine(const RefineQuery& q, CandidateState& state, Scratch& scratch) {
  RankWork work;
  StepResult end;
  scratch.stop = {&Deadline::stop, const_cast<Deadline*>(&q.deadline)};
  switch (state.result.stage) {
    case RankStage::unseen:
      end.finished = find_nearby(q, state, scratch, work);
      break;
    case RankStage::near:
      end.finished = search_contacts(q, state, scratch, work);
      if (!end.finished || !state.needs_refinement()) break;
      [[fallthrough]];
    case RankStage::searched:
    case RankStage::scored:
      if (!scored_by_damage(q.scene.measure)) {
        end.finished = simulate_crash(q, state, scratch, work);
      } else {
        // Not stopped once it has started: its result is needed.
        scratch.stop = {};
        try {
          std::fill(scratch.needed.begin(), scratch.needed.end(), char{0});
          const CandidateResult result = evaluate(q.scene, q.candidate, scratch, work);
          copy_needed(scratch, state);
          if (result.score && state.needed_count == 0) {
            settle(state, *result.score);
            state.result.interval.highest = result.score_interval.highest;
            state.result.contact_without_force = std::any_of(
                result.futures.begin(), result.futures.end(),
                [](const FutureOutcome& future) { return future.contact_without_force; });
          } else {
            state.unresolved = true;
          }
        } catch (const std::exception&) {
          state.unresolved = true;  // out of memory: the interval remains valid
        }
      }
      if (state.result.known) state.result.stage = RankStage::scored;
      break;
  }
  end.work = work_units(work);
  return end;
}

OrderKey key_of(const RankedCandidate& c) noexcept {
  OrderKey key;
  key.demoted = !c.feasible;
  key.score = c.known ? c.score : c.estimate;
  key.known = c.known;
  key.set_collision_probability(c.collision_probability);
  key.collides = c.collides;
  key.grazes = c.grazes;
  key.leaves_road = c.leaves_road;
  key.set_clearance(c.least_distance_m, c.least_time_gap_s, c.time_to_collision_s);
  key.first_s = c.time_of_impact_s;
  key.closing_mps = c.closing_speed_mps;
  key.end_speed_mps = c.end_speed_mps;
  return key;
}

bool ranks_before(const CandidateState& a, const CandidateState& b) noexcept {
  if (a.result.feasible != b.result.feasible) return a.result.feasible;
  if (a.seen() != b.seen()) return a.seen();
  if (a.seen()) {
    const int compared = compare(key_of(a.result), key_of(b.result));
    if (compared != 0) return compared < 0;
    if (a.result.known && b.result.known) return a.result.candidate < b.result.candidate;
  }
  if (a.brakes_harder_than(b) != b.brakes_harder_than(a)) return a.brakes_harder_than(b);
  return a.result.candidate < b.result.candidate;
}

}  // namespace crashrank::detail

#include "rank/anytime/ranker_state.hpp"

#include "rank/nearby_actors.hpp"
#include "rank/order.hpp"
#include "rank/reach.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace crashrank {
namespace {

using detail::Deadline;
using detail::seconds_between;
using detail::StepRounds;

/// Number of waiting candidates that are refined in the first round and at most in a later one. The
/// rounds double: what the first ones find ends the steps of the later ones early.
constexpr std::size_t refined_first = 2;
constexpr std::size_t refined_per_round = 16;

std::uint64_t mix_hash(std::uint64_t hash, std::uint64_t word) {
  // FNV-1a over words, plus a shift so that high bits affect low ones.
  constexpr std::uint64_t prime = 0x100000001b3;
  hash = (hash ^ word) * prime;
  return hash ^ (hash >> 32U);
}

std::uint64_t hash_of(View<const RankedCandidate> ranking) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const RankedCandidate& c : ranking) {
    hash = mix_hash(hash, c.candidate);
    hash = mix_hash(hash, static_cast<std::uint64_t>(c.stage) * 2 + (c.known ? 1 : 0));
    hash = mix_hash(hash, std::bit_cast<std::uint64_t>(c.score));
    hash = mix_hash(hash, std::bit_cast<std::uint64_t>(c.interval.lowest));
    hash = mix_hash(hash, std::bit_cast<std::uint64_t>(c.interval.highest));
  }
  return hash;
}

}  // namespace

Status Ranker::State::check_place(std::size_t actor, bool taken) const {
  if (actor >= places.size() || places[actor] == 0) {
    return make_error(ErrorCode::usage, "the actor keeps no place for others",
                      "prepare the Ranker with an actor of one motion and existence_probability 0");
  }
  if (scene.futures.exists(actor) == taken) return Success{};
  return taken ? make_error(ErrorCode::usage, "nobody has the place", "let somebody enter first")
               : make_error(ErrorCode::usage, "the place is taken", "let its actor leave first");
}

void Ranker::State::set_existence(std::size_t actor, bool exists) noexcept {
  scene.futures.set_existence(actor, exists);
  detail::update_plans(scene, rounds.caller_scratch().impact);
  bounds.limit(scene);
}

bool Ranker::State::collect_results(std::size_t steps, const RankBudget& budget,
                                    std::uint64_t& work) noexcept {
  bool in_time = true;
  for (std::size_t i = 0; i < steps; ++i) {
    const bool affordable = work < budget.work;
    const StepRounds::Done done = rounds.done(i);
    if (affordable && done.state != nullptr) {
      if (done.state->result.known && !states[chosen[i]].result.known) ++known;
      states[chosen[i]] = *done.state;
      for (std::size_t k = 0; k < done.state->needed_count; ++k) {
        needed[done.state->needed[k]] = 1;
        needs_left_out = true;
      }
      work += done.end.work;
    }
    in_time = in_time && affordable && done.state != nullptr && done.end.finished;
    queue.insert(chosen[i], states);
  }
  if (budget.known != nullptr) budget.known->store(known, std::memory_order_relaxed);
  return in_time && !needs_left_out && !rounds.expired();
}

void Ranker::State::refine_all(const RankBudget& budget, RankerEffort& effort) noexcept {
  const auto all = static_cast<std::uint32_t>(rounds.candidates().size());
  bool going = budget.work > 0;
  if (going && all > 1) {
    // Not valid if the ego can be displaced, because the swept boxes are those of its plans.
    if (!scene.futures.displaces_ego() &&
        detail::all_are_clear(scene, rounds.candidates(), rounds.deadline(), effort.work)) {
      for (std::uint32_t i = 0; i < all; ++i) detail::bound_as_clear(scene, states[i]);
    }
    going = effort.work < budget.work && !rounds.expired();
  }
  // Steps of candidates of which nothing is known, and steps of the most promising, in turn.
  bool looks = true;
  std::size_t refined = refined_first;
  while (going) {
    const auto start = Deadline::Clock::now();
    std::size_t steps = looks ? queue.choose_unseen(StepRounds::max_steps, chosen.data()) : 0;
    bool looked = steps > 0;
    if (!looked) {
      steps = queue.choose(states, refined, chosen.data());
      refined = std::min(2 * refined, refined_per_round);
    }
    if (steps == 0) {
      steps = queue.choose_unseen(StepRounds::max_steps, chosen.data());
      looked = steps > 0;
    }
    if (steps == 0) {
      if (budget.first_place_only || !queue.requeue_beaten(states)) break;
      continue;
    }
    const bool deciding = !queue.decided();
    const double limit = deciding ? queue.limit() : std::numeric_limits<double>::infinity();
    rounds.run(states, chosen.data(), steps, limit, deciding);
    going = collect_results(steps, budget, effort.work);
    looks = !looked;
    (looked ? effort.bounds_s : effort.refining_s) +=
        seconds_between(start, Deadline::Clock::now());
  }
}

void Ranker::State::refine_in_futures(View<const Candidate> candidates, const RankBudget& budget,
                                      RankerEffort& effort) noexcept {
  const bool leaves = budget.work > 0 && !rounds.expired();
  if (leaves && detail::leave_out_distant_actors(scene, candidates, rings, effort.work))
    begin(candidates);
  refine_all(budget, effort);
  for (int repeats = 0; detail::include_needed_actors(scene, needed, repeats, rings); ++repeats) {
    begin(candidates);
    refine_all(budget, effort);
  }
}

void Ranker::State::begin(View<const Candidate> candidates) noexcept {
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    detail::begin_refining(scene, bounds, candidates[i], i, displaced, states[i]);
  }
  queue.begin(states, candidates.size());
  known = 0;
  needs_left_out = false;
}

bool Ranker::State::explain_all(View<const Candidate> candidates, const RankerAnswer& answer,
                                const Deadline& deadline, RankResult& result) {
  detail::Scratch scratch;
  const Deadline cancelled = deadline.without_time();
  bool in_time = true;
  for (std::size_t i = 0; i < answer.ranking.size(); ++i) {
    const RankedCandidate& ranked = answer.ranking[i];
    CandidateResult& full = result.ranking[i];
    full = {};
    // What has no contact is found quickly, and its distances order it.
    const bool has_contact = ranked.collides || ranked.collision_probability > 0.0;
    scratch.stop = {&Deadline::stop, const_cast<Deadline*>(has_contact ? &deadline : &cancelled)};
    if (ranked.known && !scratch.stopped()) {
      full = detail::evaluate(scene, candidates[ranked.candidate], scratch, result.work);
    }
    if (!full.score) {
      in_time = in_time && !ranked.known;
      full = {};
      if (ranked.known) full.score = ranked.score;
      full.feasible = ranked.feasible;
      full.collides = ranked.collides;
      full.score_interval = ranked.interval;
      if (ranked.known || ranked.stage >= RankStage::searched) {
        full.searched = true;
        if (!ranked.known) full.score_estimate = ranked.estimate;
        full.collision_probability = ranked.collision_probability;
        if (ranked.collides) {
          full.first_touch = {ranked.actor, ranked.time_of_impact_s, ranked.closing_speed_mps};
        }
      }
    }
    full.candidate = ranked.candidate;
  }
  scratch.add_needed(needed);
  return in_time;
}

void Ranker::State::write_answer(RankerAnswer& answer, std::size_t all) noexcept {
  queue.mark_in_race(states);
  for (std::size_t i = 0; i < all; ++i) ranking[i] = states[i].result;
  const auto begin = ranking.begin();
  std::sort(begin, begin + static_cast<std::ptrdiff_t>(all),
            [&](const RankedCandidate& a, const RankedCandidate& b) {
              return detail::ranks_before(states[a.candidate], states[b.candidate]);
            });
  if (all > 0) {
    const std::uint32_t first = queue.choice(states, answer.basis);
    const auto chosen_place = std::find_if(
        begin, ranking.end(), [&](const RankedCandidate& c) { return c.candidate == first; });
    std::rotate(begin, chosen_place, chosen_place + 1);
  }
  answer.ranking = {ranking.data(), all};
  answer.complete = true;
  RankerEffort& effort = answer.effort;
  for (const RankedCandidate& c : answer.ranking) {
    answer.complete = answer.complete && c.known;
    answer.in_race += c.in_race ? 1 : 0;
    if (!c.known) {
      effort.left_early += c.in_race ? 0 : 1;
    } else if (c.stage == RankStage::near) {
      ++effort.without_search;
    } else if (c.stage == RankStage::searched) {
      ++effort.without_crash;
    } else {
      ++effort.fully_evaluated;
    }
  }
  answer.proved = answer.in_race <= 1;
  answer.hash = hash_of(answer.ranking);
}

}  // namespace crashrank

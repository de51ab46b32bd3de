#include "rank/anytime/candidate_queue.hpp"

#include <algorithm>
#include <numeric>

namespace crashrank::detail {

bool CandidateQueue::goes_first(const std::vector<CandidateState>& states, std::uint32_t a,
                                std::uint32_t b) const {
  if ((a == braking_) != (b == braking_)) return a == braking_;
  return ranks_before(states[a], states[b]);
}

void CandidateQueue::push(const std::vector<CandidateState>& states, std::uint32_t candidate) {
  waiting_.push_back(candidate);
  std::push_heap(waiting_.begin(), waiting_.end(),
                 [&](std::uint32_t a, std::uint32_t b) { return goes_first(states, b, a); });
}

void CandidateQueue::find_braking(const std::vector<CandidateState>& states) {
  const auto precedes = [&](std::uint32_t a, std::uint32_t b) {
    if ((tiers_[a] == demoted) != (tiers_[b] == demoted)) return tiers_[b] == demoted;
    return states[a].brakes_harder_than(states[b]);
  };
  braking_ = 0;
  for (std::uint32_t i = 1; i < count_; ++i) {
    if (precedes(i, braking_)) braking_ = i;
  }
}

void CandidateQueue::begin(const std::vector<CandidateState>& states, std::size_t count) {
  waiting_.clear();
  beaten_.clear();
  count_ = count;
  seen_ = 0;
  resumed_ = false;
  best_known_ = none;
  limits_.fill(std::numeric_limits<double>::infinity());
  counts_ = {0, count, 0};
  tiers_.assign(count, undecided);
  find_braking(states);
  first_seen_ = braking_;
  // Multiples of the golden ratio spread evenly over a circle, however many there are.
  constexpr double golden = 0.6180339887498949;
  stride_ = std::max<std::size_t>(1, static_cast<std::size_t>(golden * static_cast<double>(count)));
  while (std::gcd(stride_, count) > 1) ++stride_;
}

std::size_t CandidateQueue::choose_unseen(std::size_t most, std::uint32_t* chosen) {
  std::size_t steps = 0;
  for (; steps < most && seen_ < count_; ++seen_) {
    chosen[steps++] = static_cast<std::uint32_t>((first_seen_ + seen_ * stride_) % count_);
  }
  return steps;
}

bool CandidateQueue::can_be_first(const CandidateState& state,
                                  const std::vector<CandidateState>& states) const {
  const RankedCandidate& candidate = state.result;
  const Tier first = first_tier();
  if (tier(state) == demoted && first != demoted) return first == undecided;
  const double limit = limit_of(first);
  if (candidate.known) {
    return best_known_ == candidate.candidate && candidate.score <= limit;
  }
  if (candidate.interval.lowest != limit || best_known_ == none) {
    return candidate.interval.lowest <= limit;
  }
  // At equal scores a candidate without contact precedes all with a contact or graze. Its distance
  // from others is known only after its search.
  const OrderKey best = key_of(states[best_known_].result);
  const bool clean = !(best.collision_probability > 0.0) && !best.collides && !best.grazes;
  const bool touches =
      candidate.collision_probability > 0.0 || candidate.collides || candidate.grazes;
  const bool behind =
      (clean && touches) || (best.is_best_of_its_score() && best_known_ < candidate.candidate);
  return !(best.score == limit && behind);
}

std::size_t CandidateQueue::choose(const std::vector<CandidateState>& states, std::size_t most,
                                   std::uint32_t* chosen) {
  const auto later = [&](std::uint32_t a, std::uint32_t b) { return goes_first(states, b, a); };
  std::size_t count = 0;
  while (count < most && !waiting_.empty()) {
    std::pop_heap(waiting_.begin(), waiting_.end(), later);
    const std::uint32_t candidate = waiting_.back();
    waiting_.pop_back();
    if (resumed_ || can_be_first(states[candidate], states)) {
      chosen[count++] = candidate;
    } else {
      beaten_.push_back(candidate);
    }
  }
  return count;
}

void CandidateQueue::insert(std::uint32_t candidate, const std::vector<CandidateState>& states) {
  const RankedCandidate& result = states[candidate].result;
  --counts_[tiers_[candidate]];
  tiers_[candidate] = tier(states[candidate]);
  ++counts_[tiers_[candidate]];
  double& limit = limits_[tiers_[candidate]];
  limit = std::min(limit, result.known ? result.score : result.interval.highest);
  if (result.known &&
      (best_known_ == none || ranks_before(states[candidate], states[best_known_]))) {
    best_known_ = candidate;
  }
  if (tiers_[candidate] == demoted && candidate == braking_) {
    find_braking(states);
    std::make_heap(waiting_.begin(), waiting_.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return goes_first(states, b, a); });
  }
  if (states[candidate].needs_refinement()) push(states, candidate);
}

bool CandidateQueue::requeue_beaten(const std::vector<CandidateState>& states) {
  if (beaten_.empty()) return false;
  resumed_ = true;
  for (const std::uint32_t candidate : beaten_) push(states, candidate);
  beaten_.clear();
  return true;
}

void CandidateQueue::mark_in_race(std::vector<CandidateState>& states) {
  for (std::size_t i = 0; i < count_; ++i) {
    states[i].result.in_race = can_be_first(states[i], states);
  }
}

std::uint32_t CandidateQueue::choice(const std::vector<CandidateState>& states,
                                     RankBasis& basis) const {
  std::uint32_t racing = none;
  std::uint32_t clear = none;
  std::size_t in_race = 0;
  for (std::uint32_t i = 0; i < count_; ++i) {
    const CandidateState& state = states[i];
    if (!state.result.in_race) continue;
    racing = i;
    ++in_race;
    const bool is_clear = state.seen() && tiers_[i] == feasible && !(state.result.estimate > 0.0);
    if (is_clear && (clear == none || ranks_before(state, states[clear]))) clear = i;
  }
  basis = RankBasis::proved;
  if (in_race == 1) return racing;
  basis = RankBasis::simulated;
  const CandidateState& braking = states[braking_];
  if (best_known_ != none && tiers_[best_known_] == first_tier()) {
    const double score = states[best_known_].result.score;
    if (!(score > 0.0) ||
        (clear == none &&
         score <= (braking.result.known ? braking.result.score : braking.result.interval.lowest)))
      return best_known_;
  }
  basis = RankBasis::coarse;
  if (clear != none) return clear;
  basis = braking.result.known ? RankBasis::simulated : RankBasis::braking;
  return braking_;
}

}  // namespace crashrank::detail

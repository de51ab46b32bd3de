#include "rank/anytime/candidate_queue.hpp"

#include <algorithm>

namespace crashrank::detail {

bool CandidateQueue::goes_first(const std::vector<CandidateState>& states, std::uint32_t a,
                                std::uint32_t b) const {
  if ((tiers_[a] == demoted) != (tiers_[b] == demoted)) return tiers_[b] == demoted;
  const ScoreInterval& p = states[a].result.interval;
  const ScoreInterval& q = states[b].result.interval;
  if (p.lowest != q.lowest) return p.lowest < q.lowest;
  // Candidates that were not searched for contacts can be first until they are searched, and a
  // search without contact gives the exact score. So searches come before all simulations.
  const bool unsearched = states[a].result.stage < RankStage::searched;
  if (unsearched != (states[b].result.stage < RankStage::searched)) return unsearched;
  if (p.highest != q.highest) return p.highest < q.highest;
  return a < b;
}

void CandidateQueue::push(const std::vector<CandidateState>& states, std::uint32_t candidate) {
  waiting_.push_back(candidate);
  std::push_heap(waiting_.begin(), waiting_.end(),
                 [&](std::uint32_t a, std::uint32_t b) { return goes_first(states, b, a); });
}

void CandidateQueue::begin(std::size_t count) {
  waiting_.clear();
  beaten_.clear();
  count_ = count;
  resumed_ = false;
  best_known_ = none;
  limits_.fill(std::numeric_limits<double>::infinity());
  counts_ = {0, count, 0};
  tiers_.assign(count, undecided);
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
  const OrderKey best = key_of(states[best_known_].result, false);
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
      (best_known_ == none || ranks_before(result, states[best_known_].result, false))) {
    best_known_ = candidate;
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

}  // namespace crashrank::detail

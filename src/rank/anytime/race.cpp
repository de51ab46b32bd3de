#include "rank/anytime/race.hpp"

#include <algorithm>

namespace crashrank::detail {

bool Race::sooner(const std::vector<Refined>& states, std::uint32_t a, std::uint32_t b) const {
  const ScoreInterval& p = states[a].told.interval;
  const ScoreInterval& q = states[b].told.interval;
  if (p.lowest != q.lowest) return p.lowest < q.lowest;
  // Candidates whose contact was not searched for can be first until they are searched, and a
  // search that finds none settles the score: it comes before all simulations.
  const bool unsearched = states[a].told.stage < RankStage::searched;
  if (unsearched != (states[b].told.stage < RankStage::searched)) return unsearched;
  if (p.highest != q.highest) return p.highest < q.highest;
  return a < b;
}

void Race::push(const std::vector<Refined>& states, std::uint32_t candidate) {
  waiting_.push_back(candidate);
  std::push_heap(waiting_.begin(), waiting_.end(),
                 [&](std::uint32_t a, std::uint32_t b) { return sooner(states, b, a); });
}

void Race::begin(const std::vector<Refined>& states, std::size_t count) {
  waiting_.clear();
  beaten_.clear();
  count_ = count;
  resumed_ = false;
  best_known_ = nobody;
  limit_ = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count; ++i) {
    limit_ = std::min(limit_, states[i].told.interval.highest);
  }
}

bool Race::can_win(const RankedCandidate& candidate, const std::vector<Refined>& states) const {
  if (candidate.known) {
    return best_known_ == candidate.candidate && candidate.score <= limit_;
  }
  if (candidate.interval.lowest != limit_ || best_known_ == nobody) {
    return candidate.interval.lowest <= limit_;
  }
  // At the same score a candidate that touches nothing stands before all that touch or graze, and
  // before those after it.
  const RankedCandidate& best = states[best_known_].told;
  const bool clean = !(best.collision_probability > 0.0) && !best.collides && !best.grazes;
  const bool behind = candidate.collision_probability > 0.0 || candidate.collides ||
                      candidate.grazes || best.candidate < candidate.candidate;
  return !(clean && best.score == limit_ && behind);
}

std::size_t Race::choose(const std::vector<Refined>& states, std::size_t most,
                         std::uint32_t* chosen) {
  const auto later = [&](std::uint32_t a, std::uint32_t b) { return sooner(states, b, a); };
  std::size_t count = 0;
  while (count < most && !waiting_.empty()) {
    std::pop_heap(waiting_.begin(), waiting_.end(), later);
    const std::uint32_t candidate = waiting_.back();
    waiting_.pop_back();
    if (resumed_ || can_win(states[candidate].told, states)) {
      chosen[count++] = candidate;
    } else {
      beaten_.push_back(candidate);
    }
  }
  return count;
}

void Race::put_back(std::uint32_t candidate, const std::vector<Refined>& states) {
  const RankedCandidate& told = states[candidate].told;
  limit_ = std::min(limit_, told.interval.highest);
  if (told.known && (best_known_ == nobody || promises_more(told, states[best_known_].told))) {
    best_known_ = candidate;
  }
  if (states[candidate].open()) push(states, candidate);
}

bool Race::resume(const std::vector<Refined>& states) {
  if (beaten_.empty()) return false;
  resumed_ = true;
  for (const std::uint32_t candidate : beaten_) push(states, candidate);
  beaten_.clear();
  return true;
}

void Race::mark(std::vector<Refined>& states) {
  for (std::size_t i = 0; i < count_; ++i) {
    states[i].told.in_race = can_win(states[i].told, states);
  }
}

}  // namespace crashrank::detail

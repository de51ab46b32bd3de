#include "rank/anytime/race.hpp"

#include <algorithm>

namespace crashrank::detail {

bool Race::sooner(const std::vector<Refined>& states, std::uint32_t a, std::uint32_t b) const {
  if ((tiers_[a] == demoted) != (tiers_[b] == demoted)) return tiers_[b] == demoted;
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

void Race::begin(std::size_t count) {
  waiting_.clear();
  beaten_.clear();
  count_ = count;
  resumed_ = false;
  best_known_ = nobody;
  limits_.fill(std::numeric_limits<double>::infinity());
  counts_ = {0, count, 0};
  tiers_.assign(count, undecided);
}

bool Race::can_win(const Refined& state, const std::vector<Refined>& states) const {
  const RankedCandidate& candidate = state.told;
  const Tier first = tier_of_first();
  if (tier(state) == demoted && first != demoted) return first == undecided;
  const double limit = limit_of(first);
  if (candidate.known) {
    return best_known_ == candidate.candidate && candidate.score <= limit;
  }
  if (candidate.interval.lowest != limit || best_known_ == nobody) {
    return candidate.interval.lowest <= limit;
  }
  // At the same score a candidate that touches nothing stands before all that touch or graze; how
  // far one stays from all others is known only once it is searched.
  const OrderKey best = key_of(states[best_known_].told, false);
  const bool clean = !(best.collision_probability > 0.0) && !best.collides && !best.grazes;
  const bool touches =
      candidate.collision_probability > 0.0 || candidate.collides || candidate.grazes;
  const bool behind =
      (clean && touches) || (best.is_best_of_its_score() && best_known_ < candidate.candidate);
  return !(best.worth == limit && behind);
}

std::size_t Race::choose(const std::vector<Refined>& states, std::size_t most,
                         std::uint32_t* chosen) {
  const auto later = [&](std::uint32_t a, std::uint32_t b) { return sooner(states, b, a); };
  std::size_t count = 0;
  while (count < most && !waiting_.empty()) {
    std::pop_heap(waiting_.begin(), waiting_.end(), later);
    const std::uint32_t candidate = waiting_.back();
    waiting_.pop_back();
    if (resumed_ || can_win(states[candidate], states)) {
      chosen[count++] = candidate;
    } else {
      beaten_.push_back(candidate);
    }
  }
  return count;
}

void Race::put_back(std::uint32_t candidate, const std::vector<Refined>& states) {
  const RankedCandidate& told = states[candidate].told;
  --counts_[tiers_[candidate]];
  tiers_[candidate] = tier(states[candidate]);
  ++counts_[tiers_[candidate]];
  double& limit = limits_[tiers_[candidate]];
  limit = std::min(limit, told.interval.highest);
  if (told.known &&
      (best_known_ == nobody || promises_more(told, states[best_known_].told, false))) {
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
    states[i].told.in_race = can_win(states[i], states);
  }
}

}  // namespace crashrank::detail

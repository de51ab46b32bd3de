#include "rank/choices.hpp"

#include "scenario/motion_order.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

namespace crashrank::detail {

void Choices::prepare(const std::vector<std::uint32_t>& first_plan,
                      const std::vector<double>& existence) {
  first_plan_ = first_plan;
  existence_ = existence;
  total_.assign(existence.size(), 1.0);
  motions_.assign(existence.size(), 0);
  order_.resize(first_plan.back());
  plan_.resize(first_plan.back());
  probability_.resize(first_plan.back());
  choice_of_.assign(first_plan.back(), absent);
}

bool Choices::update(const std::vector<Plan>& plans) {
  bool changed = false;
  for (std::size_t actor = 0; actor < existence_.size(); ++actor) {
    const std::uint32_t begin = first_plan_[actor];
    const std::uint32_t end = first_plan_[actor + 1];
    const auto first = order_.begin() + begin;
    const auto last = order_.begin() + end;
    std::iota(first, last, begin);
    // Equal motions are sorted by probability, so that sums do not depend on the order of plans.
    std::sort(first, last, [&plans](std::uint32_t p, std::uint32_t q) {
      const int order = compare_motions(plans[p].motion, plans[q].motion);
      if (order != 0) return order < 0;
      if (plans[p].probability != plans[q].probability) {
        return plans[p].probability < plans[q].probability;
      }
      return p < q;
    });
    std::uint32_t choice = 0;
    double total = 0.0;
    for (std::uint32_t slot = begin; slot < end; ++slot) {
      const std::uint32_t p = order_[slot];
      const bool repeats =
          slot > begin && compare_motions(plans[order_[slot - 1]].motion, plans[p].motion) == 0;
      if (!repeats) {
        if (slot > begin) ++choice;
        plan_[begin + choice] = p;
        probability_[begin + choice] = 0.0;
      }
      plan_[begin + choice] = std::min(plan_[begin + choice], p);
      probability_[begin + choice] += plans[p].probability;
      total += plans[p].probability;
      changed = changed || choice_of_[p] != choice;
      choice_of_[p] = choice;
    }
    motions_[actor] = choice + 1;
    total_[actor] = total;
    for (std::uint32_t slot = begin; slot <= begin + choice; ++slot) probability_[slot] /= total;
  }
  return changed;
}

std::size_t Choices::count(std::size_t actor) const {
  if (existence_[actor] == 0.0) return 1;
  return motions_[actor] + (existence_[actor] < 1.0 ? 1U : 0U);
}

std::uint32_t Choices::plan(std::size_t actor, std::size_t choice) const {
  return existence_[actor] == 0.0 || choice >= motions_[actor] ? absent
                                                               : plan_[first_plan_[actor] + choice];
}

double Choices::probability(std::size_t actor, std::size_t choice) const {
  return plan(actor, choice) == absent
             ? 1.0 - existence_[actor]
             : existence_[actor] * probability_[first_plan_[actor] + choice];
}

std::size_t Choices::likeliest(std::size_t actor) const {
  return likeliest_of(count(actor), [&](std::size_t choice) { return probability(actor, choice); });
}

double Choices::most_combinations() const {
  constexpr double countable = 1e300;
  double most = 1.0;
  for (std::size_t actor = 0; actor < existence_.size(); ++actor) {
    const double existence = existence_[actor];
    const auto plans = static_cast<double>(plans_of(actor));
    if (existence > 0.0) most = std::min(most * (existence < 1.0 ? plans + 1.0 : plans), countable);
  }
  return most;
}

void JointChoices::prepare(const Scenario& scenario, std::vector<std::uint32_t> plans) {
  actors_ = scenario.actors.size();
  plans_ = std::move(plans);
  for (const JointFuture& future : scenario.futures) weights_.push_back(future.probability);
  actors_order_.resize(actors_);
  std::iota(actors_order_.begin(), actors_order_.end(), 0U);
  std::stable_sort(actors_order_.begin(), actors_order_.end(),
                   [&](std::uint32_t p, std::uint32_t q) {
                     return scenario.actors[p].name < scenario.actors[q].name;
                   });
  order_.resize(weights_.size());
  first_.reserve(weights_.size());
  probability_.reserve(weights_.size());
  future_of_.assign(weights_.size(), Choices::absent);
}

std::uint32_t JointChoices::choice(const Choices& choices, std::size_t written,
                                   std::size_t actor) const {
  const std::uint32_t p = plans_[written * actors_ + actor];
  return p == Choices::absent ? Choices::absent : choices.of_plan(p);
}

int JointChoices::compare(const Choices& choices, std::size_t a, std::size_t b) const {
  for (const std::uint32_t actor : actors_order_) {
    const std::uint32_t p = choice(choices, a, actor);
    const std::uint32_t q = choice(choices, b, actor);
    if (p != q) return p < q ? -1 : 1;
  }
  return 0;
}

bool JointChoices::update(const Choices& choices) {
  std::iota(order_.begin(), order_.end(), 0U);
  std::sort(order_.begin(), order_.end(), [&](std::uint32_t p, std::uint32_t q) {
    const int order = compare(choices, p, q);
    if (order != 0) return order < 0;
    return weights_[p] != weights_[q] ? weights_[p] < weights_[q] : p < q;
  });
  bool changed = false;
  double total = 0.0;
  first_.clear();
  probability_.clear();
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const std::uint32_t written = order_[k];
    if (k == 0 || compare(choices, order_[k - 1], written) != 0) {
      first_.push_back(written);
      probability_.push_back(0.0);
    }
    probability_.back() += weights_[written];
    total += weights_[written];
    const auto future = static_cast<std::uint32_t>(first_.size() - 1);
    changed = changed || future_of_[written] != future;
    future_of_[written] = future;
  }
  for (double& probability : probability_) probability /= total;
  return changed;
}

std::uint32_t JointChoices::plan(const Choices& choices, std::size_t future,
                                 std::size_t actor) const {
  const std::uint32_t own = choice(choices, first_[future], actor);
  return own == Choices::absent ? own : choices.motion_plan(actor, own);
}

std::size_t JointChoices::likeliest() const {
  return likeliest_of(size(), [&](std::size_t future) { return probability_[future]; });
}

}  // namespace crashrank::detail

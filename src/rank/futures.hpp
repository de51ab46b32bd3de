#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/motion/motion.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// A motion that an actor follows in some of the futures.
struct Plan {
  std::size_t actor = 0;
  Motion motion;
  double probability = 1.0;  ///< that the actor follows it, if it exists; not of joint futures
};

/// The futures that candidates are evaluated in, the same for all of them. A future says of every
/// actor which plan it follows, or that it does not exist.
class Futures {
public:
  static constexpr std::uint32_t absent = static_cast<std::uint32_t>(-1);
  /// All combinations of independent predictions are evaluated up to so many, else a sample.
  static constexpr std::size_t most_combinations = 1024;

  /// Reads the motions of a scenario that is checked. Errors: bad_input for poses out of order and
  /// motions beyond `scenario_limits`.
  static Result<Futures> make(const Scenario& scenario, std::size_t sampled);

  std::size_t size() const noexcept { return probability_.size(); }
  /// Probabilities sum to 1. That of the likeliest future is 0 where it is none of a sample.
  double probability(std::size_t future) const { return probability_[future]; }
  /// Index of the plan that an actor follows, or `absent`.
  std::uint32_t plan(std::size_t future, std::size_t actor) const {
    return plan_of_[future * actors_ + actor];
  }
  bool has(std::size_t future, std::size_t plan) const {
    return this->plan(future, plans[plan].actor) == plan;
  }
  /// Whether the plan's actor follows it in a future whose probability is above 0.
  bool is_followed(std::size_t plan) const { return followed_[plan] != 0; }
  /// Each actor follows its likeliest plan; of joint futures the likeliest, of equal ones the
  /// first.
  std::size_t likeliest() const noexcept { return likeliest_; }
  /// Whether an actor exists in every future and follows one plan.
  bool is_certain(std::size_t actor) const;

  /// Removes from `futures`, sorted, those that differ from `future`, which stays, in a plan that
  /// is felt, and appends them to `others`: `felt` by plan.
  void split(std::size_t future, const std::vector<char>& felt, std::vector<std::uint32_t>& futures,
             std::vector<std::uint32_t>& others) const;

  /// Takes other probabilities of the plans, which sum to 1 for each actor, and draws samples anew.
  /// Not of joint futures. Allocates nothing.
  void weigh(View<const double> probabilities);

  std::vector<Plan> plans;  ///< by actor, in their order
  FutureSummary summary;

private:
  void add_joint(const Scenario& scenario);
  void note_followed();
  void add_combinations();
  void add_sample();
  void draw(std::size_t actor);
  /// Of the choice of that index: plans, then not to exist.
  double choice_probability(std::size_t actor, std::size_t choice) const;
  std::size_t choices(std::size_t actor) const;
  std::uint32_t plan_of_choice(std::size_t actor, std::size_t choice) const;
  std::size_t likeliest_choice(std::size_t actor) const;

  std::size_t actors_ = 0;
  std::vector<std::uint32_t> first_plan_;  ///< by actor, and the end
  std::vector<double> existence_;          ///< by actor
  std::vector<std::uint64_t> seed_;        ///< by actor, from its name
  std::vector<double> probability_;        ///< by future
  std::vector<std::uint32_t> plan_of_;     ///< by future and actor
  std::vector<char> followed_;             ///< by plan
  std::vector<std::uint32_t> strata_;      ///< while a sample is drawn
  std::size_t likeliest_ = 0;
};

}  // namespace crashrank::detail

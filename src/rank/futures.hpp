#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/motion/motion.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"
#include "rank/strata.hpp"

#include <algorithm>
#include <array>
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

/// Futures [begin, end) in which the ego follows its candidate in the same way.
struct FutureGroup {
  std::size_t begin = 0;
  std::size_t end = 0;

  std::size_t size() const noexcept { return end - begin; }
};

/// The futures that candidates are evaluated in, the same for all of them. A future says of every
/// actor which plan it follows, or that it does not exist, and how far the ego is off its
/// candidate.
///
/// Behind the scenario's own plans there is one for each drawn future and each actor whose
/// perceived state has errors: the plan that it follows in that future, displaced.
class Futures {
public:
  static constexpr std::uint32_t absent = static_cast<std::uint32_t>(-1);
  /// All combinations of independent predictions are evaluated up to so many, else a sample.
  static constexpr std::size_t max_combinations = 1024;

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
  bool follows(std::size_t future, std::size_t plan) const {
    return this->plan(future, plans[plan].actor) == plan;
  }
  /// Whether the plan's actor follows it in a future whose probability is above 0.
  bool is_followed(std::size_t plan) const { return followed_[plan] != 0; }
  /// How many of the plans are the scenario's own; those behind them are displaced.
  std::size_t own_plans() const noexcept { return own_plans_; }
  bool is_joint() const noexcept { return !joint_.empty(); }
  /// Whether the ego is displaced, otherwise in each drawn future.
  bool displaces_ego() const noexcept { return ego_uncertainty_.any(); }
  /// How far the ego is off its candidate. Only where it is displaced.
  const StateError& ego_error(std::size_t future) const { return ego_errors_[future]; }
  /// The futures in which the ego follows its candidate as it does in this one: all, or it alone.
  FutureGroup group(std::size_t future) const {
    return displaces_ego() ? FutureGroup{future, future + 1} : FutureGroup{0, size()};
  }
  /// The least and the greatest error of the ego's speed, m/s.
  const std::array<double, 2>& ego_speed_errors() const noexcept { return ego_speed_errors_; }
  /// Each actor follows its likeliest plan without errors; of joint futures the likeliest, of equal
  /// ones the first.
  std::size_t likeliest() const noexcept { return likeliest_; }
  /// Whether an actor exists in every future and follows one plan without errors.
  bool is_certain(std::size_t actor) const;

  /// Whether leaving out actors that no candidate reaches may make fewer futures of them.
  bool can_leave_out() const noexcept;
  /// Combines the choices of those actors alone that may be reached: all others do what is
  /// likeliest of them, in every future. Nothing changes where even so there are too many
  /// combinations. Allocates nothing. False where the futures are the ones that they were.
  bool leave_out_unreached(const std::vector<char>& reached);
  /// Whether some actor does what is likeliest of it in every future, since none reaches it.
  bool leaves_out() const noexcept { return summary.left_out > 0; }
  /// Whether one of the plans that are relevant is of an actor that was left out: what was found so
  /// far holds for its likeliest choice alone.
  bool needs_left_out(const std::vector<char>& relevant) const;
  /// How many futures there may be at most, whichever actors are left out.
  std::size_t max_future_count() const noexcept {
    return can_leave_out() ? std::max(size(), max_combinations) : size();
  }

  /// Removes from `futures`, sorted, those that differ from `future`, which stays, in a plan that
  /// is relevant, and appends them to `others`: `relevant` by plan.
  void split(std::size_t future, const std::vector<char>& relevant,
             std::vector<std::uint32_t>& futures, std::vector<std::uint32_t>& others) const;

  /// Takes other probabilities of the plans, which sum to 1 for each actor, and draws samples anew.
  /// Not of joint futures. Allocates nothing.
  void set_probabilities(View<const double> probabilities);

  /// Derives the displaced plans from the scenario's own. Allocates only for timed motions.
  void displace_plans();

  std::vector<Plan> plans;  ///< the scenario's own by actor, in their order; then displaced ones
  FutureSummary summary;

private:
  static constexpr std::uint32_t not_displaced = static_cast<std::uint32_t>(-1);

  void read_joint(const Scenario& scenario);
  void add_joint();
  void read_errors(const Scenario& scenario);
  void mark_followed_plans();
  void list_futures();
  void add_combinations();
  void add_sample();
  void draw(std::size_t actor);
  void draw_joint();
  /// Of the choice of that index: plans, then not to exist.
  double choice_probability(std::size_t actor, std::size_t choice) const;
  std::size_t choices(std::size_t actor) const;
  /// The same; one where the actor is left out: its likeliest.
  std::size_t combined_choices(std::size_t actor) const {
    return left_out_[actor] != 0 ? 1 : choices(actor);
  }
  double count_combinations() const;
  std::uint32_t plan_of_choice(std::size_t actor, std::size_t choice) const;
  std::size_t likeliest_choice(std::size_t actor) const;

  std::size_t actors_ = 0;
  std::vector<std::uint32_t> first_plan_;  ///< by actor, and the end
  std::vector<double> existence_;          ///< by actor
  std::vector<std::uint64_t> seed_;        ///< by actor, from its name
  std::vector<double> probability_;        ///< by future
  std::vector<std::uint32_t> plan_of_;     ///< by future and actor
  std::vector<char> followed_;             ///< by plan
  std::vector<char> left_out_;             ///< by actor
  std::size_t own_plans_ = 0;
  std::vector<double> joint_;               ///< probability of each joint future
  std::vector<std::uint32_t> joint_plans_;  ///< by joint future and actor
  Strata strata_;
  // Of states with errors.
  StateUncertainty ego_uncertainty_;
  std::vector<StateError> ego_errors_;  ///< by future
  std::array<double, 2> ego_speed_errors_{};
  std::vector<std::uint32_t>
      displaced_;                   ///< by actor: its first displaced plan, or `not_displaced`
  std::vector<StateError> errors_;  ///< by displaced plan
  std::vector<std::uint32_t> base_plans_;  ///< by displaced plan: the scenario's own, or `absent`
  std::size_t likeliest_ = 0;
};

}  // namespace crashrank::detail

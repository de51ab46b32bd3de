#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/motion/motion.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"
#include "rank/choices.hpp"
#include "rank/future_sample.hpp"
#include "rank/strata.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// Futures [begin, end) in which the ego has the same motion.
struct FutureGroup {
  std::size_t begin = 0;
  std::size_t end = 0;

  std::size_t size() const noexcept { return end - begin; }
};

/// The futures in which candidates are evaluated, the same for all candidates. A future assigns to
/// every actor a plan or absence, and to the ego the error of its initial state.
///
/// Plans of an actor with the same motion count as one, see `Choices`: futures follow one of them.
/// The plans of the scenario come first. They are followed by displaced plans: for each drawn
/// future and each actor whose perceived state has errors, the plan that it follows in that future,
/// displaced by the drawn error.
class Futures {
public:
  static constexpr std::uint32_t absent = Choices::absent;
  /// Combinations of independent predictions are evaluated exhaustively up to this number, and
  /// sampled above it.
  static constexpr std::size_t max_combinations = 1024;

  /// Makes the futures of a valid scenario. `sampled` is the number of futures to draw if a sample
  /// is needed. Errors: bad_input for poses out of order and motions beyond `scenario_limits`.
  static Result<Futures> make(const Scenario& scenario, std::size_t sampled);

  std::size_t size() const noexcept { return probability_.size(); }
  /// Probability of a future; they sum to 1. With a sample the likeliest future is appended with
  /// probability 0.
  double probability(std::size_t future) const { return probability_[future]; }
  /// Index of the plan that an actor follows in a future, or `absent`.
  std::uint32_t plan(std::size_t future, std::size_t actor) const {
    return plan_of_[future * actors_ + actor];
  }
  bool follows(std::size_t future, std::size_t plan) const {
    return this->plan(future, plans[plan].actor) == plan;
  }
  /// Returns true if the actor of the plan follows it in a future with a probability above 0.
  bool is_followed(std::size_t plan) const { return followed_[plan] != 0; }
  /// Number of plans of the scenario; the plans behind them are displaced.
  std::size_t own_plans() const noexcept { return own_plans_; }
  /// Probability that the actor of a plan of the scenario follows it, given that it exists.
  /// Without meaning for joint futures.
  double plan_probability(std::size_t plan) const { return choices_.plan_probability(plans[plan]); }
  bool is_joint() const noexcept { return !joint_.empty(); }
  /// Returns true if the initial state of the ego has errors, which differ between the drawn
  /// futures.
  bool displaces_ego() const noexcept { return ego_uncertainty_.any(); }
  /// Error of the initial state of the ego in a future. Requires `displaces_ego`.
  const StateError& ego_error(std::size_t future) const { return ego_errors_[future]; }
  /// Group of the futures in which the ego has the same motion as in `future`: all futures, or this
  /// one alone if the ego is displaced.
  FutureGroup group(std::size_t future) const {
    return displaces_ego() ? FutureGroup{future, future + 1} : FutureGroup{0, size()};
  }
  /// Smallest and largest error of the speed of the ego over all futures, m/s.
  const std::array<double, 2>& ego_speed_errors() const noexcept { return ego_speed_errors_; }
  /// Index of the likeliest future: each actor has its likeliest choice, without errors. Of joint
  /// futures the most probable one. Of equally probable ones the first in the order of their
  /// motions, see `Choices` and `JointChoices`.
  std::size_t likeliest() const noexcept { return likeliest_; }
  /// Returns true if an actor exists in every future and has one plan without errors.
  bool is_certain(std::size_t actor) const;

  /// Returns false if an actor exists in no future: nothing depends on its motion then.
  bool exists(std::size_t actor) const { return existence_[actor] > 0.0; }
  /// Returns true if an actor exists in no future and has one plan, so that `set_existence` can let
  /// it exist without allocating.
  bool can_enter(std::size_t actor) const {
    return !exists(actor) && !is_joint() && first_plan_[actor + 1] - first_plan_[actor] == 1;
  }
  /// Index of the first plan of an actor.
  std::size_t first_plan(std::size_t actor) const { return first_plan_[actor]; }
  /// Lets an actor with one plan exist in every future or in none, and lists the futures again.
  void set_existence(std::size_t actor, bool exists);

  /// Returns true if the number of futures can be reduced by leaving out actors that no candidate
  /// reaches.
  bool can_leave_out() const noexcept;
  /// Combines only the choices of the actors whose entry in `ring` is at most `last`; all others
  /// have their likeliest choice in every future and are left out. If too many combinations remain
  /// even so, or states have errors, no actor is left out, and the sample spends no futures on what
  /// is improbable of those that are not reached. Does not allocate. Returns false if the futures
  /// did not change.
  bool leave_out_beyond(const std::vector<char>& ring, char last);
  /// Returns true if an actor has its likeliest choice in every future because no candidate reaches
  /// it.
  bool leaves_out() const noexcept { return summary.left_out > 0; }
  /// Marks in `needed`, by actor, those that were left out and have a relevant plan. Results then
  /// hold only for the likeliest choice of these actors and must be computed again without leaving
  /// them out. Returns true if there are any.
  bool mark_needed(const std::vector<char>& relevant, std::vector<char>& needed) const;
  /// Number of combinations of the choices of the actors whose entry in `ring` is at most `last`.
  double combinations_within(const std::vector<char>& ring, char last) const;
  /// Upper bound on the number of futures, for any set of actors that are left out and any motions.
  std::size_t max_future_count() const noexcept { return max_future_count_; }

  /// Partitions the sorted list `futures` by outcome: futures with the same relevant plans as
  /// `future` stay, the others are appended to `others`. `relevant` is indexed by plan.
  void split(std::size_t future, const std::vector<char>& relevant,
             std::vector<std::uint32_t>& futures, std::vector<std::uint32_t>& others) const;

  /// Sets the probabilities of the plans, which must sum to 1 for each actor, and draws samples
  /// again. Not for joint futures. Does not allocate.
  void set_probabilities(View<const double> probabilities);

  /// Updates the futures after a change of `plans`: which motions are equal, and the displaced
  /// plans. Allocates only for timed motions.
  void update_motions();

  /// plans of the scenario ordered by actor, followed by the displaced plans
  std::vector<Plan> plans;
  FutureSummary summary;

private:
  static constexpr std::uint32_t not_displaced = static_cast<std::uint32_t>(-1);

  void read_joint(const Scenario& scenario);
  void add_joint();
  void read_errors(const Scenario& scenario);
  void mark_followed_plans();
  void list_futures();
  void leave_out();
  void reserve();
  void add_combinations();
  void add_sample();
  void draw_plans();
  /// Compares the motions of all plans. Returns true if the choices changed.
  bool update_choices();
  void displace_plans();
  /// Number of choices that are combined: 1, the likeliest, if the actor is left out.
  std::size_t combined_choices(std::size_t actor) const {
    return left_out_[actor] != 0 ? 1 : choices_.count(actor);
  }
  double count_combinations() const;

  std::size_t actors_ = 0;
  std::vector<std::uint32_t> first_plan_;  ///< by actor, plus the end
  std::vector<double> existence_;          ///< by actor
  std::vector<std::uint64_t> seed_;        ///< by actor, derived from its name
  std::vector<std::size_t> by_seed_;       ///< actors sorted by seed
  std::vector<double> probability_;        ///< by future
  std::vector<std::uint32_t> plan_of_;     ///< by future and actor
  std::vector<char> followed_;             ///< by plan
  std::vector<char> left_out_;             ///< by actor
  std::vector<char> reached_;  ///< by actor: a candidate comes near, or it has one choice
  std::size_t own_plans_ = 0;
  std::size_t max_future_count_ = 1;
  Choices choices_;
  JointChoices joint_;
  Strata strata_;
  FutureSample sample_;
  // The members below are used if states have errors.
  StateUncertainty ego_uncertainty_;
  std::vector<StateError> ego_errors_;  ///< by future
  std::array<double, 2> ego_speed_errors_{};
  std::vector<std::uint32_t>
      displaced_;  ///< by actor: index of its first displaced plan, or `not_displaced`
  std::vector<StateError> errors_;  ///< by displaced plan
  /// by displaced plan: index of the plan of the scenario, or `absent`
  std::vector<std::uint32_t> base_plans_;
  std::size_t likeliest_ = 0;
};

}  // namespace crashrank::detail

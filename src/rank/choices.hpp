#pragma once

#include "crashrank/motion/motion.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// A motion that an actor follows in some futures.
struct Plan {
  std::size_t actor = 0;
  Motion motion;
  /// weight of the plan among those of its actor, given that it exists; unused for joint futures
  double probability = 1.0;
};

/// The choices of each actor: its distinct motions in the order of `compare_motions`, then absence
/// if it may be absent. Plans with the same motion are one choice with the sum of their
/// probabilities, so that neither their order nor how often a motion is written has an effect.
class Choices {
public:
  static constexpr std::uint32_t absent = static_cast<std::uint32_t>(-1);

  /// Allocates. `first_plan` has the first plan of each actor and the end, `existence` the
  /// probability that an actor exists.
  void prepare(const std::vector<std::uint32_t>& first_plan, const std::vector<double>& existence);
  /// Compares the motions of all plans and adds up their probabilities. Returns true if the choices
  /// changed, apart from their probabilities. Does not allocate.
  bool update(const std::vector<Plan>& plans);
  void set_existence(std::size_t actor, double probability) { existence_[actor] = probability; }

  std::size_t count(std::size_t actor) const;
  /// Plan that has the motion of a choice, or `absent`.
  std::uint32_t plan(std::size_t actor, std::size_t choice) const;
  /// Plan that has the motion of a choice other than absence, even of an actor that never exists.
  std::uint32_t motion_plan(std::size_t actor, std::size_t choice) const {
    return plan_[first_plan_[actor] + choice];
  }
  double probability(std::size_t actor, std::size_t choice) const;
  /// The most probable choice of an actor, the first of equally probable ones.
  std::size_t likeliest(std::size_t actor) const;
  /// Choice to which a plan belongs.
  std::uint32_t of_plan(std::size_t plan) const { return choice_of_[plan]; }
  /// Probability of a plan, given that its actor exists.
  double plan_probability(const Plan& plan) const { return plan.probability / total_[plan.actor]; }
  /// Number of combinations if all plans had different motions.
  double most_combinations() const;

private:
  std::size_t plans_of(std::size_t actor) const {
    return first_plan_[actor + 1] - first_plan_[actor];
  }

  std::vector<std::uint32_t> first_plan_;  ///< by actor, plus the end
  std::vector<double> existence_;          ///< by actor
  std::vector<double> total_;              ///< by actor: sum of the weights of its plans
  std::vector<std::uint32_t> motions_;     ///< by actor: number of distinct motions
  std::vector<std::uint32_t> order_;       ///< plans in the order of their motions, by actor
  /// By first plan of the actor + choice: the plan, and the probability given that it exists.
  std::vector<std::uint32_t> plan_;
  std::vector<double> probability_;
  std::vector<std::uint32_t> choice_of_;  ///< by plan
};

/// Joint futures without repetitions: those in which every actor has the same choice are one, with
/// the sum of their probabilities. Ordered by the choices of the actors in the order of their
/// names, so that the order in which futures are written has no effect.
class JointChoices {
public:
  /// Allocates. `plans` has the plan of each actor in each future of the scenario.
  void prepare(const Scenario& scenario, std::vector<std::uint32_t> plans);
  bool empty() const noexcept { return weights_.empty(); }
  /// Number of futures of the scenario.
  std::size_t written() const noexcept { return weights_.size(); }
  /// Merges and sorts the futures. Returns true if they changed. Does not allocate.
  bool update(const Choices& choices);

  std::size_t size() const noexcept { return probability_.size(); }
  double probability(std::size_t future) const { return probability_[future]; }
  /// Plan of an actor in a future, or `Choices::absent`.
  std::uint32_t plan(const Choices& choices, std::size_t future, std::size_t actor) const;
  /// The most probable future, the first of equally probable ones.
  std::size_t likeliest() const;

private:
  std::uint32_t choice(const Choices& choices, std::size_t written, std::size_t actor) const;
  int compare(const Choices& choices, std::size_t a, std::size_t b) const;

  std::size_t actors_ = 0;
  std::vector<double> weights_;              ///< by written future
  std::vector<std::uint32_t> plans_;         ///< by written future and actor
  std::vector<std::uint32_t> actors_order_;  ///< actors sorted by name
  std::vector<std::uint32_t> order_;         ///< written futures, sorted
  std::vector<std::uint32_t> first_;         ///< by future: one of the written ones
  std::vector<double> probability_;          ///< by future
  std::vector<std::uint32_t> future_of_;     ///< by written future
};

}  // namespace crashrank::detail

#pragma once

#include "crashrank/rank/future_summary.hpp"
#include "rank/strata.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// Draws a sample of futures from independent variables: the choice of each actor, or one of the
/// joint futures. Every choice of a variable that matters occurs in the sample, however improbable,
/// and each future has the probability that it stands for. Other variables are drawn as stated; in
/// the following only those that matter are meant.
///
/// If there are at most a quarter as many combinations as futures, every combination is a stratum:
/// half of the futures are divided equally among them, half in proportion to their probabilities,
/// and the futures of a stratum share its probability. What differs between them are errors of
/// states.
///
/// Otherwise futures are drawn from a mixture. Half of them are divided among the choices that a
/// Latin hypercube may miss: each has such a choice, and all its other choices are drawn as
/// stated. The other half, or all if there is no such choice, are drawn as stated. A future weighs
/// what makes the sum over the sample unbiased: the ratio of its stated probability to that under
/// the mixture (the balance heuristic of Veach & Guibas 1995). If there are few choices, weights
/// are then adjusted until every choice has its stated probability (iterative proportional fitting,
/// Deming & Stephan 1940).
class FutureSample {
public:
  /// Allocates for a number of futures, of variables and of all their choices; nothing else does.
  void prepare(std::size_t futures, std::size_t variables, std::size_t choices);
  std::size_t futures() const noexcept { return futures_; }

  /// Removes all variables.
  void clear() noexcept;
  /// Adds a variable without choices. `seed` determines what is drawn for it.
  void add_variable(std::uint64_t seed, bool matters = true);
  /// Adds a choice to the last variable; the probabilities of its choices must sum to 1.
  void add_choice(double probability);

  /// Draws all futures.
  void draw(Strata& strata);
  std::size_t choice(std::size_t future, std::size_t variable) const {
    return choice_[future * variables() + variable];
  }
  /// Probability and stratum by future, valid until the next draw. The probabilities sum to 1.
  const std::vector<DrawnFuture>& drawn() const noexcept { return drawn_; }
  /// Variables to whose probabilities those of the futures are fitted, valid until the next draw.
  const FittedChoices& fitted() const noexcept { return fitted_; }
  /// Number of choices that no future has, of variables that matter: those beyond the most probable
  /// ones if more than half as many choices as there are futures may be missed; any of a single
  /// variable with so many.
  std::size_t undrawn() const noexcept { return undrawn_; }

private:
  struct Choice {
    std::uint32_t variable = 0;
    std::uint32_t index = 0;  ///< within the variable
    double probability = 0.0;
    std::uint32_t futures = 0;  ///< number of futures that must have it
  };

  std::size_t variables() const noexcept { return seed_.size(); }
  std::size_t count(std::size_t variable) const {
    const std::size_t end =
        variable + 1 < first_.size() ? first_[variable + 1] : probability_.size();
    return end - first_[variable];
  }
  double probability(std::size_t variable, std::size_t choice) const {
    return probability_[first_[variable] + choice];
  }
  double combinations() const;
  void draw_combinations(std::size_t combinations);
  void draw_mixture(Strata& strata);
  void divide_among_rare_choices();
  void draw_choices(std::size_t variable, Strata& strata);
  void weigh_mixture();
  void fit_probabilities();
  void normalise();
  void count_undrawn();

  std::size_t futures_ = 0;
  std::vector<std::uint64_t> seed_;    ///< by variable
  std::vector<char> matters_;          ///< by variable
  std::vector<std::size_t> first_;     ///< by variable: its first choice
  std::vector<double> probability_;    ///< by choice
  std::vector<std::uint32_t> choice_;  ///< by future and variable
  std::vector<DrawnFuture> drawn_;     ///< by future
  FittedChoices fitted_;
  std::size_t undrawn_ = 0;
  std::vector<Choice> rare_;  ///< choices to which futures of the mixture are allotted
  /// By choice: number of futures allotted to it; by future: index of the choice it must have.
  std::vector<double> allotted_;
  std::vector<std::uint32_t> must_;
  std::vector<double> sum_;  ///< by choice: working memory
};

}  // namespace crashrank::detail

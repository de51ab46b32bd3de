#include "rank/future_sample.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

constexpr auto none = static_cast<std::uint32_t>(-1);

}  // namespace

void FutureSample::prepare(std::size_t futures, std::size_t variables, std::size_t choices) {
  futures_ = futures;
  seed_.reserve(variables);
  matters_.reserve(variables);
  first_.reserve(variables);
  probability_.reserve(choices);
  choice_.reserve(futures * variables);
  drawn_.resize(futures);
  fitted_.choices.reserve(futures * variables);
  rare_.reserve(choices);
  allotted_.reserve(choices);
  must_.resize(futures);
  sum_.reserve(choices);
}

void FutureSample::clear() noexcept {
  seed_.clear();
  matters_.clear();
  first_.clear();
  probability_.clear();
}

void FutureSample::add_variable(std::uint64_t seed, bool matters) {
  seed_.push_back(seed);
  matters_.push_back(matters ? 1 : 0);
  first_.push_back(probability_.size());
}

void FutureSample::add_choice(double probability) { probability_.push_back(probability); }

double FutureSample::combinations() const {
  constexpr double countable = 1e300;
  double product = 1.0;
  for (std::size_t v = 0; v < variables(); ++v) {
    if (matters_[v] == 0) continue;
    product = std::min(product * static_cast<double>(count(v)), countable);
  }
  return product;
}

void FutureSample::draw(Strata& strata) {
  choice_.assign(futures_ * variables(), 0);
  std::fill(must_.begin(), must_.end(), none);
  fitted_.actors = 0;
  fitted_.choices.clear();
  // Two futures for every combination at least: an error can be stated.
  const double most = std::max(1.0, std::floor(static_cast<double>(futures_) / 4.0));
  if (const double all = combinations(); all <= most) {
    draw_combinations(static_cast<std::size_t>(all));
    for (std::size_t v = 0; v < variables(); ++v) {
      if (matters_[v] == 0) draw_choices(v, strata);
    }
  } else {
    draw_mixture(strata);
  }
  count_undrawn();
}

void FutureSample::draw_combinations(std::size_t combinations) {
  const auto total = static_cast<double>(futures_);
  // A combination ends where the running sum of the shares of it and those before ends, rounded:
  // no combination gets less than its share, rounded down.
  double end = 0.0;
  std::size_t f = 0;
  for (std::size_t c = 0; c < combinations; ++c) {
    double probability = 1.0;
    std::size_t rest = c;
    for (std::size_t v = 0; v < variables(); ++v) {
      if (matters_[v] == 0) continue;
      probability *= this->probability(v, rest % count(v));
      rest /= count(v);
    }
    end += 0.5 * total * (probability + 1.0 / static_cast<double>(combinations));
    const std::size_t until = c + 1 == combinations
                                  ? futures_
                                  : std::min(futures_, static_cast<std::size_t>(std::llround(end)));
    const DrawnFuture drawn{probability / static_cast<double>(std::max<std::size_t>(until - f, 1)),
                            static_cast<std::uint32_t>(c)};
    for (; f < until; ++f) {
      rest = c;
      for (std::size_t v = 0; v < variables(); ++v) {
        if (matters_[v] == 0) continue;
        choice_[f * variables() + v] = static_cast<std::uint32_t>(rest % count(v));
        rest /= count(v);
      }
      drawn_[f] = drawn;
    }
  }
  normalise();
}

/// Allots half of the futures to the choices that a Latin hypercube of that many may miss.
void FutureSample::divide_among_rare_choices() {
  // A probability of two strata covers one of them at least; half of the futures or more are drawn
  // freely for every variable. In the smallest samples, what is more probable than not is not rare.
  constexpr double never_rare = 0.5;
  const double rare = std::min(4.0 / static_cast<double>(futures_), never_rare);
  rare_.clear();
  for (std::size_t v = 0; v < variables(); ++v) {
    for (std::size_t k = 0; matters_[v] != 0 && k < count(v); ++k) {
      if (!(probability(v, k) < rare)) continue;
      rare_.push_back(
          {static_cast<std::uint32_t>(v), static_cast<std::uint32_t>(k), probability(v, k), 0});
    }
  }
  const std::size_t half = futures_ / 2;
  // Choices of one variable exclude each other: what some are given, the others lose.
  if (rare_.size() > half && variables() == 1) rare_.clear();
  if (rare_.size() > half) {
    // The seed is the actor's name: the order of actors has no effect.
    std::sort(rare_.begin(), rare_.end(), [this](const Choice& a, const Choice& b) {
      if (a.probability != b.probability) return a.probability > b.probability;
      if (seed_[a.variable] != seed_[b.variable]) return seed_[a.variable] < seed_[b.variable];
      return a.index < b.index;
    });
    rare_.resize(half);
  }
  allotted_.assign(probability_.size(), 0.0);
  if (rare_.empty()) return;
  const std::size_t each = half / rare_.size();
  std::size_t f = futures_;
  for (std::size_t r = 0; r < rare_.size(); ++r) {
    rare_[r].futures = static_cast<std::uint32_t>(each);
    allotted_[first_[rare_[r].variable] + rare_[r].index] = static_cast<double>(each);
    for (std::size_t k = 0; k < each; ++k) must_[--f] = static_cast<std::uint32_t>(r);
  }
}

void FutureSample::draw_choices(std::size_t variable, Strata& strata) {
  const auto fixed = [&](std::size_t f) {
    return must_[f] != none && rare_[must_[f]].variable == variable;
  };
  std::size_t free = 0;
  for (std::size_t f = 0; f < futures_; ++f) free += fixed(f) ? 0U : 1U;
  const std::vector<double>& shares = strata.draw(seed_[variable], free);
  std::size_t next = 0;
  for (std::size_t f = 0; f < futures_; ++f) {
    std::size_t choice = 0;
    if (fixed(f)) {
      choice = rare_[must_[f]].index;
    } else {
      const double share = shares[next++];
      double cumulative = 0.0;
      for (; choice + 1 < count(variable); ++choice) {
        cumulative += probability(variable, choice);
        if (share < cumulative) break;
      }
    }
    choice_[f * variables() + variable] = static_cast<std::uint32_t>(choice);
  }
}

void FutureSample::draw_mixture(Strata& strata) {
  divide_among_rare_choices();
  for (std::size_t v = 0; v < variables(); ++v) {
    if (count(v) > 1) draw_choices(v, strata);
  }
  weigh_mixture();
  normalise();
  fit_probabilities();
}

void FutureSample::weigh_mixture() {
  double freely = static_cast<double>(futures_);
  for (const Choice& rare : rare_) freely -= rare.futures;
  for (std::size_t f = 0; f < futures_; ++f) {
    // Ratio of the expected number of such futures in the mixture to their stated probability.
    double ratio = freely;
    for (std::size_t v = 0; v < variables(); ++v) {
      const std::size_t c = first_[v] + choice(f, v);
      if (allotted_[c] > 0.0) ratio += allotted_[c] / probability_[c];
    }
    drawn_[f] = {1.0 / ratio, 0};
  }
}

/// Adjusts the probabilities of the futures until every choice that occurs has its stated one.
void FutureSample::fit_probabilities() {
  // More conditions than a quarter of the futures could leave all the weight with a few of them.
  std::size_t conditions = 0;
  for (std::size_t v = 0; v < variables(); ++v) {
    if (matters_[v] != 0) conditions += count(v) - 1;
  }
  if (conditions > futures_ / 4) return;
  constexpr int most_rounds = 400;
  constexpr double fitted = 1e-13;
  for (int round = 0; round < most_rounds; ++round) {
    double worst = 0.0;
    for (std::size_t v = 0; v < variables(); ++v) {
      if (count(v) == 1 || matters_[v] == 0) continue;
      sum_.assign(count(v), 0.0);
      for (std::size_t f = 0; f < futures_; ++f) sum_[choice(f, v)] += drawn_[f].probability;
      double occurring = 0.0;
      for (std::size_t k = 0; k < count(v); ++k) {
        if (sum_[k] > 0.0) occurring += probability(v, k);
      }
      for (std::size_t k = 0; k < count(v); ++k) {
        if (!(sum_[k] > 0.0)) continue;
        sum_[k] = probability(v, k) / occurring / sum_[k];
        worst = std::max(worst, std::abs(sum_[k] - 1.0));
      }
      for (std::size_t f = 0; f < futures_; ++f) drawn_[f].probability *= sum_[choice(f, v)];
    }
    if (worst <= fitted) break;
  }
  normalise();
  for (std::size_t v = 0; v < variables(); ++v) {
    if (count(v) > 1 && matters_[v] != 0) ++fitted_.actors;
  }
  for (std::size_t f = 0; f < futures_; ++f) {
    for (std::size_t v = 0; v < variables(); ++v) {
      if (count(v) == 1 || matters_[v] == 0) continue;
      fitted_.choices.push_back(static_cast<std::uint32_t>(choice(f, v)));
    }
  }
}

void FutureSample::normalise() {
  double sum = 0.0;
  for (const DrawnFuture& drawn : drawn_) sum += drawn.probability;
  for (DrawnFuture& drawn : drawn_) drawn.probability /= sum;
}

void FutureSample::count_undrawn() {
  undrawn_ = 0;
  for (std::size_t v = 0; v < variables(); ++v) {
    if (matters_[v] == 0) continue;
    sum_.assign(count(v), 0.0);
    for (std::size_t f = 0; f < futures_; ++f) sum_[choice(f, v)] = 1.0;
    undrawn_ += static_cast<std::size_t>(std::count(sum_.begin(), sum_.end(), 0.0));
  }
}

}  // namespace crashrank::detail

#include "rank/sampling_error.hpp"

#include "rank/risk.hpp"

#include <Eigen/Core>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

namespace crashrank::detail {
namespace {

/// Scores of the same crash in two futures differ by rounding only, some 1e-16 of the score.
constexpr double score_rounding = 1e-12;

/// Whether the scores of so many drawn futures say how much another sample would change the risk.
bool has_sampling_error(const RiskMeasure& risk, std::size_t sampled) {
  const auto count = static_cast<double>(sampled);
  if (!(count > 1.0)) return false;
  constexpr double least_in_tail = 10.0;
  return risk.kind == RiskKind::expected ||
         (risk.kind == RiskKind::cvar && !(count * (1.0 - risk.level) < least_in_tail));
}

/// What the score of a future adds to the mean, or to the mean of the tail above the quantile
/// `from`.
double contribution(const RiskMeasure& risk, double score, double from) {
  return risk.kind == RiskKind::cvar ? std::max(score - from, 0.0) / (1.0 - risk.level) : score;
}

/// The quantile above which scores count; 0 for the mean.
double tail_begin(const FutureSummary& sample, View<const double> scores) {
  if (sample.risk.kind != RiskKind::cvar) return 0.0;
  std::vector<WeightedScore> weighted;
  weighted.reserve(sample.drawn.size());
  for (std::size_t f = 0; f < sample.drawn.size(); ++f) {
    weighted.push_back({scores[f], sample.drawn[f].probability});
  }
  return quantile_of(sample.risk.level, weighted);
}

/// What an explanation leaves of values in the drawn futures.
struct Unexplained {
  bool any = false;    ///< values of a stratum, or of the fitted futures, differ beyond rounding
  double error = 0.0;  ///< standard error of the sum of the values, each times its probability
};

/// The mean of every stratum explains its values; futures of a stratum are neighbours.
template <class Value>
Unexplained beside_strata(const std::vector<DrawnFuture>& drawn, const Value& value,
                          double largest) {
  Unexplained left;
  double variance = 0.0;
  for (std::size_t begin = 0, end = 0; begin < drawn.size(); begin = end) {
    double weight = 0.0;
    double mean = 0.0;
    for (; end < drawn.size() && drawn[end].stratum == drawn[begin].stratum; ++end) {
      weight += drawn[end].probability;
      mean += drawn[end].probability * value(end);
      left.any = left.any || std::abs(value(end) - value(begin)) > score_rounding * largest;
    }
    if (end - begin < 2 || !(weight > 0.0)) continue;
    mean /= weight;
    double squares = 0.0;
    for (std::size_t f = begin; f < end; ++f) {
      const double away = drawn[f].probability * (value(f) - mean);
      squares += away * away;
    }
    const auto count = static_cast<double>(end - begin);
    variance += squares * count / (count - 1.0);
  }
  left.error = std::sqrt(variance);
  return left;
}

/// Greatest number of what each fitted actor does.
std::vector<std::uint32_t> last_choices(const FittedChoices& fitted) {
  std::vector<std::uint32_t> last(fitted.actors, 0);
  for (std::size_t k = 0; k < fitted.choices.size(); ++k) {
    std::uint32_t& known = last[k % fitted.actors];
    known = std::max(known, fitted.choices[k]);
  }
  return last;
}

/// The columns of a least-squares fit of values by what the fitted actors do, times the root of the
/// future's probability: a constant, and every choice of an actor but its first.
Eigen::MatrixXd fit_columns(const FittedChoices& fitted, const Eigen::VectorXd& root) {
  const std::vector<std::uint32_t> last = last_choices(fitted);
  const auto choices = std::accumulate(last.begin(), last.end(), Eigen::Index{0});
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(root.size(), 1 + choices);
  columns.col(0) = root;
  auto choice = fitted.choices.begin();
  for (Eigen::Index f = 0; f < root.size(); ++f) {
    Eigen::Index before = 0;
    for (const std::uint32_t count : last) {
      if (*choice > 0) columns(f, before + *choice) = root[f];
      before += count;
      ++choice;
    }
  }
  return columns;
}

/// Sums over what the fitted actors do have no error, so that only what the best sum of that kind
/// leaves of the values has one (calibration estimators: Deville & Särndal 1992). A residual
/// understates the error by the share with which its own value determines the fit: MacKinnon &
/// White 1985, HC2.
///
/// Residuals know only what was drawn together. Two choices of 10 and 30 % miss each other in one
/// of seven samples of 64, and what they do together is then in no residual. So the error is at
/// least that of two more futures that lie as far from the mean as any that was drawn.
template <class Value>
Unexplained beside_fit(const FutureSummary& sample, const Value& value, double largest) {
  const auto count = static_cast<Eigen::Index>(sample.drawn.size());
  Eigen::VectorXd root(count);
  Eigen::VectorXd values(count);
  for (Eigen::Index f = 0; f < count; ++f) {
    root[f] = std::sqrt(sample.drawn[static_cast<std::size_t>(f)].probability);
    values[f] = root[f] * value(static_cast<std::size_t>(f));
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(fit_columns(sample.fitted, root));
  const Eigen::MatrixXd basis =
      factors.householderQ() * Eigen::MatrixXd::Identity(count, factors.rank());
  const Eigen::VectorXd residual = values - basis * (basis.transpose() * values);
  constexpr double more_futures = 2.0;
  // A future that alone has a choice has no residual: as without a fit.
  constexpr double alone = 1e-6;
  const double mean = root.dot(values);
  double variance = 0.0;
  double furthest = 0.0;
  for (Eigen::Index f = 0; f < count; ++f) {
    const double free = 1.0 - basis.row(f).squaredNorm();
    const bool is_alone = free < alone;
    const double away = is_alone ? values[f] - root[f] * mean : residual[f];
    furthest = std::max(furthest, std::abs(value(static_cast<std::size_t>(f)) - mean));
    const double part = root[f] * away;
    variance += part * part / (is_alone ? 1.0 : free);
  }
  return {furthest > score_rounding * largest,
          std::hypot(std::sqrt(variance), more_futures / static_cast<double>(count) * furthest)};
}

template <class Value>
Unexplained unexplained(const FutureSummary& sample, const Value& value, double largest) {
  // The fit takes the product of the futures and the square of the choices in time; with more than
  // these the error is stated as without it.
  constexpr std::uint32_t most_choices = 64;
  const std::vector<std::uint32_t> last = last_choices(sample.fitted);
  const std::uint32_t choices = std::accumulate(last.begin(), last.end(), 0U);
  return choices > 0 && choices <= most_choices ? beside_fit(sample, value, largest)
                                                : beside_strata(sample.drawn, value, largest);
}

}  // namespace

std::optional<double> sampling_error(const FutureSummary& sample, View<const double> scores) {
  if (!has_sampling_error(sample.risk, sample.drawn.size())) return std::nullopt;
  double worst = 0.0;
  for (std::size_t f = 0; f < sample.drawn.size(); ++f) worst = std::max(worst, scores[f]);
  const double from = tail_begin(sample, scores);
  const Unexplained left = unexplained(
      sample, [&](std::size_t f) { return contribution(sample.risk, scores[f], from); }, worst);
  return left.any ? std::optional<double>(left.error) : std::nullopt;
}

std::optional<double> difference_error(const FutureSummary& sample, View<const double> a,
                                       View<const double> b) {
  double worst = 0.0;
  for (std::size_t f = 0; f < sample.drawn.size(); ++f) worst = std::max({worst, a[f], b[f]});
  const auto apart = [&](std::size_t f) { return a[f] - b[f]; };
  if (!unexplained(sample, apart, worst).any) return 0.0;
  if (!has_sampling_error(sample.risk, sample.drawn.size())) return std::nullopt;
  const double from_a = tail_begin(sample, a);
  const double from_b = tail_begin(sample, b);
  const auto contributed = [&](std::size_t f) {
    return contribution(sample.risk, a[f], from_a) - contribution(sample.risk, b[f], from_b);
  };
  return unexplained(sample, contributed, worst).error;
}

}  // namespace crashrank::detail

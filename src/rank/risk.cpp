#include "rank/risk.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

double mean_of(const std::vector<WeightedScore>& scores) {
  double sum = 0.0;
  for (const WeightedScore& s : scores) sum += s.probability * s.score;
  return sum;
}

/// Smallest score that is not exceeded with probability `level`. Sorts the scores.
double quantile_of(double level, std::vector<WeightedScore>& scores) {
  std::sort(scores.begin(), scores.end(), [](const WeightedScore& p, const WeightedScore& q) {
    return p.score != q.score ? p.score < q.score : p.probability < q.probability;
  });
  // Tolerance for the rounding of sums of probabilities.
  constexpr double rounding = 1e-12;
  double reached = 0.0;
  double last = 0.0;
  for (const WeightedScore& s : scores) {
    if (!(s.probability > 0.0)) continue;
    reached += s.probability;
    last = s.score;
    if (reached >= level - rounding) return s.score;
  }
  return last;
}

double worst_of(const std::vector<WeightedScore>& scores) {
  double worst = 0.0;
  for (const WeightedScore& s : scores) {
    if (s.probability > 0.0) worst = std::max(worst, s.score);
  }
  return worst;
}

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
double tail_begin(const RiskMeasure& risk, View<const double> scores,
                  const std::vector<DrawnFuture>& drawn) {
  if (risk.kind != RiskKind::cvar) return 0.0;
  std::vector<WeightedScore> weighted;
  weighted.reserve(drawn.size());
  for (std::size_t f = 0; f < drawn.size(); ++f) {
    weighted.push_back({scores[f], drawn[f].probability});
  }
  return quantile_of(risk.level, weighted);
}

/// Calls `visit` with begin and end of every stratum: its futures are neighbours.
template <class Visit>
void for_each_stratum(const std::vector<DrawnFuture>& drawn, const Visit& visit) {
  for (std::size_t begin = 0, end = 0; begin < drawn.size(); begin = end) {
    while (end < drawn.size() && drawn[end].stratum == drawn[begin].stratum) ++end;
    visit(begin, end);
  }
}

/// Whether values of one stratum differ by more than the rounding of scores of up to `largest`.
template <class Value>
bool differs_within_strata(const std::vector<DrawnFuture>& drawn, const Value& value,
                           double largest) {
  bool differs = false;
  for_each_stratum(drawn, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin + 1; f < end; ++f) {
      differs = differs || std::abs(value(f) - value(begin)) > score_rounding * largest;
    }
  });
  return differs;
}

/// Standard error of the sum of the values, each times its probability.
template <class Value>
double error_within_strata(const std::vector<DrawnFuture>& drawn, const Value& value) {
  double variance = 0.0;
  for_each_stratum(drawn, [&](std::size_t begin, std::size_t end) {
    if (end - begin < 2) return;
    double weight = 0.0;
    double mean = 0.0;
    for (std::size_t f = begin; f < end; ++f) {
      weight += drawn[f].probability;
      mean += drawn[f].probability * value(f);
    }
    if (!(weight > 0.0)) return;
    mean /= weight;
    double squares = 0.0;
    for (std::size_t f = begin; f < end; ++f) {
      const double away = drawn[f].probability * (value(f) - mean);
      squares += away * away;
    }
    const auto count = static_cast<double>(end - begin);
    variance += squares * count / (count - 1.0);
  });
  return std::sqrt(variance);
}

}  // namespace

double risk_of(const RiskMeasure& risk, std::vector<WeightedScore>& scores) {
  if (scores.size() == 1) return scores.front().score;
  switch (risk.kind) {
    case RiskKind::expected:
      return mean_of(scores);
    case RiskKind::worst:
      return worst_of(scores);
    case RiskKind::quantile:
      return quantile_of(risk.level, scores);
    case RiskKind::cvar: {
      // Rockafellar & Uryasev 2002: the quantile plus the mean excess over it. This splits the
      // future at the border of the tail.
      const double quantile = quantile_of(risk.level, scores);
      double excess = 0.0;
      for (const WeightedScore& s : scores) {
        excess += s.probability * std::max(s.score - quantile, 0.0);
      }
      // If the probability of the tail is below the rounding tolerance of the quantile, the
      // quantile plus the mean excess can exceed the worst score: limit it.
      return std::min(quantile + excess / (1.0 - risk.level), worst_of(scores));
    }
  }
  return mean_of(scores);
}

std::optional<double> sampling_error(const RiskMeasure& risk, View<const double> scores,
                                     const std::vector<DrawnFuture>& drawn) {
  if (!has_sampling_error(risk, drawn.size())) return std::nullopt;
  const auto score = [&](std::size_t f) { return scores[f]; };
  double worst = 0.0;
  for (std::size_t f = 0; f < drawn.size(); ++f) worst = std::max(worst, scores[f]);
  if (!differs_within_strata(drawn, score, worst)) return std::nullopt;
  const double from = tail_begin(risk, scores, drawn);
  return error_within_strata(drawn,
                             [&](std::size_t f) { return contribution(risk, scores[f], from); });
}

std::optional<double> difference_error(const RiskMeasure& risk, View<const double> a,
                                       View<const double> b,
                                       const std::vector<DrawnFuture>& drawn) {
  double worst = 0.0;
  for (std::size_t f = 0; f < drawn.size(); ++f) worst = std::max({worst, a[f], b[f]});
  const auto apart = [&](std::size_t f) { return a[f] - b[f]; };
  if (!differs_within_strata(drawn, apart, worst)) return 0.0;
  if (!has_sampling_error(risk, drawn.size())) return std::nullopt;
  const double from_a = tail_begin(risk, a, drawn);
  const double from_b = tail_begin(risk, b, drawn);
  return error_within_strata(drawn, [&](std::size_t f) {
    return contribution(risk, a[f], from_a) - contribution(risk, b[f], from_b);
  });
}

}  // namespace crashrank::detail

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

std::optional<double> sampling_error(const RiskMeasure& risk, std::vector<WeightedScore>& scores,
                                     std::size_t sampled) {
  if (risk.kind != RiskKind::expected && risk.kind != RiskKind::cvar) return std::nullopt;
  const bool tail = risk.kind == RiskKind::cvar;
  constexpr double least_in_tail = 10.0;
  const auto count = static_cast<double>(sampled);
  if (tail && count * (1.0 - risk.level) < least_in_tail) return std::nullopt;
  const double from = tail ? quantile_of(risk.level, scores) : 0.0;
  const auto value = [&](const WeightedScore& s) {
    return tail ? std::max(s.score - from, 0.0) / (1.0 - risk.level) : s.score;
  };
  // Equal scores say nothing about the variance of futures that were not drawn.
  double least = worst_of(scores);
  for (const WeightedScore& s : scores) {
    if (s.probability > 0.0) least = std::min(least, s.score);
  }
  if (!(count > 1.0) || least == worst_of(scores)) return std::nullopt;
  double mean = 0.0;
  for (const WeightedScore& s : scores) mean += s.probability * value(s);
  double variance = 0.0;
  for (const WeightedScore& s : scores) {
    variance += s.probability * (value(s) - mean) * (value(s) - mean);
  }
  return std::sqrt(variance / (count - 1.0));
}

}  // namespace crashrank::detail

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
  if (!has_sampling_error(risk, sampled)) return std::nullopt;
  const bool tail = risk.kind == RiskKind::cvar;
  const auto count = static_cast<double>(sampled);
  const double from = tail ? quantile_of(risk.level, scores) : 0.0;
  const auto value = [&](const WeightedScore& s) { return contribution(risk, s.score, from); };
  // Equal scores say nothing about the variance of futures that were not drawn.
  const double worst = worst_of(scores);
  double least = worst;
  for (const WeightedScore& s : scores) {
    if (s.probability > 0.0) least = std::min(least, s.score);
  }
  if (worst - least <= score_rounding * worst) return std::nullopt;
  double mean = 0.0;
  for (const WeightedScore& s : scores) mean += s.probability * value(s);
  double variance = 0.0;
  for (const WeightedScore& s : scores) {
    variance += s.probability * (value(s) - mean) * (value(s) - mean);
  }
  return std::sqrt(variance / (count - 1.0));
}

std::optional<double> difference_error(const RiskMeasure& risk, const std::vector<double>& a,
                                       const std::vector<double>& b) {
  bool alike = true;
  for (std::size_t f = 1; f < a.size(); ++f) {
    const double other = std::abs(a[f] - b[f] - (a[0] - b[0]));
    alike = alike && other <= score_rounding * std::max({a[f], b[f], a[0], b[0]});
  }
  if (alike) return 0.0;
  if (!has_sampling_error(risk, a.size())) return std::nullopt;
  const auto quantile = [&risk](const std::vector<double>& scores) {
    if (risk.kind != RiskKind::cvar) return 0.0;
    std::vector<WeightedScore> weighted;
    weighted.reserve(scores.size());
    for (const double score : scores) {
      weighted.push_back({score, 1.0 / static_cast<double>(scores.size())});
    }
    return quantile_of(risk.level, weighted);
  };
  const double from_a = quantile(a);
  const double from_b = quantile(b);
  const auto difference = [&](std::size_t f) {
    return contribution(risk, a[f], from_a) - contribution(risk, b[f], from_b);
  };
  const auto count = static_cast<double>(a.size());
  double mean = 0.0;
  for (std::size_t f = 0; f < a.size(); ++f) mean += difference(f) / count;
  double variance = 0.0;
  for (std::size_t f = 0; f < a.size(); ++f) {
    variance += (difference(f) - mean) * (difference(f) - mean) / count;
  }
  return std::sqrt(variance / (count - 1.0));
}

}  // namespace crashrank::detail

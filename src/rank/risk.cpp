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

double worst_of(const std::vector<WeightedScore>& scores) {
  double worst = 0.0;
  for (const WeightedScore& s : scores) {
    if (s.probability > 0.0) worst = std::max(worst, s.score);
  }
  return worst;
}

}  // namespace

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

}  // namespace crashrank::detail

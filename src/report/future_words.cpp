#include "report/future_words.hpp"

#include "report/score_text.hpp"

#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/harm_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <optional>

namespace crashrank::detail {
namespace {

std::string risk_words(const RiskMeasure& risk) {
  switch (risk.kind) {
    case RiskKind::expected:
      return "A score is the mean over all futures, weighted by their probability.";
    case RiskKind::cvar:
      return fmt::format("A score is the mean over the worst {:g} % of the futures.",
                         100.0 * (1.0 - risk.level));
    case RiskKind::worst:
      return "A score is that of the worst future.";
    case RiskKind::quantile:
      return fmt::format("A score is the least that is not exceeded with {:g} %.",
                         100.0 * risk.level);
  }
  return {};
}

std::string small_error_words() {
  return fmt::format(", and small ones where none are stated ({:g} m, {:.1f}°, {:g} m/s)",
                     small_errors.position_m, small_errors.heading_rad * (180.0 / std::numbers::pi),
                     small_errors.speed_mps);
}

std::string method_words(const FutureSummary& summary) {
  switch (summary.method) {
    case FutureMethod::certain:
      return {};
    case FutureMethod::joint:
      return fmt::format("{} joint futures are listed.", summary.futures);
    case FutureMethod::all:
      return fmt::format("All {} combinations of predictions{} are evaluated.", summary.futures,
                         summary.left_out == 0
                             ? std::string()
                             : fmt::format(" that matter ({} of the others {} too far away)",
                                           summary.left_out, summary.left_out == 1 ? "is" : "are"));
    case FutureMethod::sampled:
      if (summary.has_state_errors) {
        return fmt::format(
            "{} futures are drawn{}, with the stated errors of positions, headings and speeds of "
            "the ego and of perceived actors{}; they are the same for all candidates and in every "
            "run.",
            summary.sampled,
            summary.combinations > 1.0
                ? fmt::format(" of {:.3g} combinations of predictions", summary.combinations)
                : std::string(),
            summary.smooth ? small_error_words() : std::string());
      }
      return fmt::format(
          "Of {:.3g} combinations of predictions {} are drawn, the same for all candidates and in "
          "every run.",
          summary.combinations, summary.sampled);
  }
  return {};
}

std::string error_words(const RankResult& result) {
  std::optional<double> most;
  for (const CandidateResult& ranked : result.ranking) {
    if (ranked.sampling_error) most = std::max(most.value_or(0.0), *ranked.sampling_error);
  }
  // With 95 % what is more probable is drawn at least once (1 - (1 - p)^N).
  const double seldom =
      1.0 -
      std::pow(0.05, 1.0 / static_cast<double>(std::max<std::size_t>(1, result.futures.sampled)));
  const FutureSummary& futures = result.futures;
  std::string missing =
      futures.undrawn == 0
          ? std::string(
                " Every prediction and absence near a candidate is drawn, however improbable;")
          : fmt::format(" Predictions, absences or joint futures that are not drawn: {};",
                        futures.undrawn);
  missing += fmt::format(" {} that happen with less than {:.2g} % may not be drawn at all.",
                         futures.has_state_errors ? "combinations of these and errors of states"
                                                  : "combinations of these",
                         100.0 * seldom);
  if (!most) return "What the choice of the sample leaves open of a score is not known." + missing;
  return fmt::format("Another sample may change a score by a standard error of up to {:.2g} {}.",
                     *most, measure_unit(result.measure)) +
         missing;
}

/// The body that a candidate hits first with the largest probability over all futures.
struct LikeliestBody {
  double probability = 0.0;
  const FutureOutcome* likeliest = nullptr;  ///< its most probable collision; null: none at all
};
LikeliestBody likeliest_body(const CandidateResult& ranked) {
  std::map<std::size_t, LikeliestBody> bodies;
  for (const FutureOutcome& future : ranked.futures) {
    if (!future.collides || !(future.probability > 0.0)) continue;
    LikeliestBody& body = bodies[future.actor];
    body.probability += future.probability;
    if (body.likeliest == nullptr || future.probability > body.likeliest->probability) {
      body.likeliest = &future;
    }
  }
  // Sums that differ by rounding are equal: the first in the order of the actors.
  constexpr double rounding = 1e-9;
  LikeliestBody most;
  for (const auto& [actor, body] : bodies) {
    if (body.probability > most.probability + rounding) most = body;
  }
  return most;
}

/// Says which body the ego hits first in the futures that make most of an expected score, where
/// that is not the one that is hit most probably.
std::string costliest_words(const Scenario& scenario, const RankResult& result,
                            const CandidateResult& ranked, std::size_t likeliest_actor) {
  if (result.futures.risk.kind != RiskKind::expected || !ranked.score || !(*ranked.score > 0.0)) {
    return {};
  }
  std::map<std::size_t, double> shares;
  for (const FutureOutcome& future : ranked.futures) {
    if (future.collides) shares[future.actor] += future.probability * future.score / *ranked.score;
  }
  const auto most =
      std::max_element(shares.begin(), shares.end(),
                       [](const auto& p, const auto& q) { return p.second < q.second; });
  constexpr double rounding = 1e-9;
  if (most == shares.end() || most->second < shares[likeliest_actor] + rounding) return {};
  return fmt::format(" {} of its score comes from futures in which it hits {} first.",
                     percent_text(most->second), scenario.actors[most->first].name);
}

/// Whom candidates hit that touch nothing in the likeliest future.
void add_collisions(const Scenario& scenario, const RankResult& result,
                    std::vector<std::string>& words) {
  constexpr std::size_t most = 6;
  std::size_t told = 0;
  for (const CandidateResult& ranked : result.ranking) {
    const LikeliestBody body = likeliest_body(ranked);
    const FutureOutcome* const hit = body.likeliest;
    if (ranked.collides || hit == nullptr || ++told > most) continue;
    words.push_back(fmt::format(
        "“{}” touches nothing in the likeliest future, but collides with a probability of {}; most "
        "probably with {} ({}), likeliest after {:.3f} s, closing with {} m/s.{}",
        result.candidates[ranked.candidate].name, percent_text(ranked.collision_probability),
        scenario.actors[hit->actor].name, percent_text(body.probability), hit->time_of_impact_s,
        fixed_text(hit->closing_speed_mps, 1),
        costliest_words(scenario, result, ranked, hit->actor)));
  }
  if (told > most) words.push_back(fmt::format("So do {} more.", told - most));
}

}  // namespace

const char* future_method_name(FutureMethod method) {
  switch (method) {
    case FutureMethod::certain:
      return "certain";
    case FutureMethod::joint:
      return "joint";
    case FutureMethod::all:
      return "all";
    case FutureMethod::sampled:
      return "sampled";
  }
  return "certain";
}

double likeliest_score(const CandidateResult& ranked) {
  return ranked.futures.empty() ? ranked.score.value_or(0.0) : ranked.futures.front().score;
}

std::vector<std::string> future_words(const Scenario& scenario, const RankResult& result) {
  const FutureSummary& summary = result.futures;
  if (summary.method == FutureMethod::certain) return {};
  std::vector<std::string> words{
      method_words(summary) + " " + risk_words(summary.risk) +
      " Contacts and damage are those of the likeliest future; distances and "
      "times to others are the least of all futures."};
  if (!result.complete || result.ranking.empty()) return words;
  if (summary.method == FutureMethod::sampled) words.push_back(error_words(result));
  // What the vehicle cannot follow would stand behind the others there, too.
  const auto demoted = [&](const CandidateResult& ranked) {
    return !ranked.feasible && result.infeasible != Infeasible::keep;
  };
  const auto best = std::min_element(result.ranking.begin(), result.ranking.end(),
                                     [&](const CandidateResult& p, const CandidateResult& q) {
                                       if (demoted(p) != demoted(q)) return demoted(q);
                                       return likeliest_score(p) < likeliest_score(q);
                                     });
  if (likeliest_score(*best) < likeliest_score(result.ranking.front())) {
    const std::size_t last = result.ranking.back().place;
    words.push_back(fmt::format(
        "Against the likeliest future alone “{}” would be first ({:.3g} {}); over all futures it "
        "is {} ({:.3g}).",
        result.candidates[best->candidate].name, likeliest_score(*best),
        measure_unit(result.measure),
        best->place == last ? std::string("in the last place")
                            : fmt::format("in place {} of {}", best->place, last),
        *best->score));
  }
  add_collisions(scenario, result, words);
  return words;
}

}  // namespace crashrank::detail

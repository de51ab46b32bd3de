#include "report/score_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

/// The decimal place of the first digit that an interval of that width leaves open.
int open_place(double width) { return static_cast<int>(std::floor(std::log10(width))); }

std::string at_place(double value, int place) {
  const double step = std::pow(10.0, place);
  if (place >= 0) return fmt::format("{:.0f}", std::round(value / step) * step);
  return fmt::format("{:.{}f}", value, std::min(-place, 12));
}

double width_of(const CandidateResult& ranked) {
  return ranked.score_interval.highest - ranked.score_interval.lowest;
}

/// Differences of rounding are no interval.
bool is_open(const CandidateResult& ranked) {
  return width_of(ranked) > 1e-9 * std::abs(ranked.score_interval.highest);
}

}  // namespace

std::string score_text(const CandidateResult& ranked) {
  if (!ranked.score) {
    return fmt::format("{:.3g} to {:.3g}", ranked.score_interval.lowest,
                       ranked.score_interval.highest);
  }
  if (!is_open(ranked)) return fmt::format("{:.5g}", *ranked.score);
  return at_place(*ranked.score, open_place(width_of(ranked)));
}

std::string interval_text(const CandidateResult& ranked) {
  if (!ranked.score || !is_open(ranked)) return {};
  const int place = open_place(width_of(ranked));
  const double step = std::pow(10.0, place);
  // An end that is a multiple of the step but for rounding stays there.
  constexpr double slack = 1e-9;
  return at_place(std::floor(ranked.score_interval.lowest / step + slack) * step, place) + " to " +
         at_place(std::ceil(ranked.score_interval.highest / step - slack) * step, place);
}

std::string places_text(const CandidateResult& ranked) {
  if (ranked.best_place == ranked.worst_place) return std::to_string(ranked.best_place + 1);
  return fmt::format("{}-{}", ranked.best_place + 1, ranked.worst_place + 1);
}

std::vector<std::string> not_separable_words(const RankResult& result, std::size_t shown) {
  std::vector<std::string> words;
  for (std::size_t place = 0; place + 1 < std::min(shown, result.ranking.size()); ++place) {
    const CandidateResult& ranked = result.ranking[place];
    if (ranked.separable) continue;
    words.push_back(fmt::format(
        "rank {} and {} not separable (their order turns round in {:.0f} % of {} samples)",
        place + 1, place + 2, 100.0 * ranked.overtaken, result.samples.size()));
  }
  return words;
}

std::vector<std::string> harm_words(const HarmOptions& harm) {
  const HarmWeights& w = harm.weights;
  const HarmRanges& r = harm.ranges;
  std::vector<std::string> lines;
  lines.push_back(fmt::format(
      "Harm counts {} by the curves of {}; the weights are a choice that somebody answers for: ego "
      "occupant {:g}, other occupant {:g}, pedestrian {:g}, cyclist {:g}, motorcyclist {:g}, a MJ "
      "of deformation {:g}.",
      risk_outcome(harm.model), risk_model_name(harm.model), w.ego_occupant, w.other_occupant,
      w.pedestrian, w.cyclist, w.motorcyclist, w.property_per_mj));
  lines.push_back(
      fmt::format("People: {:g} in the ego, {:g} in a car, {:g} in a truck, {:g} in a bus.",
                  w.people_in_ego, w.people_in_car, w.people_in_truck, w.people_in_bus));
  lines.push_back(fmt::format(
      "Friction {:g} ({:g} to {:g}); ranges: stiffness x {:g} to {:g}, restitution {:g} to {:g}, "
      "speed of the risk curves x {:g} to {:g}, {}. After a contact: {:g} m/s2 for {:g} s at most, "
      "{} contacts at most.",
      harm.friction, r.least_friction, r.most_friction, r.least_strength, r.most_strength,
      r.least_restitution, r.most_restitution, r.least_risk_speed, r.most_risk_speed,
      r.all_models ? "order under all four risk models" : "this risk model alone",
      harm.after.deceleration_mps2, harm.after.longest_s, harm.after.most_contacts));
  return lines;
}

}  // namespace crashrank::detail

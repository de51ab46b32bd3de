#include "report/page_rows.hpp"

#include "crashrank/internal/report/escape.hpp"
#include "report/decision.hpp"
#include "report/manoeuvre_words.hpp"
#include "report/ranking_words.hpp"
#include "report/score_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace crashrank::detail {
namespace {

using Json = nlohmann::ordered_json;

/// "lorry", "wall (overlaps at start), second, wall / third"; of all contacts in the likeliest
/// future.
std::string hit_names(const Scenario& scenario, const CandidateResult& ranked) {
  std::string names;
  for (const std::size_t actor : hit_actors(ranked)) {
    names += names.empty() ? contact_name(scenario, ranked.contacts.front())
                           : ", " + scenario.actors[actor].name;
  }
  for (const FurtherPair& pair : further_pairs(ranked)) {
    names += ", " + pair_name(scenario, *pair.first);
  }
  return names;
}

/// "lorry and 1 crash between others", "3 more"; nothing where all is said with the first.
std::string more_words(const Scenario& scenario, const CandidateResult& ranked) {
  const std::vector<std::size_t> hit = hit_actors(ranked);
  const std::size_t pairs = further_pairs(ranked).size();
  std::string words;
  if (hit.size() == 2) words = scenario.actors[hit[1]].name;
  if (hit.size() > 2) words = fmt::format("{} more", hit.size() - 1);
  if (pairs > 0) {
    words += fmt::format("{}{} crash{} between others", words.empty() ? "" : " and ", pairs,
                         pairs == 1 ? "" : "es");
  }
  return words;
}

/// "nothing; keeps 7.0 m and 1.9 s from van"; it touches nothing in any future.
std::string kept_words(const Scenario& scenario, const CandidateResult& ranked) {
  const auto from = [&](std::size_t actor) { return " from " + scenario.actors[actor].name; };
  std::string words;
  if (ranked.nearest) {
    words = fmt::format("; keeps {:.1f} m", *ranked.least_distance_m);
    if (ranked.nearest != ranked.soonest) words += from(*ranked.nearest);
  }
  if (ranked.soonest) {
    words += fmt::format("{}{:.1f} s{}", words.empty() ? "; keeps " : " and ",
                         *ranked.least_time_gap_s, from(*ranked.soonest));
  }
  return "nothing" + words;
}

}  // namespace

std::string contact_words(const Scenario& scenario, const CandidateResult& ranked, bool in_short) {
  const auto when = [](double time_s, double speed_mps) {
    return fmt::format(" after {:.2f} s at {:.0f} km/h", time_s, 3.6 * speed_mps);
  };
  std::string words;
  if (ranked.first_touch) {
    const FirstTouch& touch = *ranked.first_touch;
    words =
        scenario.actors[touch.actor].name + when(touch.time_of_impact_s, touch.closing_speed_mps);
  } else if (ranked.contacts.empty()) {
    const bool is_clear =
        ranked.score && ranked.grazes.empty() && ranked.collision_probability == 0.0;
    words = is_clear ? kept_words(scenario, ranked) : passing_words(scenario, ranked);
  } else {
    const Contact& first = ranked.contacts.front();
    const std::string name = contact_name(scenario, first);
    const std::string brush = brush_words(ranked);
    words = (brush.empty() ? "" : "glances off ") + name +
            when(first.time_of_impact_s, first.closing_speed_mps) + brush;
    const std::string others = in_short ? ", " + more_words(scenario, ranked)
                                        : hit_names(scenario, ranked).substr(name.size());
    if (others.size() > 2) words += "; then" + others.substr(1);
  }
  if (ranked.futures.size() < 2 || !(ranked.collision_probability > 0.0)) return words;
  const std::string probability = percent_text(ranked.collision_probability);
  if (ranked.collides) {
    if (probability != "100 %") words += "; probability of a crash " + probability;
    return words;
  }
  const FutureOutcome* hit = nullptr;
  for (const FutureOutcome& future : ranked.futures) {
    if (future.collides && (hit == nullptr || future.probability > hit->probability)) hit = &future;
  }
  words += " in the likeliest future";
  if (hit == nullptr) return words;
  const std::string contact =
      scenario.actors[hit->actor].name + when(hit->time_of_impact_s, hit->closing_speed_mps);
  return words + (probability == percent_text(hit->probability)
                      ? fmt::format("; but {} with a probability of {}", contact, probability)
                      : fmt::format("; a crash with a probability of {}, likeliest {}", probability,
                                    contact));
}

PageRow page_row(const Scenario& scenario, const RankResult& result,
                 const std::vector<std::string>& scores, std::size_t place) {
  const CandidateResult& ranked = result.ranking[place];
  const Candidate& candidate = result.candidates[ranked.candidate];
  PageRow row;
  row.place = std::to_string(ranked.place);
  if (ranked.sharing > 1) {
    row.bracket = "tied";
  } else if (!ranked.separable && place + 1 < result.ranking.size()) {
    row.bracket = "near";
  }
  row.name = candidate.name;
  row.manoeuvre = plain_manoeuvre(scenario, candidate);
  row.score = scores[place];
  row.interval = interval_text(ranked);
  row.value = ranked.score.value_or(ranked.score_estimate.value_or(ranked.score_interval.highest));
  row.lowest = ranked.score_interval.lowest;
  row.highest = std::max(row.value, ranked.score_interval.highest);
  row.contact = contact_words(scenario, ranked, false);
  if (ranked.first_touch) {
    row.time_s = ranked.first_touch->time_of_impact_s;
  } else if (!ranked.contacts.empty()) {
    row.time_s = ranked.contacts.front().time_of_impact_s;
  }
  row.warnings = manoeuvre_mark(ranked);
  const auto warn = [&row](const char* words) {
    row.warnings += (row.warnings.empty() ? "" : ", ") + std::string(words);
  };
  if (std::any_of(ranked.contacts.begin(), ranked.contacts.end(),
                  [](const Contact& contact) { return contact.contact_without_force; })) {
    warn("a contact without force");
  }
  if (ranked.crowded) warn("more contacts than are simulated");
  return row;
}

double full_bar(const RankResult& result) {
  double most = 0.0;
  for (const CandidateResult& ranked : result.ranking) {
    const double score = ranked.score.value_or(ranked.score_interval.highest);
    if (std::isfinite(score)) most = std::max(most, score);
  }
  return most;
}

Json row_json(const PageRow& row) {
  const auto number = [](double value) {
    return std::isfinite(value) ? Json(std::stod(fmt::format("{:.4g}", value))) : Json(nullptr);
  };
  // The name of a listed manoeuvre is its description.
  const bool is_named = row.name == row.manoeuvre;
  return {row.place,
          row.bracket,
          escape_terminal(row.name),
          is_named ? std::string() : escape_terminal(row.manoeuvre),
          row.score,
          row.interval,
          number(row.value),
          number(row.lowest),
          number(row.highest),
          escape_terminal(row.contact),
          number(row.time_s),
          escape_terminal(row.warnings)};
}

Json stability_json(const RankResult& result) {
  constexpr std::size_t most_rows = 10;
  const std::size_t samples = range_sample_count(result);
  const std::size_t shown = std::min(most_rows, result.ranking.size());
  if (samples < 2 || shown < 2) return nullptr;
  std::vector<std::vector<double>> columns(samples);
  for (const CandidateResult& ranked : result.ranking) {
    if (ranked.sample_scores.size() < samples || !ranked.feasible) continue;
    for (std::size_t i = 0; i < samples; ++i) columns[i].push_back(ranked.sample_scores[i]);
  }
  for (std::vector<double>& column : columns) std::sort(column.begin(), column.end());
  // The nominal sample first, then those of each risk model together.
  std::vector<std::size_t> order(samples);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin() + 1, order.end(), [&result](std::size_t p, std::size_t q) {
    return result.samples[p].model < result.samples[q].model;
  });
  Json names = Json::array();
  Json places = Json::array();
  for (std::size_t row = 0; row < shown; ++row) {
    const CandidateResult& ranked = result.ranking[row];
    if (ranked.sample_scores.size() < samples || !ranked.feasible) continue;
    Json line = Json::array();
    for (const std::size_t i : order) {
      const auto before =
          std::lower_bound(columns[i].begin(), columns[i].end(), ranked.sample_scores[i]);
      line.push_back(before - columns[i].begin() + 1);
    }
    names.push_back(escape_terminal(result.candidates[ranked.candidate].name));
    places.push_back(std::move(line));
  }
  if (places.size() < 2) return nullptr;
  Json groups = Json::array();
  for (const std::size_t i : order) {
    const std::string title = i == 0 ? "nominal" : risk_model_name(result.samples[i].model);
    if (groups.empty() || groups.back()[0] != title) groups.push_back({title, 0});
    groups.back()[1] = groups.back()[1].get<int>() + 1;
  }
  return {
      {"names", std::move(names)}, {"places", std::move(places)}, {"groups", std::move(groups)}};
}

}  // namespace crashrank::detail

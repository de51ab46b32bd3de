#include "crashrank/internal/report/escape.hpp"
#include "crashrank/internal/report/table.hpp"
#include "crashrank/report/ranking.hpp"
#include "report/crash_summary.hpp"
#include "report/damage_summary.hpp"
#include "report/future_words.hpp"
#include "report/manoeuvre_words.hpp"
#include "report/ranking_words.hpp"
#include "report/score_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <sstream>

namespace crashrank {
namespace {

using detail::DamageSummary;

/// The first few names, and how many more there are.
std::string shortened(const std::vector<std::string>& names) {
  constexpr std::size_t shown = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(shown, names.size()); ++i) {
    text += (i > 0 ? ", " : "") + names[i];
  }
  if (names.size() > shown) text += fmt::format(" +{}", names.size() - shown);
  return text;
}

std::vector<std::string> cells(const Scenario& scenario, View<const Model> models,
                               const RankResult& result, const std::string& score,
                               std::size_t place) {
  const CandidateResult& ranked = result.ranking[place];
  std::string name = result.candidates[ranked.candidate].name;
  const std::string mark = detail::manoeuvre_mark(ranked);
  if (!mark.empty()) name += " [" + mark + "]";
  std::vector<std::string> row{detail::place_text(ranked), std::move(name), score};
  const bool simulated = needs_crash(result.measure);
  if (simulated) {
    row.push_back(detail::interval_text(ranked));
    row.push_back(detail::places_text(ranked));
  }
  if (result.futures.method != FutureMethod::certain) {
    row.push_back(ranked.score || ranked.searched
                      ? detail::percent_text(ranked.collision_probability)
                      : std::string());
  }
  if (ranked.contacts.empty()) {
    if (ranked.first_touch) {
      const FirstTouch& first = *ranked.first_touch;
      row.push_back(scenario.actors[first.actor].name);
      row.push_back(fmt::format("{:.3f}", first.time_of_impact_s));
      row.push_back(detail::fixed_text(first.closing_speed_mps, 1));
    } else {
      row.push_back(detail::passing_words(scenario, ranked));
    }
    return row;
  }
  const Contact& first = ranked.contacts.front();
  std::string hit = detail::contact_name(scenario, first);
  const std::size_t follow = ranked.contacts.size() - 1 + ranked.further.size();
  if (follow > 0) hit += fmt::format(" +{}", follow);
  const DamageSummary ego = detail::summary_of(ranked.ego, models[scenario.ego.model].mesh);
  const DamageSummary other = detail::summary_of_others(scenario, models, ranked);
  row.push_back(hit);
  row.push_back(fmt::format("{:.3f}", first.time_of_impact_s));
  row.push_back(detail::fixed_text(first.closing_speed_mps, 1));
  if (simulated) {
    const detail::CrashSummary crash = detail::crash_of_ego(ranked);
    row.push_back(detail::fixed_text(crash.exposure_mps, 1));
    row.push_back(detail::fixed_text(crash.crush_m, 2));
  } else {
    row.push_back(fmt::format("{} + {}", ego.triangles, other.triangles));
    row.push_back(detail::fixed_text(ego.area_m2, 2) + " + " +
                  detail::fixed_text(other.area_m2, 2));
  }
  row.push_back(shortened(ego.parts));
  return row;
}

/// The highest score of those that are not shown, or what it can be at most.
std::string highest_hidden(const RankResult& result, const std::vector<std::string>& scores,
                           std::size_t shown) {
  const auto highest = [](const CandidateResult& c) {
    return c.score.value_or(c.score_interval.highest);
  };
  const auto first = result.ranking.begin() + static_cast<std::ptrdiff_t>(shown);
  const auto most = std::max_element(
      first, result.ranking.end(),
      [&](const CandidateResult& p, const CandidateResult& q) { return highest(p) < highest(q); });
  if (!most->score) return fmt::format("{:.2g}", highest(*most));
  return scores[static_cast<std::size_t>(most - result.ranking.begin())];
}

/// The text with lines broken at spaces where they are longer than `width`, 0: nowhere.
std::string wrapped(const std::string& text, std::size_t width) {
  if (width == 0) return text;
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::size_t column = 0;
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      const std::size_t length = display_width(word);
      if (column > 0 && column + 1 + length > width) {
        out += "\n  ";
        column = 2;
      } else if (column > 0) {
        out += ' ';
        ++column;
      }
      out += word;
      column += length;
    }
    out += '\n';
  }
  return out;
}

/// Whether the contact that the table names begins with the bodies in each other.
bool overlaps_first(const CandidateResult& ranked) {
  return !ranked.contacts.empty() && detail::begins_in_contact(ranked.contacts.front());
}

}  // namespace

std::string ranking_text(const Scenario& asked, View<const Model> models, const RankResult& result,
                         const RankingTextOptions& options) {
  const Scenario made = is_uncertain(asked) ? likeliest_future(asked) : Scenario{};
  const Scenario& scenario = is_uncertain(asked) ? made : asked;
  const std::size_t all = result.ranking.size();
  const std::size_t shown = options.top == 0 ? all : std::min(options.top, all);
  const bool simulated = needs_crash(result.measure);
  std::vector<Table::Column> columns{
      {"rank", true},
      {"candidate", false, 24},
      {std::string(measure_name(result.measure)) + " [" + measure_unit(result.measure) + "]",
       true}};
  if (simulated) {
    columns.push_back({"interval", false, 0, 2});
    columns.push_back({"may rank", true});
  }
  if (result.futures.method != FutureMethod::certain) columns.push_back({"collides", true});
  columns.push_back(
      {result.futures.method == FutureMethod::certain ? "hits" : "likeliest hits", false, 16});
  columns.push_back({"after s", true, 0, 5});
  columns.push_back({"closing m/s", true, 0, 4});
  columns.push_back({simulated ? "exposure m/s" : "triangles", true});
  columns.push_back({simulated ? "crush m" : "area m2", true, 0, 3});
  columns.push_back({"ego's parts", false, 12, 1});
  const std::vector<std::string> scores = detail::score_texts(result);
  Table table(std::move(columns));
  for (std::size_t place = 0; place < shown; ++place) {
    table.add_row(cells(scenario, models, result, scores[place], place));
  }
  std::string text = fmt::format("{}: {} candidate{}, {} other{} on the road\n\n",
                                 escape_terminal(scenario.name), all, all == 1 ? "" : "s",
                                 scenario.actors.size(), scenario.actors.size() == 1 ? "" : "s");
  text = wrapped(text, options.width) + table.text(options.colours, options.width);
  const std::size_t below = text.size();
  if (shown < all) {
    text += fmt::format("... and {} more, up to {} {}\n", all - shown,
                        highest_hidden(result, scores, shown), measure_unit(result.measure));
  }
  const auto free = static_cast<std::size_t>(std::count_if(
      result.ranking.begin(), result.ranking.end(), [](const CandidateResult& ranked) {
        return ranked.score && !ranked.collides && !(ranked.collision_probability > 0.0);
      }));
  for (const std::string& words : detail::future_words(scenario, result)) {
    text += escape_terminal(words) + "\n";
  }
  for (const std::string& words : detail::not_separable_words(result, shown)) {
    text += escape_terminal(words) + "\n";
  }
  for (const std::string& words :
       {detail::other_order_words(result), detail::without_errors_words(result)}) {
    if (!words.empty()) text += escape_terminal(words) + "\n";
  }
  for (const std::string& words : detail::pushed_words(scenario, result, shown)) {
    text += escape_terminal(words) + "\n";
  }
  if (std::any_of(result.ranking.begin(),
                  result.ranking.begin() + static_cast<std::ptrdiff_t>(shown), overlaps_first)) {
    text += fmt::format("overlaps at start: {}\n", detail::overlap_meaning);
  }
  text += fmt::format(
      "\n{} of {} {}touch nothing.{} Ranked in {:.1f} ms{}.\n", free, all,
      result.complete ? "" : "are known to ",
      simulated
          ? " Exposure (the greatest change of velocity within 0.3 s) and crush are the ego's."
          : " Damage is ego + others.",
      result.elapsed_s * 1e3, result.complete ? "" : "; not every score is known");
  if (!result.complete) {
    text += result.proved ? "The first place is proved.\n"
                          : fmt::format("The first place is not proved ({}): {} are in the race.\n",
                                        basis_name(result.basis), result.in_race.size());
  }
  if (result.effort) {
    const RankerEffort& effort = *result.effort;
    text += fmt::format(
        "Scores: {} from swept boxes, {} from contacts, {} from {}; {} left early as not to be "
        "first. Preparing took {:.1f} ms, the boxes {:.2f} ms, refining {:.2f} ms, {} tests.\n",
        effort.without_search, effort.without_crash, effort.fully_evaluated,
        simulated ? "simulated crashes" : "intersected meshes", effort.left_early,
        1e3 * effort.prepare_s, 1e3 * effort.bounds_s, 1e3 * effort.refining_s, effort.work);
  }
  if (simulated && result.samples.empty()) {
    text +=
        "What is not known well was not varied: under a deadline, a budget or --first-place "
        "intervals\nand places are those of the work left undone alone.\n";
  }
  if (result.measure == Measure::harm) {
    for (const std::string& line : detail::harm_words(result.harm)) text += line + "\n";
  }
  return text.substr(0, below) + wrapped(text.substr(below), options.width);
}

}  // namespace crashrank
